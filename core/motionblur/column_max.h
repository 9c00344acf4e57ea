#pragma once

namespace aftershade::motionblur {

/// The longest vector in each pixel column, with the square of its length; 0 where all are.
struct ColumnMax {
  float *square, *x, *y;
};

}  // namespace aftershade::motionblur
