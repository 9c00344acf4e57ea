#pragma once
#include "core/image/plane.h"

namespace aftershade::ao {

/// What a renderer's pixel filter does to values at pixel centres: a Gaussian of this standard deviation, in texels of
/// the two planes, over the surface among them (depth as in filter::Surface). Background stays as it is. deviation > 0.
Plane pixel_filtered(ConstPlaneView values, ConstPlaneView depth, float deviation);

}  // namespace aftershade::ao
