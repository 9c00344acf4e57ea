#if defined(AFTERSHADE_CORE_MOTIONBLUR_DILATION_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_DILATION_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_DILATION_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_DILATION_KERNEL_H
#endif
#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// One row of pixels and the neighbouring tile at an offset, -1 to 1 tiles, from that of each pixel.
struct CrossingRow {
  const float* inside_x;  ///< of every pixel centre, from its tile's left edge: within (0, tile)
  float inside_y;         ///< from the tile's top edge
  float tile, offset_x, offset_y;
};

/// The times t at which a coordinate `from` + t v lies within [low, high]; `from` is on neither. v = 0 divides to
/// infinities that say always or never.
struct Times {
  Float first, last;
};
inline Times times_within(Float from, Float v, float low, float high) {
  const Float a = (low - from) / v, b = (high - from) / v;
  return {min(a, b), max(a, b)};
}

/// Velocities whose segment from -v to v crosses the tile at the offset, 0 for the others.
inline void crossing_row(const CrossingRow& row, const float* vx, const float* vy, int width, float* out_x,
                         float* out_y) {
  const float left = row.offset_x * row.tile, top = row.offset_y * row.tile;
  for (int i = 0; i < width; i += kLanes) {
    const Float x = load(vx + i), y = load(vy + i);
    const Times across = times_within(load(row.inside_x + i), x, left, left + row.tile);
    const Times down = times_within(row.inside_y, y, top, top + row.tile);
    const Mask crosses = max(max(across.first, down.first), -1.0F) <= min(min(across.last, down.last), 1.0F);
    store(out_x + i, select(crosses, x, 0.0F));
    store(out_y + i, select(crosses, y, 0.0F));
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
