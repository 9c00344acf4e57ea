#pragma once
#include <span>
#include <vector>

#include "core/image/plane.h"
#include "core/motionblur/half_velocity.h"

namespace aftershade::motionblur {

/// The paper's least radius of a pixel's own blur, in pixels (algorithms 2.1).
inline constexpr float kLeastRadius_px = 0.5F;

/// What a gather reads of every pixel, at one size and stride: copies, because the result replaces the channels.
struct GatherSource {
  Plane speed;  ///< max(|v|, half a pixel); 0 where a channel is not finite, or beyond 1e30: not to be used
  Plane depth;  ///< metres; 1e30 for background, so that no difference is infinity minus infinity
  std::vector<Plane> colour;  ///< one a channel
};

/// Without depth (data == nullptr) everything is background. In a depth plane +inf, NaN and <= 0 are.
GatherSource gather_source(const HalfVelocity& velocity, ConstPlaneView depth, std::span<Plane* const> channels);

}  // namespace aftershade::motionblur
