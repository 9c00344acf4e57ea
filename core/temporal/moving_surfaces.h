#pragma once
#include <span>
#include <vector>

#include "core/temporal/trajectory.h"

/// Where moving surfaces may have changed the AO of what is around them: the vectors know it without looking at the AO.
namespace aftershade::temporal {

/// One value a tile of kTile_px squared, aligned to absolute coordinates.
struct NearMoving {
  static constexpr int kTile_px = 8;
  int first_x = 0, first_y = 0;  ///< tile indices of tiles (0, 0): floor(absolute pixel / kTile_px)
  Plane tiles;  ///< 1: a moving surface is (or was, will be, one frame away) near; 0: none within the radius

  /// At an absolute pixel position; 0 outside and where it is not known.
  float at(float x, float y) const;
};

/// Around each frame of `frames` (sorted; neighbours in number count as neighbours in time). A pixel moves when one of
/// its vectors to another of these frames differs from the camera's motion by more than `agreement_px`, or when none is
/// known. It counts at its own place and where its vector leads. The value is 1 up to three quarters of `radius_m` from
/// a moving tile and falls to 0 at the radius. Empty when the frames cannot tell: no vectors, or no camera positions.
std::vector<NearMoving> near_moving_surfaces(std::span<const WindowFrame* const> frames, float radius_m,
                                             float agreement_px);

}  // namespace aftershade::temporal
