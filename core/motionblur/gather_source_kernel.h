#pragma once
#include "core/motionblur/gather_source.h"
#include "core/simd/lanes.h"

namespace aftershade::motionblur {

/// Values from here on, of metres or of light, stand for "infinite"; sums of weighted differences of smaller ones fit a
/// float.
inline constexpr float kInfinite = 1e30F;

inline void speed_row(const float* vx, const float* vy, int width, float* speed) {
  using namespace lanes;
  for (int x = 0; x < width; x += kLanes) {
    const Float a = load(vx + x), b = load(vy + x);
    store(speed + x, max(sqrt(a * a + b * b), kLeastRadius_px));
  }
}

/// Sets the speed to 0 where `channel` cannot be used.
inline void exclude_row(const float* channel, int width, float* speed) {
  using namespace lanes;
  for (int x = 0; x < width; x += kLanes)
    store(speed + x, select(abs(load(channel + x)) < kInfinite, load(speed + x), Float(0.0F)));
}

inline void finite_depth_row(const float* depth, int width, float* out) {
  using namespace lanes;
  for (int x = 0; x < width; x += kLanes) {
    const Float z = load(depth + x);
    store(out + x, select((z > 0.0F) & (z < kInfinite), z, Float(kInfinite)));
  }
}

}  // namespace aftershade::motionblur
