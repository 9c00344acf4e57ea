#if defined(AFTERSHADE_CORE_TEMPORAL_TEMPORAL_BLUR_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_TEMPORAL_TEMPORAL_BLUR_KERNEL_H
#undef AFTERSHADE_CORE_TEMPORAL_TEMPORAL_BLUR_KERNEL_H
#else
#define AFTERSHADE_CORE_TEMPORAL_TEMPORAL_BLUR_KERNEL_H
#endif
#include <array>
#include <cmath>

#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE::blur_kernel {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

/// Three planes that make a point or a direction.
struct PointSamples {
  explicit PointSamples(const std::array<Plane, 3>& planes) : x(planes[0]), y(planes[1]), z(planes[2]) {}
  Samples x, y, z;
  Point operator()(Int i, Int j) const { return {x(i, j), y(i, j), z(i, j)}; }
  template <bool kInside>
  Point operator()(const Columns<kInside>& column, int j) const {
    return {column(x.row(j)), column(y.row(j)), column(z.row(j))};
  }
};

struct TexelSurfaceRow {
  GridSamples texels;
  NormalSamples normals;
  Lens lens;
  std::array<float*, 3> point, normal;  ///< out
};
inline void texel_surface_row(const TexelSurfaceRow& row, int y) {
  const int width = row.texels.depth.width;
  for_each_vector(width, 0, 0, [&](int x0, auto inside) {
    const Columns<inside()> x(x0, width);
    const Point n = row.texels.normal(row.normals, x, y), p = row.texels.point(row.lens, x, y);
    const Mask here = is_surface(p.z);
    store(row.point[0] + x0, select(here, p.x, 0.0F));
    store(row.point[1] + x0, select(here, p.y, 0.0F));
    store(row.point[2] + x0, select(here, p.z, HUGE_VALF));
    store(row.normal[0] + x0, n.x);
    store(row.normal[1] + x0, n.y);
    store(row.normal[2] + x0, n.z);
  });
}

/// One direction of the blur: taps at (x + t dx, y + t dy), |t| <= 2.
struct FiveTapRow {
  PointSamples points, normals;
  Samples value;
  int dx, dy;
  std::array<float, 3> weights;  ///< of |t| = 0, 1, 2
  EdgeTolerance cut;
  bool literal;  ///< cut by depth, not by distance from the tangent plane
  float* out;
};

/// What the blur has gathered of one group of texels. The mean is taken of differences from the centre, so a constant
/// stays the same to the bit.
struct FiveTaps {
  FiveTaps(const FiveTapRow& row, Point own, Point own_normal, Float own_value)
      : point(own),
        normal(own_normal),
        here(is_surface(own.z)),
        cut(row.cut.at(own.z)),
        base(select(is_finite(own_value), own_value, 1.0F)),
        sum(0.0F),
        weights(row.weights[0]),
        literal(row.literal) {}
  /// "If the distance between the depth of the main and the neighbor is outside of a limit the pixel will be skipped"
  /// (seed 001).
  void add(Point there, Float value, Mask exists, float weight) {
    const Point v = there - point;
    const Float d = literal ? abs(v.z) : plane_distance(v, normal);
    const Mask same = here & exists & (d <= cut) & is_finite(value);  // background: d is infinite
    sum += select(same, weight * (value - base), 0.0F);
    weights += select(same, Float(weight), 0.0F);
  }
  Float mean() const { return base + sum / weights; }

  Point point, normal;
  Mask here;
  Float cut, base, sum, weights;
  bool literal;
};

inline void five_tap_row(const FiveTapRow& row, int y) {
  const Mask all_exist = Float(0.0F) < 1.0F;
  for_each_vector(row.value.width, 2 * row.dx, 2 * row.dx, [&](int x0, auto inside) {
    const Columns<inside()> x(x0, row.value.width);
    FiveTaps taps(row, row.points(x, y), row.normals(x, y), x(row.value.row(y)));
    for (int t = -2; t <= 2; ++t) {
      const int ty = y + t * row.dy;
      if (t == 0 || ty < 0 || ty >= row.value.height) continue;
      const Columns<inside()> tx(x0 + t * row.dx, row.value.width);
      taps.add(row.points(tx, ty), tx(row.value.row(ty)), row.dx != 0 ? tx.inside : all_exist,
               row.weights[static_cast<size_t>(t < 0 ? -t : t)]);
    }
    store(row.out + x0, taps.mean());
  });
}

