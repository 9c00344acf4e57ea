#pragma once
#include "core/image/frame.h"
#include "core/params/table.h"
#include "core/preset/preset.h"

namespace aftershade::app {

/// Every length in metres of the preset's stages, as text with the pixels that it means at `depth_m`: a radius after
/// its clamp, a distance threshold after the footprints that it never falls below. Warns of an AO radius that is too
/// small or too large to work. `frame` has a camera.
params::Json lengths_report(const preset::Preset& preset, const Frame& frame, double depth_m);

}  // namespace aftershade::app
