#pragma once
#include <limits>

#include "core/filter/lane_geometry.h"
#include "core/filter/static_motion_lanes.h"

namespace aftershade::temporal {
using namespace lanes;

struct ReprojectionRow {
  const float* depth;
  const float *mv_x, *mv_y;  ///< null: no vectors
  const float* not_needed;   ///< 1: this pixel's past is not asked for; may be null
  bool camera;               ///< is `motion` known?
  filter::StaticMotion motion;
  bool holes_are_invalid;
  float agreement_px;
  int width, min_x;
  float centre_y;                ///< of the row, absolute
  float *out_x, *out_y, *out_z;  ///< absolute position and depth before, NaN: unknown
};

/// Position and expected depth of a static surface; NaN behind the camera before.
inline filter::Point static_surface(const ReprojectionRow& row, Float x, Float y, Float z) {
  const filter::Point moved = filter::static_displacement(row.motion, x, z);
  return {x + moved.x, y + moved.y, moved.z};
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