/// The same with taps as far apart as `spacing` says.
inline void spaced_five_tap_row(const FiveTapRow& row, const float* spacings, int y) {
  for (int x0 = 0; x0 < row.value.width; x0 += kLanes) {
    const Int x = row.value.clamp_x(iota(x0)), iy = y, spacing = to_int(load(spacings + x0));
    FiveTaps taps(row, row.points(x, iy), row.normals(x, iy), row.value(x, iy));
    for (int t = -2; t <= 2; ++t) {
      if (t == 0) continue;
      const Int tx = x + spacing * Int(t * row.dx), ty = iy + spacing * Int(t * row.dy);
      const Int sx = row.value.clamp_x(tx), sy = row.value.clamp_y(ty);
      taps.add(row.points(sx, sy), row.value(sx, sy), row.value.contains(tx, ty),
               row.weights[static_cast<size_t>(t < 0 ? -t : t)]);
    }
    store(row.out + x0, taps.mean());
  }
}

/// History of frame i-1; its index (0, 0) is absolute texel (texel_x, texel_y).
struct HistoryView {
  PointSamples points, normals;
  Samples value, variance;
  int texel_x, texel_y;
  Lens lens;  ///< of that frame, in absolute pixel coordinates
};

struct BlendRow {
  GridSamples texels;
  int step, origin_x, origin_y;  ///< of the grid: window index of block (0,0)'s first pixel
  Samples x, y, expected;        ///< at every pixel: absolute position and planar depth in frame i-1, NaN: unknown
  HistoryView before;
  const float* value;  ///< of frame i, after the first blur
  EdgeTolerance cut;
  float cut_m, near_m, far_m;  ///< near and far grow with the cut
  float history_weight, difference_scale;
  bool literal;
  float blur_variance;  ///< of one blur
  float *out_value, *out_variance, *out_weight;
};

/// Where a texel's surface was: texel coordinates of frame i-1's grid (absolute, so a window that moves changes
/// nothing) and the point in that frame's camera space. A texel stands for a picked pixel, so its offset in the block
/// is taken off: what stands still meets its own texel exactly.
struct Past {
  Float u, v;
  Point point;
};
inline Past past_of(const BlendRow& row, Int x, Int y) {
  const Float fx = row.texels.x_of(x, y), fy = row.texels.y_of(x, y);
  const Int px = to_int(fx), py = to_int(fy);
  const Float at_x = row.x(px, py) - 0.5F, at_y = row.y(px, py) - 0.5F;
  const Float in_block_x = fx - to_float(x * Int(row.step) + Int(row.origin_x)),
              in_block_y = fy - to_float(y * Int(row.step) + Int(row.origin_y));
  const float per_pixel = 1.0F / static_cast<float>(row.step);
  return {(at_x - in_block_x) * per_pixel, (at_y - in_block_y) * per_pixel,
          unproject(row.before.lens, at_x, at_y, row.expected(px, py))};
}

/// From the expected point to the surface that a texel saw: to its tangent plane, or along the expected point's ray.
inline Float distance_in_space(const BlendRow& row, Point expected, Point seen, Point normal) {
  if (!row.literal) return plane_distance(expected - seen, normal);
  const Float along = abs(expected.z - seen.z);
  return row.before.lens.orthographic ? along : along * (sqrt(dot(expected, expected)) / expected.z);
}

/// 1 - smoothstep(near, far, d): G3D's values, algorithms 5.2. Not a number: 0.
inline Float nearness(const BlendRow& row, Float d, Float scale) {
  const Float t = sat((d - row.near_m * scale) / ((row.far_m - row.near_m) * scale));
  return select(d <= row.far_m * scale, 1.0F - t * t * (3.0F - 2.0F * t), 0.0F);
}

