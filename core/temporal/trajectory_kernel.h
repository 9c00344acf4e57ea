#if defined(AFTERSHADE_CORE_TEMPORAL_TRAJECTORY_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_TEMPORAL_TRAJECTORY_KERNEL_H
#undef AFTERSHADE_CORE_TEMPORAL_TRAJECTORY_KERNEL_H
#else
#define AFTERSHADE_CORE_TEMPORAL_TRAJECTORY_KERNEL_H
#endif
#include "core/filter/lane_geometry.h"
#include "core/temporal/trajectory_rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

struct MatchRow {
  FrameSamples frame;
  Lens lens;  ///< of the frame, in absolute pixels: results do not depend on where its window lies
  EdgeTolerance distance;
  float moving_depth, normal_cos, consistency_px, consistency_share;
  const float (*turn)[3];              ///< row vectors: direction in the centre's camera space -> in this frame's
  const float *ao, *nx, *ny, *nz;      ///< of the centre; normals may be null
  const float *x, *y, *depth, *still;  ///< where the surface is expected
  const float *back_x, *back_y;        ///< and the way from there to where it was one frame nearer to the centre
  int width;
  float *difference, *weight;  ///< out
  float* found_depth;          ///< out: where not still, the depth that is there
  float *vector_x, *vector_y;  ///< out: outward vector there, NaN: unknown
};

/// The centre's normal as this frame's camera sees it; (0,0,0) where there is none.
inline Point expected_normal(const MatchRow& row, int x0) {
  if (row.nx == nullptr) return {0.0F, 0.0F, 0.0F};
  const Float a = load(row.nx + x0), b = load(row.ny + x0), c = load(row.nz + x0);
  const auto column = [&](int i) { return a * row.turn[0][i] + b * row.turn[1][i] + c * row.turn[2][i]; };
  const Point n{column(0), column(1), column(2)};
  return select(is_finite(dot(n, n)), n, Point{0.0F, 0.0F, 0.0F});
}

/// Are both normals known and further apart than the tolerance?
inline Mask turned_away(const MatchRow& row, Point expected, Int index) {
  if (row.frame.nx == nullptr) return Float(0.0F) > 1.0F;
  const Point n{gather(row.frame.nx, index), gather(row.frame.ny, index), gather(row.frame.nz, index)};
  const Mask known = (dot(n, n) > 0.0F) & (dot(expected, expected) > 0.0F);
  return known & (dot(n, expected) < row.normal_cos);
}

/// Forward and backward vectors must cancel: |mv_b(x) + mv_f(x')| < 0.5 px + 0.05 |mv| (algorithms 7.2). An unknown
/// vector contradicts nothing.
inline Mask leads_elsewhere(const MatchRow& row, Float back_x, Float back_y, Int index) {
  if (row.frame.inward_x == nullptr) return Float(0.0F) > 1.0F;
  const Float dx = gather(row.frame.inward_x, index) - back_x, dy = gather(row.frame.inward_y, index) - back_y;
  const Float limit = row.consistency_px + row.consistency_share * sqrt(back_x * back_x + back_y * back_y);
  return dx * dx + dy * dy >= limit * limit;
}

/// Validated bilinear fetch (algorithms 7.3): each of four taps is tested by itself, weights are renormalised, less
/// than a quarter is no match. AO is averaged as a difference from the centre's, so that a constant stays one to the
/// bit.
inline void match_row(const MatchRow& row) {
  const FrameSamples& f = row.frame;
  const auto columns = static_cast<float>(f.width), rows = static_cast<float>(f.height);
  for (int i = 0; i < row.width; i += kLanes) {
    const Float given = load(row.ao + i), own = select(is_finite(given), given, 1.0F);
    const Float u = load(row.x + i) - 0.5F, v = load(row.y + i) - 0.5F, z = load(row.depth + i);
    const Mask still = load(row.still + i) > 0.5F, known = is_finite(u) & is_finite(v) & is_surface(z);
    const Point expected = unproject(row.lens, u, v, z), normal = expected_normal(row, i);
    const Float tolerance = row.distance.at(z) + select(still, Float(0.0F), row.moving_depth * z);
    const Float back_x = load(row.back_x + i), back_y = load(row.back_y + i);
    const Float u0 = floor(u), v0 = floor(v);
    const Float left = clamp(u0 - static_cast<float>(f.min_x), -2.0F, columns);  // NaN becomes -2: outside
    const Float top = clamp(v0 - static_cast<float>(f.min_y), -2.0F, rows);
    Float sum = 0.0F, difference = 0.0F, depth = 0.0F, moving = 0.0F, vector_x = 0.0F, vector_y = 0.0F;
    for (int tap = 0; tap < 4; ++tap) {
      const auto right = static_cast<float>(tap & 1), below = static_cast<float>(tap >> 1);
      const Float tu = left + right, tv = top + below;
      const Mask inside = (tu >= 0.0F) & (tu < columns) & (tv >= 0.0F) & (tv < rows);
      const Int index = to_int(clamp(tv, 0.0F, rows - 1.0F)) * Int(f.stride) + to_int(clamp(tu, 0.0F, columns - 1.0F));
      const Float tap_z = gather(f.depth, index), tap_ao = gather(f.ao, index);
      const Point there = unproject(row.lens, u0 + right, v0 + below, tap_z);
      const Mask valid = known & inside & is_surface(tap_z) & is_finite(tap_ao) &
                         (plane_distance(there - expected, normal) <= tolerance) & !turned_away(row, normal, index) &
                         !leads_elsewhere(row, back_x, back_y, index);
      const Float weight = select(valid, (1.0F - abs(u - u0 - right)) * (1.0F - abs(v - v0 - below)), Float(0.0F));
      sum += weight;
      difference += select(valid, weight * (tap_ao - own), 0.0F);
      depth += select(valid, weight * tap_z, 0.0F);
      if (f.outward_x == nullptr) continue;
      const Float ox = gather(f.outward_x, index), oy = gather(f.outward_y, index);
      const Float has = select(valid & is_finite(ox) & is_finite(oy), weight, 0.0F);
      moving += has;
      vector_x += select(has > 0.0F, has * ox, 0.0F);
      vector_y += select(has > 0.0F, has * oy, 0.0F);
    }
    const Mask seen = sum >= 0.25F;
    store(row.weight + i, select(seen, sum, 0.0F));
    store(row.difference + i, select(seen, difference / sum, 0.0F));
    store(row.found_depth + i, select(still, z, depth / select(seen, sum, 0.0F)));  // 0 / 0: a moving one is lost
    store(row.vector_x + i, vector_x / select(seen, moving, 0.0F));
    store(row.vector_y + i, vector_y / select(seen, moving, 0.0F));
  }
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
