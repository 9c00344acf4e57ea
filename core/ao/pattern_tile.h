#pragma once
#include "core/simd/lanes.h"

namespace aftershade::ao {

/// Index into a 4x4 pattern (row y, column x) by absolute texel coordinates.
inline lanes::Int tile_cell(lanes::Int x, lanes::Int y) { return ((y & 3) << 2) + (x & 3); }

}  // namespace aftershade::ao
