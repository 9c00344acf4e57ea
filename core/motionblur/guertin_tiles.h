#pragma once
#include "core/motionblur/tile_max.h"

/// What Guertin et al. 2014 add to tiles (algorithms 3.1).
namespace aftershade::motionblur {

/// How much directions differ around each tile, 0 to 1: 1 - mean |w(t) . w(n)| over the adjacent tiles n of the grid,
/// with w the directions of `neighbours` (0 where nothing moves); 0 if there are none.
Plane direction_variance(const HalfVelocity& neighbours);

/// What each pixel reads of the tiles.
struct TileChoice {
  HalfVelocity velocity;
  Plane variance;
};

/// Every pixel takes a tile at random, its own or one beside, above or below it, so that borders of tiles do not show:
/// the tile at a place up to `reach` tiles away, horizontally or vertically. The other tile's share is one half at the
/// border and falls linearly to 0 at that distance. A pixel whose own tile has nothing that moves half a pixel keeps it
/// (ours: it stays as it is). A pure function of absolute coordinates.
TileChoice choose_tiles(const HalfVelocity& neighbours, const Plane& variance, int tile, Window window, float reach);

}  // namespace aftershade::motionblur
