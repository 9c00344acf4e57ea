#if defined(AFTERSHADE_CORE_MOTIONBLUR_TILE_MAX_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_TILE_MAX_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_TILE_MAX_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_TILE_MAX_KERNEL_H
#endif
#include "core/image/plane.h"
#include "core/motionblur/column_max.h"
#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// Of kVectors groups of columns from x on, the longest vector in the rows first to last - 1; an equal length changes
/// nothing, a NaN neither.
template <int kVectors>
void column_max_block(ConstPlaneView vx, ConstPlaneView vy, int first, int last, int x, const ColumnMax& best) {
  Float square[kVectors], best_x[kVectors], best_y[kVectors];
  for (int i = 0; i < kVectors; ++i) square[i] = best_x[i] = best_y[i] = 0.0F;
  for (int y = first; y < last; ++y)
    for (int i = 0; i < kVectors; ++i) {
      const Float here_x = load(vx.row(y) + x + i * kLanes), here_y = load(vy.row(y) + x + i * kLanes);
      const Float here = here_x * here_x + here_y * here_y;
      const Mask longer = here > square[i];
      square[i] = select(longer, here, square[i]);
      best_x[i] = select(longer, here_x, best_x[i]);
      best_y[i] = select(longer, here_y, best_y[i]);
    }
  for (int i = 0; i < kVectors; ++i) {
    store(best.square + x + i * kLanes, square[i]);
    store(best.x + x + i * kLanes, best_x[i]);
    store(best.y + x + i * kLanes, best_y[i]);
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
