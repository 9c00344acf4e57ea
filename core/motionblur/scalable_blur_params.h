#pragma once
#include "core/motionblur/scalable_blur.h"

namespace aftershade::motionblur {

struct ScalableBlurKernel {
  int origin_x, origin_y;  ///< absolute coordinates of pixel (0, 0): the jitter is tied to them
  int taps;                ///< odd
  int passes;
  bool checkerboard;
  Directions directions;
  bool relative;              ///< compares depths by their ratio, not over the soft extent
  float inverse_soft_extent;  ///< 1 / metres
  float background_weight, foreground_weight, both_moving_weight, centre_weight;
};

/// What a frame's tiles say of its pixels.
struct BlurTiles {
  TileGrid grid;
  const MovingTiles& moving;
  const HalfVelocity& velocity;     ///< of the pixels
  HalfVelocity neighbourhood, own;  ///< the longest around each tile, and of each tile: widened()
};

}  // namespace aftershade::motionblur
