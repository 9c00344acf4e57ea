#pragma once
#include "core/image/plane.h"
#include "core/simd/lanes.h"

namespace aftershade::temporal {
using namespace lanes;

/// dilatedMask = all_{n x n}(continuityMask) (seed 000, "Two Half-Res Passes"), one axis at a time: the least value
/// over offsets first to last. Clamped indices repeat texels of the same neighbourhood, so the outside never counts.
struct LeastAlongRow {
  const float* source;
  int width, first, last;
  float* target;
};
inline void least_along_row(const LeastAlongRow& row) {
  for (int x = 0; x < row.width; x += kLanes) {
    Float least = 1.0F;
    for (int offset = row.first; offset <= row.last; ++offset)
      least = min(least, gather(row.source, clamp(iota(x + offset), 0, row.width - 1)));
    store(row.target + x, least);
  }
}

struct LeastAcrossRows {
  ConstPlaneView source;
  int first, last;  ///< rows of the source, inside it
  float* target;
};
inline void least_across_rows(const LeastAcrossRows& row) {
  for (int x = 0; x < row.source.width; x += kLanes) {
    Float least = 1.0F;
    for (int y = row.first; y <= row.last; ++y) least = min(least, load(row.source.row(y) + x));
    store(row.target + x, least);
  }
}

}  // namespace aftershade::temporal
