#pragma once
#include "core/camera/camera.h"
#include "core/image/plane.h"

namespace aftershade::filter {

/// The visible surface of one frame, as AO and the bilateral filters see it. All planes have the same size.
struct Surface {
  ConstPlaneView depth;       ///< planar depth in metres; +inf is background, NaN and <= 0 count as background too
  ConstPlaneView nx, ny, nz;  ///< unit normal in camera space, facing the camera; (0,0,0) where there is none
  Projection projection;      ///< in the planes' index space
  int origin_x = 0,
      origin_y = 0;        ///< absolute coordinates of index (0,0): patterns are tied to them, not to the window
  int display_height = 0;  ///< pixel lengths of a preset scale with display_height / reference_height_px
};

/// A preset's length in pixels at this image height.
inline float scaled_px(float length_px, float reference_height_px, int display_height) {
  return length_px * static_cast<float>(display_height) / reference_height_px;
}

}  // namespace aftershade::filter
