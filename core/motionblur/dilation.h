#pragma once
#include "core/motionblur/tile_max.h"

namespace aftershade::motionblur {

/// Which velocities of the 3x3 tiles around a tile count in its neighbourhood maximum.
enum class Dilation {
  square,       ///< all (slide "Neighborhood Maximum Velocity")
  directional,  ///< of a neighbour at offset o only a maximum v along it: |sign(o_x v_x) + sign(o_y v_y)| = |o_x| +
                ///< |o_y|; G3D's rule (algorithms 2.1)
  line,         ///< those of the pixels whose own segment, from -v to v, crosses the tile
};

/// The velocity of greatest magnitude that counts, for every tile of the grid; of equal ones the tile's own, then the
/// first neighbour's in reading order. `velocity` lies in `window`; |v| <= tile, or farther ones are missed; `tiles` is
/// its tile_max().
HalfVelocity dilated(Dilation rule, const HalfVelocity& velocity, const HalfVelocity& tiles, int tile, Window window);

}  // namespace aftershade::motionblur
