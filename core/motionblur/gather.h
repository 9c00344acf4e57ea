#pragma once
#include <algorithm>
#include <span>

#include "core/image/window.h"
#include "core/motionblur/gather_source.h"

/// What gathering blurs are given, and what they read of it.
namespace aftershade::motionblur {

struct GatherInput {
  ConstPlaneView depth;          ///< metres, or empty: everything at one depth
  const HalfVelocity* velocity;  ///< within limit_px() of the method
  Window window;
  int display_height;
};

/// A radius that is `radius_px` at the reference height, in whole pixels of this image, at least 1.
int radius_at(float radius_px, float reference_height_px, int display_height);

/// The longest half-exposure velocity that a method lets through, in pixels: its max_radius_px at this height, or with
/// 0 the longer side of the image.
template <class Params>
float limit_px(const Params& params, Window window, int display_height) {
  const int limit = params.max_radius_px > 0
                        ? radius_at(params.max_radius_px, params.reference_height_px, display_height)
                        : std::max(window.width(), window.height());
  return static_cast<float>(limit);
}

/// A method's radius and tile size in pixels: its max_radius_px at this height, or with 0 the longest of the
/// velocities, which are within limit_px().
template <class Params>
int radius_px(const Params& params, const HalfVelocity& velocity, int display_height) {
  return params.max_radius_px > 0 ? radius_at(params.max_radius_px, params.reference_height_px, display_height)
                                  : radius_at(longest_px(velocity), 1, 1);
}

}  // namespace aftershade::motionblur
