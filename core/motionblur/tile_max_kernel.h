#pragma once
#include "core/simd/lanes.h"

namespace aftershade::motionblur {

/// The longest vector met so far in each pixel column; `square` starts at 0 (so does a column of zeros).
struct ColumnMax {
  float *square, *x, *y;
};

/// Takes one row of velocities into `best`; an equal length changes nothing, a NaN neither.
inline void column_max_row(const float* x, const float* y, int width, ColumnMax best) {
  using namespace lanes;
  for (int i = 0; i < width; i += kLanes) {
    const Float vx = load(x + i), vy = load(y + i);
    const Float square = vx * vx + vy * vy, before = load(best.square + i);
    const Mask longer = square > before;
    store(best.square + i, select(longer, square, before));
    store(best.x + i, select(longer, vx, load(best.x + i)));
    store(best.y + i, select(longer, vy, load(best.y + i)));
  }
}

}  // namespace aftershade::motionblur
