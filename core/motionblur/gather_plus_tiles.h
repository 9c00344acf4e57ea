#pragma once
#include <vector>

#include "core/image/window.h"
#include "core/motionblur/motion.h"
#include "core/motionblur/tile_max.h"

namespace aftershade::motionblur {

/// A surface's path: its displacement at time t is t times `before` (t < 0) or `after`, plus t^2 times `bend`.
struct PathCoefficients {
  float before_x, before_y, after_x, after_y, bend_x, bend_y;
};
inline constexpr int kPathFloats = 6;
PathCoefficients path_coefficients(const Motion& motion, Path path, int x, int y);

/// Tiles of 16 x 16 absolute pixels, as a shift.
inline constexpr int kTileShift = 4, kTile_px = 1 << kTileShift;
/// Motions that differ by less, in pixels at the shutter's opening and closing, find each other's pixels.
inline constexpr float kDistinct_px = 1;

/// What a gather searches along, of every tile of a window.
struct TileMotions {
  int first_column, first_row;  ///< absolute tile at (0, 0)
  int columns, rows;
  int motions;                    ///< room per tile
  std::vector<float> paths;       ///< [tile][motion][kPathFloats]
  std::vector<float> counts;      ///< used motions of each tile
  std::vector<float> longest_px;  ///< the longest way during the exposure of a surface that reaches the tile
};

/// The motions of all surfaces whose path during the exposure touches a tile, thinned to the `motions` (at least 1)
/// that differ most: the longest first, then each time the one farthest from those that are there.
TileMotions tile_motions(const Motion& motion, Path path, Shutter shutter, Window window, int motions);

/// For those who look into the blur: half the way of a tile's fastest surface during the exposure, and of the longest
/// motion that is searched along there.
VelocityTiles velocity_tiles(const Motion& motion, Path path, Shutter shutter, Window window);

}  // namespace aftershade::motionblur
