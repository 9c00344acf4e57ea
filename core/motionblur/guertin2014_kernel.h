#pragma once
#include "core/motionblur/gather_kernel.h"

/// filter(p) of Guertin et al. 2014 (algorithms 3.1), one row.
namespace aftershade::motionblur {

struct Guertin2014Kernel {
  int taps;                                ///< N
  float tap_jitter;                        ///< eta
  float centre_weight;                     ///< N / kappa, pixels
  float inverse_slow;                      ///< 1 / gamma, per pixel
  const float *direction_x, *direction_y;  ///< norm(v), with GatherPlanes' stride
};

/// One value a pixel.
struct Guertin2014Row {
  const float *neighbour_x, *neighbour_y;  ///< v_max
  const float* share;                      ///< of the taps that lie along w_c
  const float* jitter;                     ///< j in [-1, 1)
};

inline void directions_row(const float* vx, const float* vy, int width, float* x_out, float* y_out) {
  using namespace gathering;
  for (int x = 0; x < width; x += kLanes) {
    const Vector v{load(vx + x), load(vy + x)};
    const Float scale = 1.0F / (length(v) + kNoDivisionByZero);
    store(x_out + x, v.x * scale);
    store(y_out + x, v.y * scale);
  }
}

namespace gathering {

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

}  // namespace gathering

/// Blurs row y. Pixels that do not move are left as they are in `target`, which holds the source's values.
inline void guertin2014_row(const Guertin2014Kernel& k, const GatherPlanes& planes, const Guertin2014Row& row,
                            float* const* target, int y) {
  using namespace gathering;
  const int row_start = y * planes.stride;
  const Float spacing = 2.0F / static_cast<float>(k.taps + 1);
  for (int x = 0; x < planes.width; x += kLanes) {
    const Vector neighbour{load(row.neighbour_x + x), load(row.neighbour_y + x)};
    const Float reach = length(neighbour), own_speed = load(planes.speed + row_start + x);
    const Mask moving = (reach > kLeastRadius_px) & (own_speed > 0.0F);
    if (!any(moving)) continue;
    const Float speed = max(own_speed, kLeastRadius_px), depth = load(planes.depth + row_start + x);
    const Float scale = 1.0F / max(reach, kLeastRadius_px);
    const Vector along{neighbour.x * scale, neighbour.y * scale};
    const Vector own{load(k.direction_x + row_start + x), load(k.direction_y + row_start + x)};
    const Vector across = own_direction(k, along, own, speed);
    const Float facing_along = abs(dot(across, along)), share = load(row.share + x);
    const Float shift = load(row.jitter + x) * k.tap_jitter + 1.0F;
    Gathered sum = gathered(planes, row_start + x, k.centre_weight / speed);
    for (int i = 0; i < k.taps; ++i) {
      const auto number = static_cast<float>(i);
      const Float t = (Float(number) + shift) * spacing - 1.0F;  // lerp(-1, 1, (i + 1 + eta j) / (N + 1))
      const Mask second = floor((number + 1.0F) * share) > floor(number * share);
      const Vector d{select(second, across.x, along.x), select(second, across.y, along.y)};
      const Tap tap = tap_at(planes, iota(x), y, {d.x * (t * reach), d.y * (t * reach)});
      const Vector motion{gather(k.direction_x, tap.index), gather(k.direction_y, tap.index)};
      const Float weight =
          guertin_weight(tap, reach * abs(t), speed, depth, select(second, 1.0F, facing_along), abs(dot(motion, d)));
      add(planes, tap, weight, sum);
    }
    store_mean(planes, sum, moving, target, x);
  }
}

}  // namespace aftershade::motionblur
