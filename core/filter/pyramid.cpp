#include "core/filter/pyramid.h"

#include <algorithm>

#include "core/parallel/rows.h"

namespace aftershade::filter {

DepthPyramid::DepthPyramid(ConstPlaneView depth, int levels, int origin_x, int origin_y)
    : base_(depth), origin_x_(origin_x), origin_y_(origin_y) {
  if (depth.empty()) return;
  for (int m = 1; m < levels; ++m) {
    const ConstPlaneView finer = level(m - 1);
    const int fine_x = origin_x >> (m - 1), fine_y = origin_y >> (m - 1), coarse_x = origin_x >> m,
              coarse_y = origin_y >> m;
    Plane mip(((fine_x + finer.width - 1) >> 1) - coarse_x + 1, ((fine_y + finer.height - 1) >> 1) - coarse_y + 1);
    for_rows(mip.height(), [&](int y) {
      for (int x = 0; x < mip.width(); ++x) {
        const int ax = coarse_x + x, ay = coarse_y + y;
        const int fx = 2 * ax + (ay & 1) - fine_x, fy = 2 * ay + (ax & 1) - fine_y;
        mip(x, y) = finer(std::clamp(fx, 0, finer.width - 1), std::clamp(fy, 0, finer.height - 1));
      }
    });
    mips_.push_back(std::move(mip));
  }
}

}  // namespace aftershade::filter
