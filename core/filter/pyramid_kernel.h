#if defined(AFTERSHADE_CORE_FILTER_PYRAMID_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_PYRAMID_KERNEL_H
#undef AFTERSHADE_CORE_FILTER_PYRAMID_KERNEL_H
#else
#define AFTERSHADE_CORE_FILTER_PYRAMID_KERNEL_H
#endif
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

/// One row of a level; coordinates are absolute.
struct PyramidRow {
  ConstPlaneView finer;
  int finer_x, finer_y;  ///< of its index (0, 0)
  int x;                 ///< of the row's first texel
  int width;
  float* out;
};

/// z_{m+1}(x,y) = z_m(2x + (y&1), 2y + (x&1)), clamped to the image; `y` is absolute.
inline void pyramid_row(const PyramidRow& row, int y) {
  const auto finer_row = [&](int at) { return row.finer.row(std::clamp(at - row.finer_y, 0, row.finer.height - 1)); };
  const float *of_even_x = finer_row(2 * y), *of_odd_x = finer_row(2 * y + 1);
  const int last = row.finer.width - 1;
  for (int i = 0; i < row.width; i += kLanes) {
    const int first = 2 * (row.x + i) - row.finer_x;
    const Mask even_x = (iota(row.x + i) & 1) == Int(0);
    if (first >= 0 && first + 2 * kLanes - 1 <= last) {
      const Pairs of_even = load_pairs(of_even_x + first), of_odd = load_pairs(of_odd_x + first);
      store(row.out + i,
            (y & 1) != 0 ? select(even_x, of_even.odd, of_odd.odd) : select(even_x, of_even.even, of_odd.even));
    } else {
      const Int at = clamp((iota(0) << 1) + Int(first + (y & 1)), 0, last);
      store(row.out + i, select(even_x, gather(of_even_x, at), gather(of_odd_x, at)));
    }
  }
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
