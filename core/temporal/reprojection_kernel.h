#if defined(AFTERSHADE_CORE_TEMPORAL_REPROJECTION_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_TEMPORAL_REPROJECTION_KERNEL_H
#undef AFTERSHADE_CORE_TEMPORAL_REPROJECTION_KERNEL_H
#else
#define AFTERSHADE_CORE_TEMPORAL_REPROJECTION_KERNEL_H
#endif
#include <limits>

#include "core/filter/static_motion_lanes.h"
#include "core/temporal/reprojection.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

/// Position and expected depth of a static surface; NaN behind the camera before.
inline Point static_surface(const ReprojectionRow& row, Float x, Float y, Float z) {
  const Point moved = static_displacement(*row.camera, x, z);
  return {x + moved.x, y + moved.y, moved.z};
}

/// The vector decides where it is known and the camera's motion does not explain it (algorithms 7.2).
inline Point where_it_was(const ReprojectionRow& row, int i, Float x, Float y, Float z) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const Point unknown{kNaN, kNaN, kNaN};
  const Point before = row.camera ? static_surface(row, x, y, z) : unknown;
  if (row.mv_x == nullptr) return before;
  const Float mv_x = load(row.mv_x + i), mv_y = load(row.mv_y + i);
  const Mask known = is_finite(mv_x) & is_finite(mv_y);
  const Float off_x = before.x - x - mv_x, off_y = before.y - y - mv_y;
  const Mask agrees = off_x * off_x + off_y * off_y <= row.agreement_px * row.agreement_px;
  const Point along{x + mv_x, y + mv_y, row.camera ? before.z : z};
  return select(known, select(agrees, before, along), row.holes_are_invalid ? unknown : before);
}

/// Of pixels i, i + 1, ...: absolute position and depth before; NaN: unknown.
inline Point past_at(const ReprojectionRow& row, int i) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const Float z = load(row.depth + i), x = to_float(iota(row.min_x + i)) + 0.5F;
  return select(is_surface(z), where_it_was(row, i, x, row.centre_y, z), Point{kUnknown, kUnknown, kUnknown});
}

/// `not_needed`: 1 where the past is not asked for; may be null.
inline void reprojection_row(const ReprojectionRow& row, const float* not_needed, float* x, float* y, float* depth) {
  for (int i = 0; i < row.width; i += kLanes) {
    if (not_needed != nullptr && all(load(not_needed + i) >= 0.5F)) continue;
    const Point before = past_at(row, i);
    store(x + i, before.x);
    store(y + i, before.y);
    store(depth + i, before.z);
  }
}

/// Where the stored depth of the frame before is looked for.
struct StoredDepth {
  ConstPlaneView depth;
  Window window;
};

/// Adds the surface pixels i, i + 1, ... to `surface`, and those of them without a past to `lost`.
inline void count_lost(const StoredDepth& stored, Float depth, Point past, Mask in_row, Float& surface, Float& lost) {
  constexpr float kOtherDepth = 0.1F;
  const Window& w = stored.window;
  const Float px = floor(past.x), py = floor(past.y);
  const auto min_x = static_cast<float>(w.min_x), max_x = static_cast<float>(w.max_x);
  const auto min_y = static_cast<float>(w.min_y), max_y = static_cast<float>(w.max_y);
  const Mask inside = (px >= min_x) & (px <= max_x) & (py >= min_y) & (py <= max_y);
  const Int column = to_int(clamp(px - min_x, 0.0F, max_x - min_x)),
            row = to_int(clamp(py - min_y, 0.0F, max_y - min_y));
  const Float z = gather(stored.depth.data, row * Int(static_cast<int32_t>(stored.depth.stride)) + column);
  const Mask same = inside & (z > 0.0F) & (abs(1.0F - past.z / z) < kOtherDepth), here = is_surface(depth) & in_row;
  surface += select(here, Float(1.0F), 0.0F);
  lost += select(here & !same, Float(1.0F), 0.0F);
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
