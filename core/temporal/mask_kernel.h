#if defined(AFTERSHADE_CORE_TEMPORAL_MASK_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_TEMPORAL_MASK_KERNEL_H
#undef AFTERSHADE_CORE_TEMPORAL_MASK_KERNEL_H
#else
#define AFTERSHADE_CORE_TEMPORAL_MASK_KERNEL_H
#endif
#include "core/filter/lane_geometry.h"
#include "core/image/plane.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

/// dilatedMask = all_{n x n}(continuityMask) (seed 000, "Two Half-Res Passes"), one axis at a time: the least value
/// over offsets first to last. Clamped indices repeat texels of the same neighbourhood, so the outside never counts.
struct LeastAlongRow {
  const float* source;
  int width, first, last;
  float* target;
};
inline void least_along_row(const LeastAlongRow& row) {
  for_each_vector(row.width, -row.first, row.last, [&](int x, auto inside) {
    Float least = 1.0F;
    for (int offset = row.first; offset <= row.last; ++offset)
      least = min(least, Columns<inside()>(x + offset, row.width)(row.source));
    store(row.target + x, least);
  });
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

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
