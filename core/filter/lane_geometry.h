// What the kernels of core/filter and core/ao share: points, surfaces and grid texels in lanes. No length in metres is
// compared with a constant, so a scene scaled by a power of two gives the same bits.
#if defined(AFTERSHADE_CORE_FILTER_LANE_GEOMETRY_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_LANE_GEOMETRY_H
#undef AFTERSHADE_CORE_FILTER_LANE_GEOMETRY_H
#else
#define AFTERSHADE_CORE_FILTER_LANE_GEOMETRY_H
#endif
#include <algorithm>

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
};

/// The normal at pixels inside the image; (0,0,0) where it is not finite.
struct NormalSamples {
  explicit NormalSamples(const Surface& s) : nx(s.nx), ny(s.ny), nz(s.nz) {}
  Samples nx, ny, nz;
  Point operator()(Int x, Int y) const {
    const Point n{nx(x, y), ny(x, y), nz(x, y)};
    return select(is_finite(dot(n, n)), n, Point{0.0F, 0.0F, 0.0F});
  }
};

/// Texels of a SampleGrid and the pixels that they stand for.
struct GridSamples {
  explicit GridSamples(const SampleGrid& grid)
      : depth(grid.depth), pixel_x(grid.pixel_x), pixel_y(grid.pixel_y), every_pixel(grid.step == 1) {}
  Samples depth, pixel_x, pixel_y;
  bool every_pixel;
  Float x_of(Int x, Int y) const { return every_pixel ? to_float(x) : pixel_x(x, y); }
  Float y_of(Int x, Int y) const { return every_pixel ? to_float(y) : pixel_y(x, y); }
  Point point(const Lens& lens, Int x, Int y) const { return unproject(lens, x_of(x, y), y_of(x, y), depth(x, y)); }
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

#if HWY_TARGET == HWY_SCALAR
namespace aftershade::filter {
using namespace N_SCALAR;
}
#endif
#endif
