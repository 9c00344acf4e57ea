#if defined(AFTERSHADE_CORE_AO_PATTERN_TILE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_PATTERN_TILE_H
#undef AFTERSHADE_CORE_AO_PATTERN_TILE_H
#else
#define AFTERSHADE_CORE_AO_PATTERN_TILE_H
#endif
#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

/// Index into a 4x4 pattern (row y, column x) by absolute texel coordinates.
inline lanes::HWY_NAMESPACE::Int tile_cell(lanes::HWY_NAMESPACE::Int x, lanes::HWY_NAMESPACE::Int y) {
  return ((y & 3) << 2) + (x & 3);
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
