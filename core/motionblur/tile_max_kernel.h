#if defined(AFTERSHADE_CORE_MOTIONBLUR_TILE_MAX_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_TILE_MAX_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_TILE_MAX_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_TILE_MAX_KERNEL_H
#endif
#include "core/motionblur/column_max.h"
#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// Takes one row of velocities into `best`; an equal length changes nothing, a NaN neither.
inline void column_max_row(const float* x, const float* y, int width, ColumnMax best) {
  for (int i = 0; i < width; i += kLanes) {
    const Float vx = load(x + i), vy = load(y + i);
    const Float square = vx * vx + vy * vy, before = load(best.square + i);
    const Mask longer = square > before;
    store(best.square + i, select(longer, square, before));
    store(best.x + i, select(longer, vx, load(best.x + i)));
    store(best.y + i, select(longer, vy, load(best.y + i)));
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
