#pragma once
#include <limits>

#include "core/filter/lane_geometry.h"

namespace aftershade::temporal {
using namespace lanes;

/// a + b x + c t along one row of pixels: x the pixel's centre, from the principal point; t = 1 / z (perspective) or z
/// (orthographic).
struct RowPolynomial {
  float a, b, c;
  Float operator()(Float x, Float t) const { return a + b * x + c * t; }
};

/// Where a static surface was seen before, on one row: x' - x = (move_x + x (x_squared x + x_t t)) / scale and
/// y' - y = move_y / scale, each numerator with its coefficients worked out in double, so that a camera that stands
/// still moves no pixel by any bit. The depth is that of camera i-1: z (z_a + z_b x) + z_c (perspective), or
/// z_a + z_b x + z_c z.
struct StaticMotion {
  RowPolynomial move_x, move_y, scale, z;
  float x_squared, x_t;
};

struct ReprojectionRow {
  const float* depth;
  const float *mv_x, *mv_y;  ///< null: no vectors
  const float* not_needed;   ///< 1: this pixel's past is not asked for; may be null
  bool camera;               ///< is `motion` known?
  StaticMotion motion;
  bool orthographic;
  float centre_x;  ///< of camera i
  bool holes_are_invalid;
  float agreement_px;
  int width, min_x;
  float centre_y;                ///< of the row, absolute
  float *out_x, *out_y, *out_z;  ///< absolute position and depth before, NaN: unknown
};

/// Position and expected depth of a static surface (algorithms 7.1); NaN behind the camera before.
inline filter::Point static_surface(const ReprojectionRow& row, Float x, Float y, Float z) {
  const StaticMotion& m = row.motion;
  const Float from_axis = x - row.centre_x, t = row.orthographic ? z : 1.0F / z;
  const Float share = 1.0F / m.scale(from_axis, t);
  const Float dx = (m.move_x(from_axis, t) + from_axis * (m.x_squared * from_axis + m.x_t * t)) * share;
  const Float dy = m.move_y(from_axis, t) * share;
  const Float before = row.orthographic ? m.z(from_axis, z) : (m.z.a + m.z.b * from_axis) * z + m.z.c;
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  return filter::select(before > 0.0F, {x + dx, y + dy, before}, {kUnknown, kUnknown, kUnknown});
}

/// The vector decides where it is known and the camera's motion does not explain it (algorithms 7.2).
inline filter::Point where_it_was(const ReprojectionRow& row, int i, Float x, Float y, Float z) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const filter::Point unknown{kNaN, kNaN, kNaN};
  const filter::Point before = row.camera ? static_surface(row, x, y, z) : unknown;
  if (row.mv_x == nullptr) return before;
  const Float mv_x = load(row.mv_x + i), mv_y = load(row.mv_y + i);
  const Mask known = is_finite(mv_x) & is_finite(mv_y);
  const Float off_x = before.x - x - mv_x, off_y = before.y - y - mv_y;
  const Mask agrees = off_x * off_x + off_y * off_y <= row.agreement_px * row.agreement_px;
  const filter::Point along{x + mv_x, y + mv_y, row.camera ? before.z : z};
  return filter::select(known, filter::select(agrees, before, along), row.holes_are_invalid ? unknown : before);
}

inline void reprojection_row(const ReprojectionRow& row) {
  for (int i = 0; i < row.width; i += kLanes) {
    if (row.not_needed != nullptr && all(load(row.not_needed + i) >= 0.5F)) continue;
    const Float z = load(row.depth + i), x = to_float(iota(row.min_x + i)) + 0.5F;
    constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
    const filter::Point before =
        filter::select(filter::is_surface(z), where_it_was(row, i, x, row.centre_y, z), {kUnknown, kUnknown, kUnknown});
    store(row.out_x + i, before.x);
    store(row.out_y + i, before.y);
    store(row.out_z + i, before.z);
  }
}

}  // namespace aftershade::temporal
