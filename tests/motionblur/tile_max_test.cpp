#include "core/motionblur/tile_max.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/motionblur/blur_scene.h"

namespace aftershade::tests {
namespace {

using motionblur::HalfVelocity;

HalfVelocity noisy_velocity(Window window) {
  HalfVelocity v{Plane(window.width(), window.height()), Plane(window.width(), window.height())};
  for (int y = 0; y < window.height(); ++y)
    for (int x = 0; x < window.width(); ++x) {
      v.x(x, y) = noise(x + window.min_x, y + window.min_y, 1, -9, 9);
      v.y(x, y) = noise(x + window.min_x, y + window.min_y, 2, -9, 9);
    }
  return v;
}

int tile_of(int absolute, int tile) { return static_cast<int>(std::floor(static_cast<double>(absolute) / tile)); }

/// The longest velocity among the window's pixels whose tile is at most `reach` tiles from (column, row), absolute.
std::pair<float, float> longest(const HalfVelocity& v, Window window, int tile, int column, int row, int reach) {
  double best = 0;
  std::pair<float, float> found{0.0F, 0.0F};
  for (int y = window.min_y; y <= window.max_y; ++y)
    for (int x = window.min_x; x <= window.max_x; ++x) {
      if (std::abs(tile_of(x, tile) - column) > reach || std::abs(tile_of(y, tile) - row) > reach) continue;
      const float vx = v.x(x - window.min_x, y - window.min_y), vy = v.y(x - window.min_x, y - window.min_y);
      if (std::hypot(double{vx}, double{vy}) > best) {
        best = std::hypot(double{vx}, double{vy});
        found = {vx, vy};
      }
    }
  return found;
}

TEST(TileMax, AgreesWithBruteForceInEveryWindow) {
  const Window windows[] = {{0, 0, 39, 19}, {0, 0, 41, 22}, {-7, -13, 30, 9}, {5, 3, 6, 3}, {-25, 11, -3, 37}};
  for (const Window& window : windows)
    for (const int tile : {1, 4, 10}) {
      const HalfVelocity v = noisy_velocity(window);
      const HalfVelocity tiles = motionblur::tile_max(v, tile, window);
      const HalfVelocity around = motionblur::neighbour_max(tiles);
      const int first_x = tile_of(window.min_x, tile), first_y = tile_of(window.min_y, tile);
      ASSERT_EQ(tiles.x.width(), tile_of(window.max_x, tile) - first_x + 1);
      ASSERT_EQ(tiles.x.height(), tile_of(window.max_y, tile) - first_y + 1);
      for (int row = 0; row < tiles.x.height(); ++row)
        for (int column = 0; column < tiles.x.width(); ++column) {
          const auto [tx, ty] = longest(v, window, tile, column + first_x, row + first_y, 0);
          EXPECT_EQ(tiles.x(column, row), tx);
          EXPECT_EQ(tiles.y(column, row), ty);
          const auto [nx, ny] = longest(v, window, tile, column + first_x, row + first_y, 1);
          EXPECT_EQ(around.x(column, row), nx);
          EXPECT_EQ(around.y(column, row), ny);
        }
    }
}

TEST(TileMax, TiesGoToTheLeftmostThenTheTopmost) {
  HalfVelocity v{Plane(4, 4), Plane(4, 4)};
  v.x(2, 0) = 5;
  v.y(1, 3) = 5;
  v.y(1, 2) = -5;
  const HalfVelocity tiles = motionblur::tile_max(v, 4, {0, 0, 3, 3});
  EXPECT_EQ(tiles.x(0, 0), 0);
  EXPECT_EQ(tiles.y(0, 0), -5);
}

TEST(TileMax, ANanIsNoVelocity) {
  HalfVelocity v{Plane(4, 4), Plane(4, 4)};
  v.x(0, 0) = v.y(3, 3) = std::numeric_limits<float>::quiet_NaN();
  v.x(2, 2) = 1;
  const HalfVelocity tiles = motionblur::tile_max(v, 4, {0, 0, 3, 3});
  EXPECT_EQ(tiles.x(0, 0), 1);
  EXPECT_EQ(tiles.y(0, 0), 0);
}

TEST(NeighbourMax, ATileKeepsItsOwnVelocityAgainstEqualOnes) {
  HalfVelocity tiles{Plane(3, 3), Plane(3, 3)};
  tiles.x(0, 0) = 3;
  tiles.y(1, 1) = 3;
  tiles.x(2, 2) = -3;
  const HalfVelocity around = motionblur::neighbour_max(tiles);
  EXPECT_EQ(around.y(1, 1), 3) << "its own";
  EXPECT_EQ(around.x(2, 2), -3) << "its own";
  EXPECT_EQ(around.x(1, 0), 3) << "the first in reading order";
}

TEST(TileGrid, KnowsWhereTilesBegin) {
  const motionblur::TileGrid grid(10, {-13, 5, 11, 30});
  EXPECT_EQ(grid.columns(), 4);
  EXPECT_EQ(grid.rows(), 4);
  EXPECT_EQ(grid.column_of(0), 0);
  EXPECT_EQ(grid.first_column(0), 0);
  EXPECT_EQ(grid.first_column(1), 3);
  EXPECT_EQ(grid.column_of(2), 0);
  EXPECT_EQ(grid.column_of(3), 1);
  EXPECT_EQ(grid.row_of(4), 0);
  EXPECT_EQ(grid.row_of(5), 1);
  EXPECT_EQ(grid.first_row(3), 25);
}

}  // namespace
}  // namespace aftershade::tests
