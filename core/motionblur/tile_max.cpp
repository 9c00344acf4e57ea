#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/tile_max.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/tile_max.h"

#include <hwy/foreach_target.h>

#include <algorithm>

#include "core/motionblur/tile_max_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

/// The longest velocity in each column of pixels of rows first to last - 1.
void column_max(const HalfVelocity& velocity, int first, int last, const ColumnMax& best) {
  constexpr int kBlock = 4;  // vectors whose maxima stay in registers
  int x = 0;
  for (; x + kBlock * kLanes <= velocity.x.width(); x += kBlock * kLanes)
    column_max_block<kBlock>(velocity.x, velocity.y, first, last, x, best);
  for (; x < velocity.x.width(); x += kLanes) column_max_block<1>(velocity.x, velocity.y, first, last, x, best);
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

namespace {

HWY_EXPORT(column_max);

int floor_div(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

struct Longest {
  float square = 0, x = 0, y = 0;
  void take(float square_of, float vx, float vy) {
    if (square_of > square) *this = {square_of, vx, vy};
  }
};

/// The first of the longest columns first to last - 1. Branches that nobody foresees cost more than the second look.
int longest_column(const float* square, int first, int last) {
  float most[4] = {};
  int x = first;
  for (; x + 4 <= last; x += 4)
    for (int i = 0; i < 4; ++i) most[i] = std::max(most[i], square[x + i]);
  for (; x < last; ++x) most[0] = std::max(most[0], square[x]);
  const float longest = std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
  return static_cast<int>(std::find(square + first, square + last - 1, longest) - square);
}

}  // namespace

TileGrid::TileGrid(int tile, Window window)
    : tile_(tile),
      window_(window),
      first_x_(floor_div(window.min_x, tile)),
      first_y_(floor_div(window.min_y, tile)),
      last_x_(floor_div(window.max_x, tile)),
      last_y_(floor_div(window.max_y, tile)) {}

int TileGrid::column_of(int x) const { return floor_div(window_.min_x + x, tile_) - first_x_; }
int TileGrid::row_of(int y) const { return floor_div(window_.min_y + y, tile_) - first_y_; }
int TileGrid::first_column(int column) const { return std::max((first_x_ + column) * tile_ - window_.min_x, 0); }
int TileGrid::first_row(int row) const { return std::max((first_y_ + row) * tile_ - window_.min_y, 0); }

HalfVelocity tile_max(const HalfVelocity& velocity, int tile, Window window) {
  const TileGrid grid(tile, window);
  const int width = velocity.x.width(), height = velocity.x.height();
  HalfVelocity out{Plane(grid.columns(), grid.rows()), Plane(grid.columns(), grid.rows())};
  for_rows(grid.rows(), [&](int row) {
    Plane columns = Plane::for_overwrite(width, 3);
    const ColumnMax best{columns.row(0), columns.row(1), columns.row(2)};
    HWY_DYNAMIC_DISPATCH(column_max)(velocity, grid.first_row(row), std::min(grid.first_row(row + 1), height), best);
    int first = 0;
    for (int column = 0; column < grid.columns(); ++column) {
      const int last = std::min(grid.first_column(column + 1), width), x = longest_column(best.square, first, last);
      first = last;
      out.x(column, row) = best.x[x];
      out.y(column, row) = best.y[x];
    }
  });
  return out;
}

HalfVelocity neighbour_max(const HalfVelocity& tiles) {
  const int width = tiles.x.width(), height = tiles.x.height();
  HalfVelocity out{Plane(width, height), Plane(width, height)};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      Longest longest;
      const auto take = [&](int x, int y) {
        const float vx = tiles.x(x, y), vy = tiles.y(x, y);
        longest.take(vx * vx + vy * vy, vx, vy);
      };
      take(column, row);
      for (int y = std::max(row - 1, 0); y <= std::min(row + 1, height - 1); ++y)
        for (int x = std::max(column - 1, 0); x <= std::min(column + 1, width - 1); ++x) take(x, y);
      out.x(column, row) = longest.x;
      out.y(column, row) = longest.y;
    }
  return out;
}

HalfVelocity widened(const HalfVelocity& tiles, const TileGrid& grid) {
  HalfVelocity out{Plane(grid.width(), grid.rows()), Plane(grid.width(), grid.rows())};
  for (int row = 0; row < grid.rows(); ++row)
    for (int column = 0; column < grid.columns(); ++column) {
      const int first = grid.first_column(column), last = std::min(grid.first_column(column + 1), grid.width());
      std::fill(out.x.row(row) + first, out.x.row(row) + last, tiles.x(column, row));
      std::fill(out.y.row(row) + first, out.y.row(row) + last, tiles.y(column, row));
    }
  return out;
}

}  // namespace aftershade::motionblur
#endif
