#pragma once
#include <span>
#include <vector>

#include "core/image/plane.h"
#include "core/motionblur/half_velocity.h"
#include "core/motionblur/moving_tiles.h"

namespace aftershade::motionblur {

/// The paper's least radius of a pixel's own blur, in pixels (algorithms 2.1).
inline constexpr float kLeastRadius_px = 0.5F;

/// In norm(v) = v / (|v| + 1e-5) (algorithms 2.1).
inline constexpr float kNoDivisionByZero = 1e-5F;

/// What a gather reads of a pixel lies side by side, so that a tap costs two loads a lane: four channels (0 where there
/// are fewer), then
///   speed: max(|v|, half a pixel); 0 where a channel is not finite, or beyond 1e30: not to be used
///   depth: metres; 1e30 for background, so that no difference is infinity minus infinity
/// and, where it is asked for, the direction norm(v).
struct GatherRecord {
  static constexpr int kChannels = 4, kSpeed = 4, kDirection = 6;
  static constexpr int kFloats = 6, kFloatsWithDirection = 8;
};

/// Copies, because the result replaces the channels; made only of the pixels that `tiles` says are read.
struct GatherSource {
  int width, height;
  int record_floats;           ///< from pixel to pixel
  std::vector<Plane> records;  ///< one for every four channels
};

/// Without depth (data == nullptr) everything is background. In a depth plane +inf, NaN and <= 0 are.
GatherSource gather_source(const HalfVelocity& velocity, ConstPlaneView depth, std::span<Plane* const> channels,
                           const MovingTiles& tiles, bool with_direction = false);

}  // namespace aftershade::motionblur
