// What the kernels of core/filter and core/ao share: points, surfaces and grid texels in lanes. No length in metres is
// compared with a constant, so a scene scaled by a power of two gives the same bits.
#if defined(AFTERSHADE_CORE_FILTER_LANE_GEOMETRY_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_LANE_GEOMETRY_H
#undef AFTERSHADE_CORE_FILTER_LANE_GEOMETRY_H
#else
#define AFTERSHADE_CORE_FILTER_LANE_GEOMETRY_H
#endif
#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "core/camera/camera.h"
#include "core/filter/sample_grid.h"
#include "core/simd/lanes.h"
#include "core/simd/math.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

struct Point {
  Float x, y, z;
};
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Float dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point select(Mask m, Point yes, Point no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}

/// +inf, NaN and depths <= 0 are background.
inline Mask is_surface(Float z) { return is_finite(z) & (z > 0.0F); }

/// Projection with its reciprocals.
struct Lens {
  explicit Lens(const Projection& p)
      : inv_fx(1.0F / p.fx), inv_fy(1.0F / p.fy), cx(p.cx), cy(p.cy), orthographic(p.orthographic) {}
  float inv_fx, inv_fy, cx, cy;
  bool orthographic;
};

/// Camera-space point of the centre of pixel (x, y) at depth z (Camera::unproject).
inline Point unproject(const Lens& lens, Float x, Float y, Float z) {
  const Float scale = lens.orthographic ? Float(1.0F) : z;
  return {(x + 0.5F - lens.cx) * lens.inv_fx * scale, -((y + 0.5F - lens.cy) * lens.inv_fy * scale), z};
}

/// kLanes neighbouring columns of planes of `width`, from `first` on. Unless kInside, which says that all of them are
/// inside the image, those outside have the border's values.
template <bool kInside>
struct Columns {
  Columns(int first_column, int width) : first(first_column), index(iota(first_column)), inside(Float(0.0F) < 1.0F) {
    if constexpr (kInside) return;
    inside = (index >= Int(0)) & (index < Int(width));
    index = clamp(index, 0, width - 1);
  }
  int first;
  Int index;
  Mask inside;
  Float operator()(const float* row) const {
    if constexpr (kInside)
      return load(row + first);
    else
      return gather(row, index);
  }
};

/// Calls vector(x0, kInside) as a constant for the steps of a row of `width`, all whose columns x0 - before ... x0 +
/// kLanes - 1 + after lie inside the image and the others.
template <class Vector>
void for_each_vector(int width, int before, int after, Vector&& vector) {
  for (int x0 = 0; x0 < width; x0 += kLanes) {
    if (x0 >= before && x0 + kLanes + after <= width)
      vector(x0, std::true_type());
    else
      vector(x0, std::false_type());
  }
}

/// A plane whose values are gathered by pixel index.
struct Samples {
  explicit Samples(ConstPlaneView view)
      : data(view.data), width(view.width), height(view.height), stride(static_cast<int>(view.stride)) {}
  const float* data;
  int width, height, stride;
  Float operator()(Int x, Int y) const { return gather(data, y * Int(stride) + x); }
  Mask contains(Int x, Int y) const { return (x >= Int(0)) & (x < Int(width)) & (y >= Int(0)) & (y < Int(height)); }
  Int clamp_x(Int x) const { return clamp(x, 0, width - 1); }
  Int clamp_y(Int y) const { return clamp(y, 0, height - 1); }
  const float* row(int y) const { return data + static_cast<std::ptrdiff_t>(y) * stride; }
};

/// `n`, or (0,0,0) where it is not finite.
inline Point finite_normal(Point n) { return select(is_finite(dot(n, n)), n, Point{0.0F, 0.0F, 0.0F}); }

/// The normal at pixels inside the image; (0,0,0) where it is not finite.
struct NormalSamples {
  explicit NormalSamples(const Surface& s) : nx(s.nx), ny(s.ny), nz(s.nz) {}
  Samples nx, ny, nz;
  Point operator()(Int x, Int y) const { return finite_normal({nx(x, y), ny(x, y), nz(x, y)}); }
  template <bool kInside>
  Point operator()(const Columns<kInside>& x, int y) const {
    return finite_normal({x(nx.row(y)), x(ny.row(y)), x(nz.row(y))});
  }
};

/// Texels of a SampleGrid and the pixels that they stand for.
struct GridSamples {
  explicit GridSamples(const SampleGrid& grid)
      : depth(grid.depth),
        pixel_x(grid.pixel_x),
        pixel_y(grid.pixel_y),
        nx(grid.normal[0]),
        ny(grid.normal[1]),
        nz(grid.normal[2]),
        every_pixel(grid.step == 1) {}
  Samples depth, pixel_x, pixel_y, nx, ny, nz;
  bool every_pixel;
  Float x_of(Int x, Int y) const { return every_pixel ? to_float(x) : pixel_x(x, y); }
  Float y_of(Int x, Int y) const { return every_pixel ? to_float(y) : pixel_y(x, y); }
  Point point(const Lens& lens, Int x, Int y) const { return unproject(lens, x_of(x, y), y_of(x, y), depth(x, y)); }
  template <bool kInside>
  Float x_of(const Columns<kInside>& x, int y) const {
    return every_pixel ? to_float(x.index) : x(pixel_x.row(y));
  }
  template <bool kInside>
  Float y_of(const Columns<kInside>& x, int y) const {
    return every_pixel ? Float(static_cast<float>(y)) : x(pixel_y.row(y));
  }
  template <bool kInside>
  Point point(const Lens& lens, const Columns<kInside>& x, int y) const {
    return unproject(lens, x_of(x, y), y_of(x, y), x(depth.row(y)));
  }
  /// The normal at the texels' pixels.
  template <bool kInside>
  Point normal(const NormalSamples& normals, const Columns<kInside>& x, int y) const {
    if (every_pixel) return normals(x, y);
    if (nx.data == nullptr) return normals(to_int(x_of(x, y)), to_int(y_of(x, y)));
    return {x(nx.row(y)), x(ny.row(y)), x(nz.row(y))};
  }
};

/// How far from a pixel's tangent plane another point may lie and still count as the same surface:
/// max(distance_m, footprints * footprint of a texel at the pixel's depth).
struct EdgeTolerance {
  EdgeTolerance(float distance, float footprints, int step, const Projection& p) : distance_m(distance) {
    const float footprint = footprints * static_cast<float>(step) / std::min(p.fx, p.fy);
    if (p.orthographic) distance_m = std::max(distance_m, footprint);
    per_depth = p.orthographic ? 0.0F : footprint;
  }
  float distance_m, per_depth;
  Float at(Float z) const { return max(distance_m, z * per_depth); }
};

/// Distance of `v` (from a pixel's point to another) from the pixel's tangent plane; its depth alone where there is no
/// normal.
inline Float plane_distance(Point v, Point normal) {
  return abs(select(dot(normal, normal) > 0.0F, dot(v, normal), v.z));
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
