#pragma once
#include "core/camera/camera.h"

/// The motion that the camera gives to static surfaces, row by row: where they are seen by another camera. The rows'
/// formulas are in core/filter/static_motion_lanes.h.
namespace aftershade::filter {

/// a + b x + c t along one row of pixels: x the pixel's centre, from the principal point; t = 1 / z (perspective) or z
/// (orthographic).
struct RowPolynomial {
  float a, b, c;
};

/// Where a static surface is seen by the other camera ('), on one row: x' - x = (move_x + x (x_squared x + x_t t)) /
/// scale and y' - y = move_y / scale, each numerator with its coefficients worked out in double, so that a camera that
/// stands still moves no pixel by any bit. The depth there is z (z_a + z_b x) + z_c (perspective), or
/// z_a + z_b x + z_c z.
struct StaticMotion {
  RowPolynomial move_x, move_y, scale, z;
  float x_squared, x_t;
  bool orthographic;
  float centre_x;  ///< of the camera whose rows these are
};
/// `row_y`: absolute coordinate of the row's pixel centres.
StaticMotion static_motion(const CameraReprojection& cameras, double row_y);

}  // namespace aftershade::filter
