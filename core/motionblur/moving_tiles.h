#pragma once
#include <vector>

#include "core/motionblur/tile_max.h"

namespace aftershade::motionblur {

/// Pixel columns first to last - 1.
struct Columns {
  int first = 0, last = 0;
  bool empty() const { return last <= first; }
};

/// Where a blur by tiles changes anything: a tile around which nothing moves more than half a pixel stays as it is.
class MovingTiles {
 public:
  /// `neighbours`: the longest velocity around each tile of the grid.
  MovingTiles(const HalfVelocity& neighbours, const TileGrid& grid);
  bool any() const { return any_; }
  /// Of pixel row y, the columns from the first moving tile to the last.
  Columns blurred(int y) const { return blurred_[index(y)]; }
  /// The columns that the taps of any blurred pixel may reach: one tile farther, in all directions.
  Columns read(int y) const { return read_[index(y)]; }

 private:
  size_t index(int y) const { return static_cast<size_t>(grid_.row_of(y)); }
  TileGrid grid_;
  std::vector<Columns> blurred_, read_;  ///< one a row of tiles
  bool any_ = false;
};

}  // namespace aftershade::motionblur
