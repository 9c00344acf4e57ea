// filter(p) of Guertin et al. 2014 (algorithms 3.1), one row.
#if defined(AFTERSHADE_CORE_MOTIONBLUR_GUERTIN2014_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_GUERTIN2014_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_GUERTIN2014_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_GUERTIN2014_KERNEL_H
#endif
#include "core/motionblur/gather_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

struct Guertin2014Kernel {
  int taps;             ///< N
  float tap_jitter;     ///< eta
  float centre_weight;  ///< N / kappa, pixels
  float inverse_slow;   ///< 1 / gamma, per pixel
};

/// One value a pixel.
struct Guertin2014Row {
  const float *neighbour_x, *neighbour_y;  ///< v_max
  const float* share;                      ///< of the taps that lie along w_c
  const float* jitter;                     ///< j in [-1, 1)
};

/// w_c: along the pixel's own motion if it has one, else across w_n.
inline Vector own_direction(const Guertin2014Kernel& k, Vector along, Vector own, Float speed) {
  const Vector left{-along.y, along.x};
  const Float side = select(dot(left, own) < 0.0F, Float(-1.0F), Float(1.0F));
  const Float share = sat((speed - kLeastRadius_px) * k.inverse_slow);
  const Float across = (1.0F - share) * side;
  const Vector mixed{left.x * across + own.x * share, left.y * across + own.y * share};
  const Float scale = 1.0F / length(mixed);
  return {mixed.x * scale, mixed.y * scale};
}

/// The three cases. `facing_*`: how much motion points along the tap.
inline Float guertin_weight(const Tap& tap, Float distance, Float speed, Float depth, Float facing_centre,
                            Float facing_tap) {
  const Order order = soft_order((tap.depth - depth) / min(tap.depth, depth));
  return order.before * cone(distance, tap.speed) * facing_tap + order.behind * cone(distance, speed) * facing_centre +
         2.0F * cylinder(distance, min(tap.speed, speed)) * max(facing_centre, facing_tap);
}

/// Blurs some columns of a row. Pixels that do not move are left as they are.
inline void guertin2014_row(const Guertin2014Kernel& k, const Guertin2014Row& tiles, const GatherRow& row,
                            Columns columns) {
  const Float spacing = 2.0F / static_cast<float>(k.taps + 1);
  for (int x = columns.first; x < columns.last; x += kLanes) {
    const Vector neighbour{load(tiles.neighbour_x + x), load(tiles.neighbour_y + x)};
    const Float reach = length(neighbour);
    const Mask fast = reach > kLeastRadius_px;
    if (!any(fast)) continue;
    const Tap centre = centre_at(row, x);
    const Mask moving = fast & centre.usable;
    if (!any(moving)) continue;
    const Float scale = 1.0F / max(reach, kLeastRadius_px), speed = centre.speed;
    const Vector along{neighbour.x * scale, neighbour.y * scale};
    const Vector across = own_direction(k, along, centre.direction, speed);
    const Float facing_along = abs(dot(across, along)), share = load(tiles.share + x);
    const Float shift = load(tiles.jitter + x) * k.tap_jitter + 1.0F;
    Gathered sum = gathered(centre, k.centre_weight / speed);
    for (int i = 0; i < k.taps; ++i) {
      const auto number = static_cast<float>(i);
      const Float t = (Float(number) + shift) * spacing - 1.0F;  // lerp(-1, 1, (i + 1 + eta j) / (N + 1))
      const Mask second = floor((number + 1.0F) * share) > floor(number * share);
      const Vector d{select(second, across.x, along.x), select(second, across.y, along.y)};
      const Tap tap = tap_at(row, x, {d.x * (t * reach), d.y * (t * reach)});
      const Float weight = guertin_weight(tap, reach * abs(t), speed, centre.depth, select(second, 1.0F, facing_along),
                                          abs(dot(tap.direction, d)));
      add(tap, weight, sum);
    }
    store_mean(row, sum, moving, x);
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
