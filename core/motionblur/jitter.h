#pragma once
#include "core/image/plane.h"
#include "core/image/window.h"

/// How taps shift from pixel to pixel to turn banding into noise: pure functions of absolute pixel coordinates.
namespace aftershade::motionblur {

/// Uniform in [-0.5, 0.5), independent from pixel to pixel.
Plane random_jitter(Window window);

/// In [-1, 1), low-discrepancy: every small neighbourhood covers the range evenly. Roberts' R2 lattice ("The
/// Unreasonable Effectiveness of Quasirandom Sequences", 2018): the fraction of x / p + y / p^2, p^3 = p + 1.
Plane even_jitter(Window window);

}  // namespace aftershade::motionblur
