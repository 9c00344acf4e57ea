#pragma once
#include "core/image/window.h"
#include "core/motionblur/half_velocity.h"

namespace aftershade::motionblur {

/// What gathering blurs know of a neighbourhood; one pixel a tile of TileGrid(tile_px, window).
struct VelocityTiles {
  int tile_px;
  HalfVelocity own;         ///< the tile's longest velocity
  HalfVelocity neighbours;  ///< the longest that counts in the tiles around, or reaches the tile
};

/// The tiles that a window touches. Tile (i, j) holds the absolute pixels i * tile .. (i + 1) * tile - 1, so that a
/// pixel stays in the same tile when the data window moves.
class TileGrid {
 public:
  TileGrid(int tile, Window window);
  int columns() const { return last_x_ - first_x_ + 1; }
  int width() const { return window_.width(); }  ///< in pixels
  int rows() const { return last_y_ - first_y_ + 1; }
  int column_of(int x) const;  ///< of a pixel column counted from the window's left
  int row_of(int y) const;     ///< of a pixel row counted from the window's top
  int first_column(
      int column) const;         ///< first pixel column in a tile column, counted from the window's left, at least 0
  int first_row(int row) const;  ///< likewise for rows

 private:
  int tile_;
  Window window_;
  int first_x_, first_y_, last_x_, last_y_;
};

/// The velocity of greatest magnitude in each K x K tile (slide "Tile Maximum Velocity"), one pixel a tile of the grid;
/// of equal ones the leftmost, then the topmost. `window` is where the planes of `velocity` lie.
HalfVelocity tile_max(const HalfVelocity& velocity, int tile, Window window);

/// The velocity of greatest magnitude in the 3x3 tiles around each tile (slide "Neighborhood Maximum Velocity"); of
/// equal ones the tile's own, then the first in reading order. Tiles outside the grid count for nothing.
HalfVelocity neighbour_max(const HalfVelocity& tiles);

/// The same with one column a pixel column of the window, one row a tile row: a kernel loads it where it would look up
/// a tile.
HalfVelocity widened(const HalfVelocity& tiles, const TileGrid& grid);

}  // namespace aftershade::motionblur
