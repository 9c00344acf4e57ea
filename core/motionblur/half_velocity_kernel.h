#pragma once
#include "core/simd/lanes.h"

namespace aftershade::motionblur {

struct HalfVelocityKernel {
  float half_shutter;  ///< frames
  float max_radius;    ///< pixels
};

/// One row. `prev` or `next` may be null pointers: unknown everywhere.
struct VelocityRow {
  const float *x, *y;
};

namespace detail {

/// A displacement as long as this is a sentinel, not a motion; its square still is a float.
inline constexpr float kSentinel_px = 1e15F;

struct Displacement {
  lanes::Float x, y;
  lanes::Mask known;
};

inline Displacement load_displacement(VelocityRow row, int i) {
  using namespace lanes;
  if (row.x == nullptr || row.y == nullptr) return {0.0F, 0.0F, Float(0.0F) > Float(0.0F)};
  const Float x = load(row.x + i), y = load(row.y + i);
  const Mask known = (abs(x) < kSentinel_px) & (abs(y) < kSentinel_px);
  return {select(known, x, 0.0F), select(known, y, 0.0F), known};
}

}  // namespace detail

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

}  // namespace aftershade::motionblur
