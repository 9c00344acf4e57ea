#pragma once
#include "core/motionblur/motion_kernel.h"
#include "core/simd/lanes.h"

namespace aftershade::motionblur {

struct HalfVelocityKernel {
  float half_shutter;  ///< frames
  float max_radius;    ///< pixels
};

inline void half_velocity_row(const HalfVelocityKernel& k, VelocityRow prev_row, VelocityRow next_row, int width,
                              float* out_x, float* out_y) {
  using namespace lanes;
  for (int i = 0; i < width; i += kLanes) {
    const detail::Displacement prev = detail::load_displacement(prev_row, i);
    const detail::Displacement next = detail::load_displacement(next_row, i);
    const Float half = select(prev.known & next.known, Float(0.5F * k.half_shutter), Float(k.half_shutter));
    const Float x = half * (next.x - prev.x), y = half * (next.y - prev.y);
    const Float length = sqrt(x * x + y * y);
    const Float scale = select(length > k.max_radius, k.max_radius / length, 1.0F);
    store(out_x + i, x * scale);
    store(out_y + i, y * scale);
  }
}

inline void at_8_bits_row(const float* from, float max_radius, int width, float* out) {
  using namespace lanes;
  for (int i = 0; i < width; i += kLanes) {
    const Float stored = round(255.0F * sat(0.5F * (load(from + i) / max_radius) + 0.5F));
    store(out + i, (stored / 255.0F * 2.0F - 1.0F) * max_radius);
  }
}

}  // namespace aftershade::motionblur
