#include "core/filter/sample_grid.h"

#include <gtest/gtest.h>

#include <set>

#include "core/filter/pyramid.h"
#include "core/math/sampling.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

/// Depths that are a function of the absolute pixel.
Picture noise(int width, int height, int origin_x, int origin_y) {
  return picture(
      width, height, Lens{},
      [](double x, double y) {
        const auto coordinate = [](double v) { return static_cast<uint32_t>(static_cast<int>(std::floor(v))); };
        return Hit{1.0 + unit_float(hash_counters(coordinate(x), coordinate(y))), {0, 0, -1}};
      },
      origin_x, origin_y);
}

TEST(SampleGrid, FullHasEveryPixelAndOneKindOfBackground) {
  Picture p = noise(3, 2, 0, 0);
  p.depth(0, 0) = kNan;
  p.depth(1, 0) = -2;
  p.depth(2, 0) = kInf;
  const filter::SampleGrid grid = filter::full_grid(p.surface());
  EXPECT_EQ(grid.step, 1);
  EXPECT_TRUE(grid.pixel_x.empty());
  for (int x = 0; x < 3; ++x) {
    EXPECT_EQ(grid.depth(x, 0), kInf);
    EXPECT_EQ(grid.depth(x, 1), p.depth(x, 1));
  }
}

TEST(SampleGrid, HalfPicksNearestAndFarthestInACheckerboardOfAbsoluteBlocks) {
  for (int origin_y : {-3, -2, 0, 1})
    for (int origin_x : {-5, -4, 0, 7})
      for (int height : {1, 2, 5})
        for (int width : {1, 4, 7}) {
          const Picture p = noise(width, height, origin_x, origin_y);
          const filter::SampleGrid grid = filter::half_grid(p.surface());
          std::set<std::pair<int, int>> blocks;
          for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
              blocks.insert({static_cast<int>(std::floor((origin_x + x) / 2.0)),
                             static_cast<int>(std::floor((origin_y + y) / 2.0))});
          ASSERT_EQ(static_cast<size_t>(grid.width() * grid.height()), blocks.size());
          for (const auto& [bx, by] : blocks) {
            float nearest = kInf, farthest = 0;
            for (int y = std::max(0, 2 * by - origin_y); y < std::min(height, 2 * by - origin_y + 2); ++y)
              for (int x = std::max(0, 2 * bx - origin_x); x < std::min(width, 2 * bx - origin_x + 2); ++x) {
                nearest = std::min(nearest, p.depth(x, y));
                farthest = std::max(farthest, p.depth(x, y));
              }
            const int gx = (2 * bx - origin_x - grid.origin_x) / 2, gy = (2 * by - origin_y - grid.origin_y) / 2;
            const bool even = ((bx + by) % 2 + 2) % 2 == 0;
            EXPECT_EQ(grid.depth(gx, gy), even ? nearest : farthest);
            EXPECT_EQ(p.depth(static_cast<int>(grid.pixel_x(gx, gy)), static_cast<int>(grid.pixel_y(gx, gy))),
                      grid.depth(gx, gy));
          }
        }
}

TEST(SampleGrid, HalfPrefersAnySurfaceToBackground) {
  Picture p = noise(4, 2, 0, 0);
  for (int x : {0, 2}) p.depth(x, 0) = p.depth(x + 1, 0) = p.depth(x, 1) = x == 0 ? kInf : kNan;
  const filter::SampleGrid grid = filter::half_grid(p.surface());
  EXPECT_EQ(grid.depth(0, 0), p.depth(1, 1));
  EXPECT_EQ(grid.depth(1, 0), p.depth(3, 1)) << "farthest, but not the background";
  p.depth(1, 1) = p.depth(3, 1) = 0;
  const filter::SampleGrid empty = filter::half_grid(p.surface());
  EXPECT_EQ(empty.depth(0, 0), kInf);
  EXPECT_EQ(empty.depth(1, 0), kInf);
}

TEST(DepthPyramid, HoldsDepthsThatExistByTheRotatedGrid) {
  const Picture p = noise(13, 9, 0, 0);
  const filter::DepthPyramid pyramid(p.depth, 6);
  ASSERT_EQ(pyramid.levels(), 6);
  for (int m = 1; m < 6; ++m) {
    const ConstPlaneView fine = pyramid.level(m - 1), coarse = pyramid.level(m);
    ASSERT_EQ(coarse.width, (fine.width + 1) / 2);
    ASSERT_EQ(coarse.height, (fine.height + 1) / 2);
    for (int y = 0; y < coarse.height; ++y)
      for (int x = 0; x < coarse.width; ++x)
        EXPECT_EQ(coarse(x, y),
                  fine(std::min(2 * x + (y & 1), fine.width - 1), std::min(2 * y + (x & 1), fine.height - 1)));
  }
}

TEST(DepthPyramid, OfAMovedWindowHoldsTheSamePixels) {
  const Picture whole = noise(64, 64, -32, -32), part = noise(41, 37, -13, -9);
  const filter::DepthPyramid a(whole.depth, 4, -32, -32), b(part.depth, 4, -13, -9);
  for (int m = 0; m < 4; ++m) {
    int compared = 0;
    for (int y = 1; y + 1 < b.level(m).height; ++y)  // at the borders the window clamps
      for (int x = 1; x + 1 < b.level(m).width; ++x, ++compared) {
        const int ax = x + (-13 >> m) - (-32 >> m), ay = y + (-9 >> m) - (-32 >> m);
        EXPECT_EQ(b.level(m)(x, y), a.level(m)(ax, ay)) << m;
      }
    EXPECT_GT(compared, 4);
  }
}

}  // namespace
}  // namespace aftershade::tests
