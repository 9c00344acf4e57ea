#pragma once
#include "core/motionblur/tile_max.h"

/// What Guertin et al. 2014 add to tiles (algorithms 2.1, 3.1).
namespace aftershade::motionblur {

/// neighbour_max() without the corner tiles whose motion passes the centre tile by: a corner counts if its velocity
/// lies within 45 degrees of the line through both tiles, in either sense (the blur is symmetric).
HalfVelocity directional_neighbour_max(const HalfVelocity& tiles);

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
