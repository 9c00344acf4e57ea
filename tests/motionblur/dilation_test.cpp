#include "core/motionblur/dilation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/motionblur/blur_scene.h"

namespace aftershade::tests {
namespace {

using motionblur::Dilation;
using motionblur::HalfVelocity;

constexpr int kTile = 8;
constexpr Window kWindow{0, 0, 5 * kTile - 1, 5 * kTile - 1};

/// One moving pixel at (x, y); which of the 5x5 tiles its velocity gets to, as "column row" pairs.
std::vector<std::pair<int, int>> reached(Dilation rule, int x, int y, float vx, float vy) {
  HalfVelocity v{Plane(kWindow.width(), kWindow.height()), Plane(kWindow.width(), kWindow.height())};
  v.x(x, y) = vx;
  v.y(x, y) = vy;
  const HalfVelocity out = motionblur::dilated(rule, v, motionblur::tile_max(v, kTile, kWindow), kTile, kWindow);
  std::vector<std::pair<int, int>> tiles;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column)
      if (out.x(column, row) != 0 || out.y(column, row) != 0) tiles.emplace_back(column, row);
  return tiles;
}
using Tiles = std::vector<std::pair<int, int>>;

TEST(Dilation, SquareReachesAllAround) {
  EXPECT_EQ(reached(Dilation::square, 20, 20, 5, 0).size(), 9U);
  EXPECT_EQ(reached(Dilation::square, 0, 39, 5, 0).size(), 4U) << "in a corner";
}

TEST(Dilation, DirectionalReachesAlongTheMotion) {
  EXPECT_EQ(reached(Dilation::directional, 20, 20, 5, 0), (Tiles{{1, 2}, {2, 2}, {3, 2}}));
  EXPECT_EQ(reached(Dilation::directional, 20, 20, 0, -5), (Tiles{{2, 1}, {2, 2}, {2, 3}}));
  const Tiles descending{{1, 1}, {2, 1}, {1, 2}, {2, 2}, {3, 2}, {2, 3}, {3, 3}};
  EXPECT_EQ(reached(Dilation::directional, 20, 20, 5, 0.1F), descending);
  EXPECT_EQ(reached(Dilation::directional, 20, 20, -5, -0.1F), descending) << "the blur goes both ways";
}

TEST(Dilation, LineReachesWhatThePixelsSegmentCrosses) {
  EXPECT_EQ(reached(Dilation::line, 20, 20, 3, 0), (Tiles{{2, 2}})) << "17.5 to 23.5 stays within the tile";
  EXPECT_EQ(reached(Dilation::line, 20, 20, 4, 0), (Tiles{{2, 2}, {3, 2}}));
  EXPECT_EQ(reached(Dilation::line, 20, 20, -5, 0), (Tiles{{1, 2}, {2, 2}, {3, 2}}));
  EXPECT_EQ(reached(Dilation::line, 22, 16, 5, -5), (Tiles{{2, 1}, {3, 1}, {2, 2}}))
      << "through the edge above, before the corner";
  EXPECT_EQ(reached(Dilation::line, 16, 16, 7, 7), (Tiles{{1, 1}, {2, 1}, {1, 2}, {2, 2}}))
      << "a corner belongs to all that meet there";
}

TEST(Dilation, EveryRuleKeepsTheTilesOwnAndNoneInventsMotion) {
  const BlurScene scene = make_blur_scene({-5, 3, 57, 44}, [](int x, int y) { return patchy_pixel(x, y, 8); });
  const HalfVelocity tiles = motionblur::tile_max(scene.velocity, kTile, scene.window);
  const HalfVelocity square = motionblur::neighbour_max(tiles);
  const auto speed = [](const HalfVelocity& v, int x, int y) { return std::hypot(v.x(x, y), v.y(x, y)); };
  int less[3] = {};
  for (const Dilation rule : {Dilation::square, Dilation::directional, Dilation::line}) {
    const HalfVelocity out = motionblur::dilated(rule, scene.velocity, tiles, kTile, scene.window);
    for (int y = 0; y < tiles.x.height(); ++y)
      for (int x = 0; x < tiles.x.width(); ++x) {
        EXPECT_GE(speed(out, x, y), speed(tiles, x, y));
        EXPECT_LE(speed(out, x, y), speed(square, x, y));
        less[static_cast<int>(rule)] += speed(out, x, y) < speed(square, x, y);
      }
  }
  EXPECT_EQ(less[0], 0);
  EXPECT_GT(less[1], 0);
  EXPECT_GT(less[2], less[1]) << "more selective";
}

}  // namespace
}  // namespace aftershade::tests
