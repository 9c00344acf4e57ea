#include "core/motionblur/moving_tiles.h"

#include <algorithm>
#include <cmath>

#include "core/motionblur/gather_source.h"

namespace aftershade::motionblur {

MovingTiles::MovingTiles(const HalfVelocity& neighbours, const TileGrid& grid)
    : grid_(grid), blurred_(static_cast<size_t>(grid.rows())), read_(blurred_.size()) {
  std::vector<Columns> moving(blurred_.size());  // in tiles
  for (int row = 0; row < grid.rows(); ++row)
    for (int column = 0; column < grid.columns(); ++column) {
      const float x = neighbours.x(column, row), y = neighbours.y(column, row);
      if (std::hypot(x, y) > kLeastRadius_px) any_ = true;
      if (!(std::sqrt(x * x + y * y) > kLeastRadius_px)) continue;  // as the kernels have it
      Columns& tiles = moving[static_cast<size_t>(row)];
      tiles = {tiles.empty() ? column : tiles.first, column + 1};
    }
  const auto pixels = [&](Columns tiles) {
    return Columns{grid.first_column(tiles.first), std::min(grid.first_column(tiles.last), grid.width())};
  };
  for (int row = 0; row < grid.rows(); ++row) {
    const Columns here = moving[static_cast<size_t>(row)];
    if (!here.empty()) blurred_[static_cast<size_t>(row)] = pixels(here);
    Columns around;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, grid.rows() - 1); ++y) {
      const Columns& tiles = moving[static_cast<size_t>(y)];
      if (tiles.empty()) continue;
      around = around.empty() ? tiles : Columns{std::min(around.first, tiles.first), std::max(around.last, tiles.last)};
    }
    if (!around.empty())
      read_[static_cast<size_t>(row)] =
          pixels({std::max(around.first - 1, 0), std::min(around.last + 1, grid.columns())});
  }
}

}  // namespace aftershade::motionblur
