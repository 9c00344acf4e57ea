// reconstruct(X) of McGuire et al. 2012 (algorithms 2.2), one row.
#if defined(AFTERSHADE_CORE_MOTIONBLUR_MCGUIRE2012_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_MCGUIRE2012_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_MCGUIRE2012_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_MCGUIRE2012_KERNEL_H
#endif
#include "core/motionblur/gather_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

struct Mcguire2012Row {
  int taps;                                ///< S, odd
  float inverse_soft_extent;               ///< 1 / metres
  const float *neighbour_x, *neighbour_y;  ///< v_N of the tiles around each pixel
  const float* jitter;                     ///< in [-0.5, 0.5), a share of the tap spacing
};

/// Blurs some columns of a row. Pixels that do not move are left as they are.
inline void mcguire2012_row(const Mcguire2012Row& k, const GatherRow& row, Columns columns) {
  const int middle = (k.taps - 1) / 2;
  const Float spacing = 2.0F / static_cast<float>(k.taps + 1);
  for (int x = columns.first; x < columns.last; x += kLanes) {
    const Vector neighbour{load(k.neighbour_x + x), load(k.neighbour_y + x)};
    const Float reach = length(neighbour);
    const Mask fast = reach > kLeastRadius_px;
    if (!any(fast)) continue;
    const Tap centre = centre_at(row, x);
    const Mask moving = fast & centre.usable;
    if (!any(moving)) continue;
    const Float speed = centre.speed, jitter = load(k.jitter + x);
    Gathered sum = gathered(centre, 1.0F / speed);  // w = 1 / |V[X]|
    for (int i = 0; i < k.taps; ++i) {
      if (i == middle) continue;
      const Float t = (Float(static_cast<float>(i - middle)) + jitter) * spacing;  // mix(-1, 1, (i + j + 1) / (S + 1))
      const Tap tap = tap_at(row, x, {neighbour.x * t, neighbour.y * t});
      const Float d = reach * abs(t);
      const Order order = soft_order((tap.depth - centre.depth) * k.inverse_soft_extent);
      const Float weight = order.before * cone(d, tap.speed) + order.behind * cone(d, speed) +
                           2.0F * cylinder(d, tap.speed) * cylinder(d, speed);
      add(tap, weight, sum);
    }
    store_mean(row, sum, moving, x);
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
