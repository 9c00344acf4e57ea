#pragma once
#include <limits>

#include "core/camera/camera.h"
#include "core/filter/lane_geometry.h"

/// The motion that the camera gives to static surfaces, row by row: where they are seen by another camera.
namespace aftershade::filter {

/// a + b x + c t along one row of pixels: x the pixel's centre, from the principal point; t = 1 / z (perspective) or z
/// (orthographic).
struct RowPolynomial {
  float a, b, c;
  Float operator()(Float x, Float t) const { return a + b * x + c * t; }
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

namespace detail {
inline Point displacement_at(const StaticMotion& m, Float from_axis, Float t, Float depth) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const Float share = 1.0F / m.scale(from_axis, t);
  const Float dx = (m.move_x(from_axis, t) + from_axis * (m.x_squared * from_axis + m.x_t * t)) * share;
  const Float dy = m.move_y(from_axis, t) * share;
  return select(depth > 0.0F, {dx, dy, depth}, {kUnknown, kUnknown, kUnknown});
}
}  // namespace detail

/// {x' - x, y' - y, depth there} of a static surface whose pixel centre is at absolute x, at planar depth z
/// (algorithms 7.1); NaN behind the other camera.
inline Point static_displacement(const StaticMotion& m, Float x, Float z) {
  const Float from_axis = x - m.centre_x;
  const Float depth = m.orthographic ? m.z(from_axis, z) : (m.z.a + m.z.b * from_axis) * z + m.z.c;
  return detail::displacement_at(m, from_axis, m.orthographic ? z : 1.0F / z, depth);
}

/// The same of the background at infinity, which follows the camera's rotation alone; to an orthographic camera it
/// moves as what lies in the camera's own plane does. The third coordinate says nothing but whether it is seen (> 0).
inline Point background_displacement(const StaticMotion& m, Float x) {
  const Float from_axis = x - m.centre_x;
  const Float ahead = m.orthographic ? Float(1.0F) : m.z.a + m.z.b * from_axis;
  return detail::displacement_at(m, from_axis, 0.0F, ahead);
}

}  // namespace aftershade::filter
