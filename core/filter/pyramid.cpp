#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/pyramid.cpp"  // this file, compiled once a SIMD target
#include "core/filter/pyramid.h"

#include <hwy/foreach_target.h>

#include <algorithm>

#include "core/filter/pyramid_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

/// Origins are absolute coordinates of the planes' (0, 0).
void fill_level(ConstPlaneView finer, int finer_x, int finer_y, PlaneView level) {
  const int x = finer_x >> 1, y = finer_y >> 1;
  for_rows(level.height, [&](int i) { pyramid_row({finer, finer_x, finer_y, x, level.width, level.row(i)}, y + i); });
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::filter {

namespace {

HWY_EXPORT(fill_level);

/// Texels that `size` finer ones from absolute coordinate `origin` on come to.
int halved(int origin, int size) { return ((origin + size - 1) >> 1) - (origin >> 1) + 1; }

/// Where a level lies in the plane that holds them all.
struct Place {
  int x, y, width, height;
};

/// Level 1, and the others below each other beside it, with room for the lanes past the end of a row.
std::vector<Place> places(ConstPlaneView depth, int levels, int origin_x, int origin_y) {
  std::vector<Place> out;
  int width = depth.width, height = depth.height;
  for (int m = 1; m < levels; ++m) {
    width = halved(origin_x >> (m - 1), width);
    height = halved(origin_y >> (m - 1), height);
    if (out.size() < 2)
      out.push_back({out.empty() ? 0 : out[0].width + Plane::kPadding, 0, width, height});
    else
      out.push_back({out[1].x, out.back().y + out.back().height, width, height});
  }
  return out;
}

}  // namespace

DepthPyramid::DepthPyramid(ConstPlaneView depth, int levels, int origin_x, int origin_y)
    : origin_x_(origin_x), origin_y_(origin_y), levels_{depth} {
  if (depth.empty()) return;
  const std::vector<Place> all = places(depth, levels, origin_x, origin_y);
  int width = 0, height = 0;
  for (const Place& place : all) {
    width = std::max(width, place.x + place.width);
    height = std::max(height, place.y + place.height);
  }
  mips_ = Plane::for_overwrite(width, height);
  for (const Place& place : all) {
    const PlaneView level{mips_.row(place.y) + place.x, place.width, place.height, mips_.view().stride};
    const auto finer = static_cast<int>(levels_.size()) - 1;
    HWY_DYNAMIC_DISPATCH(fill_level)(levels_.back(), origin_x >> finer, origin_y >> finer, level);
    levels_.push_back(level);
  }
}

}  // namespace aftershade::filter
#endif
