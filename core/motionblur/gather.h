#pragma once
#include <functional>
#include <span>

#include "core/image/window.h"
#include "core/motionblur/gather_kernel.h"
#include "core/motionblur/gather_source.h"

/// The frame around a gathering blur's row kernel.
namespace aftershade::motionblur {

struct GatherInput {
  ConstPlaneView depth;          ///< metres, or empty: everything at one depth
  const HalfVelocity* velocity;  ///< clamped to the method's radius
  Window window;
  int display_height;
};

/// A radius that is `radius_px` at the reference height, in whole pixels of this image, at least 1.
int radius_at(float radius_px, float reference_height_px, int display_height);

/// Does any of these velocities reach farther than half a pixel?
bool any_moves(const HalfVelocity& velocity);

/// One row of one group of channels: `target[c]` is row y of channel c and holds the source's values.
using GatherRow = std::function<void(const GatherPlanes&, float* const* target, int y)>;

/// Calls `row` for all rows, over threads, for four channels at a time: channels[i] becomes what `row` makes of
/// source.colour[i].
void gather_rows(const GatherSource& source, std::span<Plane* const> channels, const GatherRow& row);

}  // namespace aftershade::motionblur
