#include "core/motionblur/guertin_tiles.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aftershade::tests {
namespace {

using motionblur::HalfVelocity;

HalfVelocity still_tiles(int columns, int rows) { return {Plane(columns, rows), Plane(columns, rows)}; }

TEST(DirectionVariance, IsTheMeanDisagreementWithAdjacentTiles) {
  HalfVelocity tiles = still_tiles(4, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) tiles.x(x, y) = x % 2 == 0 ? 5.0F : -2.0F;
  EXPECT_NEAR(motionblur::direction_variance(tiles)(1, 1), 0, 1e-5) << "opposed motion blurs alike";
  tiles.x(0, 1) = 0;
  tiles.y(0, 1) = 5;
  EXPECT_NEAR(motionblur::direction_variance(tiles)(1, 1), 1.0 / 8, 1e-5) << "one is perpendicular";
  tiles.x(2, 1) = 0;
  EXPECT_NEAR(motionblur::direction_variance(tiles)(1, 1), 2.0 / 8, 1e-5) << "one stands still";
  EXPECT_NEAR(motionblur::direction_variance(tiles)(3, 0), 1.0 / 3, 1e-5) << "a corner has three neighbours";
  EXPECT_EQ(motionblur::direction_variance(still_tiles(1, 1))(0, 0), 0);
}

/// Share of pixels of a column that took the right one of two tiles of 16 px; the border lies before column 16.
double share_of_the_right_tile(int x, float reach) {
  constexpr int kRows = 16 * 400;
  const Window window{0, 0, 31, kRows - 1};
  HalfVelocity tiles = still_tiles(2, kRows / 16);
  for (int y = 0; y < kRows / 16; ++y) tiles.x(0, y) = 4, tiles.x(1, y) = 8;
  const motionblur::TileChoice chosen = motionblur::choose_tiles(tiles, Plane(2, kRows / 16), 16, window, reach);
  int right = 0;
  for (int y = 0; y < kRows; ++y) right += chosen.velocity.x(x, y) == 8;
  return right / double{kRows};
}

// Half of all pixels look sideways, so the share of the tile beyond is a quarter at the border: half of one half.
TEST(ChooseTiles, SharesFallLinearlyFromTheBorder) {
  EXPECT_EQ(share_of_the_right_tile(11, 0.25F), 0);
  EXPECT_NEAR(share_of_the_right_tile(12, 0.25F), 0.5 * 0.5 / 8, 0.01);
  EXPECT_NEAR(share_of_the_right_tile(13, 0.25F), 0.5 * 1.5 / 8, 0.02);
  EXPECT_NEAR(share_of_the_right_tile(15, 0.25F), 0.5 * 3.5 / 8, 0.02);
  EXPECT_NEAR(share_of_the_right_tile(16, 0.25F), 1 - 0.5 * 3.5 / 8, 0.02);
  EXPECT_EQ(share_of_the_right_tile(21, 0.25F), 1);
  EXPECT_EQ(share_of_the_right_tile(15, 0), 0);
}

TEST(ChooseTiles, WhereNothingMovesAPixelKeepsItsTile) {
  HalfVelocity tiles = still_tiles(2, 1);
  tiles.x(1, 0) = 9;
  tiles.x(0, 0) = 0.5F;
  const motionblur::TileChoice chosen = motionblur::choose_tiles(tiles, Plane(2, 1), 16, {0, 0, 31, 15}, 0.25F);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) EXPECT_EQ(chosen.velocity.x(x, y), 0.5F);
}

}  // namespace
}  // namespace aftershade::tests
