#if defined(AFTERSHADE_CORE_MOTIONBLUR_HALF_VELOCITY_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_HALF_VELOCITY_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_HALF_VELOCITY_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_HALF_VELOCITY_KERNEL_H
#endif
#include "core/motionblur/motion_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

struct HalfVelocityKernel {
  float half_shutter;  ///< frames
  float max_radius;    ///< pixels
};

inline void store_half_velocity(const HalfVelocityKernel& k, Displacement prev, Displacement next, float* out_x,
                                float* out_y) {
  const Float half = select(prev.known & next.known, Float(0.5F * k.half_shutter), Float(k.half_shutter));
  const Float x = half * (next.x - prev.x), y = half * (next.y - prev.y);
  const Float length = sqrt(x * x + y * y);
  const Float scale = select(length > k.max_radius, k.max_radius / length, 1.0F);
  store(out_x, x * scale);
  store(out_y, y * scale);
}

inline void half_velocity_row(const HalfVelocityKernel& k, VelocityRow prev, VelocityRow next, int width, float* out_x,
                              float* out_y) {
  for (int i = 0; i < width; i += kLanes)
    store_half_velocity(k, load_displacement(prev, i), load_displacement(next, i), out_x + i, out_y + i);
}

/// The same of the motion that motion_row() gives.
inline WithoutVector half_velocity_row(const HalfVelocityKernel& k, const MotionKernel& motion, const MotionRow& row,
                                       float* out_x, float* out_y) {
  Lone lone{nowhere(), nowhere()};
  for (int i = 0; i < row.width; i += kLanes) {
    const BothWays d = motion_at(motion, row, i, lone);
    store_half_velocity(k, displacement_of(d.prev.x, d.prev.y), displacement_of(d.next.x, d.next.y), out_x + i,
                        out_y + i);
  }
  return without_vector(lone);
}

inline void at_8_bits_row(const float* from, float max_radius, int width, float* out) {
  for (int i = 0; i < width; i += kLanes) {
    const Float stored = round(255.0F * sat(0.5F * (load(from + i) / max_radius) + 0.5F));
    store(out + i, (stored / 255.0F * 2.0F - 1.0F) * max_radius);
  }
}

/// Square of the length of the row's longest vector.
inline float longest_square(const float* vx, const float* vy, int width) {
  Float longest = 0.0F;
  for (int i = 0; i < width; i += kLanes) {
    const Float x = load(vx + i), y = load(vy + i);
    longest = max(select(iota(i) < Int(width), x * x + y * y, 0.0F), longest);
  }
  float lanes[kLanes], most = 0;
  store(lanes, longest);
  for (const float lane : lanes) most = lane > most ? lane : most;
  return most;
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
