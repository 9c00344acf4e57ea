#pragma once
#include "core/motionblur/gather_kernel.h"

/// reconstruct(X) of McGuire et al. 2012 (algorithms 2.2), one row.
namespace aftershade::motionblur {

struct Mcguire2012Kernel {
  int taps;                   ///< S, odd
  float inverse_soft_extent;  ///< 1 / metres
};

struct Mcguire2012Row {
  const float *neighbour_x, *neighbour_y;  ///< v_N of the tiles around each pixel
  const float* jitter;                     ///< in [-0.5, 0.5), a share of the tap spacing
};

/// Blurs row y. Pixels that do not move are left as they are in `target`, which holds the source's values.
inline void mcguire2012_row(const Mcguire2012Kernel& k, const GatherPlanes& planes, const Mcguire2012Row& row,
                            float* const* target, int y) {
  using namespace gathering;
  const int middle = (k.taps - 1) / 2, row_start = y * planes.stride;
  const Float spacing = 2.0F / static_cast<float>(k.taps + 1);
  for (int x = 0; x < planes.width; x += kLanes) {
    const Vector neighbour{load(row.neighbour_x + x), load(row.neighbour_y + x)};
    const Float reach = length(neighbour), own = load(planes.speed + row_start + x);
    const Mask moving = (reach > kLeastRadius_px) & (own > 0.0F);
    if (!any(moving)) continue;
    const Float speed = max(own, kLeastRadius_px), depth = load(planes.depth + row_start + x);
    const Float jitter = load(row.jitter + x);
    Gathered sum = gathered(planes, row_start + x, 1.0F / speed);  // w = 1 / |V[X]|
    for (int i = 0; i < k.taps; ++i) {
      if (i == middle) continue;
      const Float t = (Float(static_cast<float>(i - middle)) + jitter) * spacing;  // mix(-1, 1, (i + j + 1) / (S + 1))
      const Tap tap = tap_at(planes, iota(x), y, {neighbour.x * t, neighbour.y * t});
      const Float d = reach * abs(t);
      const Order order = soft_order((tap.depth - depth) * k.inverse_soft_extent);
      const Float weight = order.before * cone(d, tap.speed) + order.behind * cone(d, speed) +
                           2.0F * cylinder(d, tap.speed) * cylinder(d, speed);
      add(planes, tap, weight, sum);
    }
    store_mean(planes, sum, moving, target, x);
  }
}

}  // namespace aftershade::motionblur
