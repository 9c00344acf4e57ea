#include "core/motionblur/guertin_tiles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/math/sampling.h"
#include "core/motionblur/gather_source.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

namespace {

/// Calls `visit(column, row)` for the tiles of the grid next to one, in reading order.
template <class Visit>
void for_adjacent(const Plane& grid, int column, int row, const Visit& visit) {
  for (int y = std::max(row - 1, 0); y <= std::min(row + 1, grid.height() - 1); ++y)
    for (int x = std::max(column - 1, 0); x <= std::min(column + 1, grid.width() - 1); ++x)
      if (x != column || y != row) visit(x, y);
}

/// The paper's norm(v): a vector without length has no direction.
struct Direction {
  float x, y;
};
Direction direction_of(float x, float y) {
  const float length = std::sqrt(x * x + y * y) + kNoDivisionByZero;
  return {x / length, y / length};
}

}  // namespace

Plane direction_variance(const HalfVelocity& neighbours) {
  Plane out(neighbours.x.width(), neighbours.x.height());
  for (int row = 0; row < out.height(); ++row)
    for (int column = 0; column < out.width(); ++column) {
      const Direction own = direction_of(neighbours.x(column, row), neighbours.y(column, row));
      float agreement = 0;
      int count = 0;
      for_adjacent(out, column, row, [&](int x, int y) {
        const Direction other = direction_of(neighbours.x(x, y), neighbours.y(x, y));
        agreement += std::abs(own.x * other.x + own.y * other.y);
        ++count;
      });
      out(column, row) = count > 0 ? std::clamp(1 - agreement / static_cast<float>(count), 0.0F, 1.0F) : 0.0F;
    }
  return out;
}

namespace {

/// Tiles of the pixels along one axis, up to `margin` pixels beyond the window's edges, where the border's tile counts.
class TileTable {
 public:
  TileTable(int pixels, int margin, int tiles, const std::function<int(int)>& tile_of) : margin_(margin) {
    for (int i = -margin; i < pixels + margin; ++i) tiles_.push_back(std::clamp(tile_of(i), 0, tiles - 1));
  }
  int operator[](int pixel) const { return tiles_[static_cast<size_t>(pixel + margin_)]; }

 private:
  int margin_;
  std::vector<int> tiles_;
};

}  // namespace

TileChoice choose_tiles(const HalfVelocity& neighbours, const Plane& variance, int tile, Window window, float reach) {
  const TileGrid grid(tile, window);
  const int width = window.width(), height = window.height();
  const float reach_px = reach * static_cast<float>(tile);
  const int margin = static_cast<int>(reach_px) + 2;
  const TileTable columns(width, margin, grid.columns(), [&](int x) { return grid.column_of(x); });
  const TileTable rows(height, margin, grid.rows(), [&](int y) { return grid.row_of(y); });
  Plane moves(grid.columns(), grid.rows());
  for (int row = 0; row < grid.rows(); ++row)
    for (int column = 0; column < grid.columns(); ++column)
      moves(column, row) =
          std::hypot(neighbours.x(column, row), neighbours.y(column, row)) > kLeastRadius_px ? 1.0F : 0.0F;
  TileChoice out{{Plane(width, height), Plane(width, height)}, Plane(width, height)};
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      int column = columns[x], row = rows[y];
      if (moves(column, row) > 0) {
        const uint32_t bits =
            hash_counters(static_cast<uint32_t>(window.min_x + x), static_cast<uint32_t>(window.min_y + y), 0, 1);
        const auto shift = static_cast<int>(std::floor(0.5F + (2 * unit_float(bits) - 1) * reach_px));
        if ((bits & 1U) != 0)
          column = columns[x + shift];
        else
          row = rows[y + shift];
      }
      out.velocity.x(x, y) = neighbours.x(column, row);
      out.velocity.y(x, y) = neighbours.y(column, row);
      out.variance(x, y) = variance(column, row);
    }
  });
  return out;
}

}  // namespace aftershade::motionblur
