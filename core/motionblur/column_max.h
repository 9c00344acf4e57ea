#pragma once

namespace aftershade::motionblur {

/// The longest vector met so far in each pixel column; `square` starts at 0 (so does a column of zeros).
struct ColumnMax {
  float *square, *x, *y;
};

}  // namespace aftershade::motionblur