struct Fetched {
  Float difference;  ///< of the value from this frame's, so that a constant stays the same to the bit
  Float variance;
  Float geometry;  ///< w_geometry
};

/// Four bilinear taps, each validated on its own, weights renormalised; none when the taps of the same surface weigh
/// less than a quarter (algorithms 7.3).
inline Fetched fetch(const BlendRow& row, const Past& past, Float value, Float scale) {
  const HistoryView& h = row.before;
  const auto columns = static_cast<float>(h.value.width), rows = static_cast<float>(h.value.height);
  const Float u0 = floor(past.u), v0 = floor(past.v);
  const Float left = clamp(u0 - static_cast<float>(h.texel_x), -2.0F, columns);  // NaN becomes -2: outside
  const Float top = clamp(v0 - static_cast<float>(h.texel_y), -2.0F, rows);
  Float same = 0.0F, sum = 0.0F, difference = 0.0F, variance = 0.0F;
  for (int tap = 0; tap < 4; ++tap) {
    const Int right = tap & 1, below = tap >> 1;
    const Int tx = to_int(left) + right, ty = to_int(top) + below;
    const Int sx = h.value.clamp_x(tx), sy = h.value.clamp_y(ty);
    const Float d = distance_in_space(row, past.point, h.points(sx, sy), h.normals(sx, sy));
    const Float near = select(h.value.contains(tx, ty), nearness(row, d, scale), 0.0F);
    const Float bilinear = (1.0F - abs(past.u - u0 - to_float(right))) * (1.0F - abs(past.v - v0 - to_float(below)));
    const Mask valid = near > 0.0F;
    const Float weight = select(valid, bilinear * near, 0.0F);
    same += select(valid, bilinear, 0.0F);
    sum += weight;
    difference += weight * (h.value(sx, sy) - value);
    variance += weight * h.variance(sx, sy);
  }
  return {difference / sum, variance / sum, select(same >= 0.25F, sum / same, 0.0F)};
}

inline void blend_row(const BlendRow& row, int y) {
  for (int x0 = 0; x0 < row.texels.depth.width; x0 += kLanes) {
    const Int x = row.texels.depth.clamp_x(iota(x0)), iy = y;
    const Float value = load(row.value + x0), z = row.texels.depth(x, iy);
    const Fetched before = fetch(row, past_of(row, x, iy), value, row.cut.at(z) / row.cut_m);
    const Mask known = is_surface(z) & (before.geometry > 0.0F);
    // (1 - sat(|AO - AO'| / max(AO, AO', 0.1)))^2: algorithms 5.2.
    const Float larger = max(max(abs(value), abs(value + before.difference)), 0.1F);
    const Float alike = 1.0F - sat(row.difference_scale * (abs(before.difference) / larger));
    const Float weight = select(known, row.history_weight * before.geometry * (alike * alike), 0.0F);
    const Float difference = select(known, before.difference, 0.0F);
    const Float old_variance = select(known, before.variance, row.blur_variance);
    store(row.out_value + x0, value + weight * difference);
    store(row.out_weight + x0, weight);
    // Of B((1 - h) B x + h out'): algorithms 5.3.
    store(row.out_variance + x0, row.blur_variance + (1.0F - weight) * row.blur_variance + weight * old_variance);
  }
}

/// Warm start (algorithms 5.3: "start every pixel with the spatial kernel it will converge to"): five taps so far apart
/// that they add the variance which the kernel still lacks.
inline void spacing_row(const float* variance, int width, float wanted, float blur_variance, float* spacing) {
  for (int x = 0; x < width; x += kLanes)
    store(spacing + x, round_small(sqrt(max(wanted - load(variance + x), 0.0F) / blur_variance)));
}

}  // namespace aftershade::temporal::HWY_NAMESPACE::blur_kernel
HWY_AFTER_NAMESPACE();
#endif
