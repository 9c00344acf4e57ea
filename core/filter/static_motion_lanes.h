// static_motion.h in lanes.
#if defined(AFTERSHADE_CORE_FILTER_STATIC_MOTION_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_STATIC_MOTION_LANES_H
#undef AFTERSHADE_CORE_FILTER_STATIC_MOTION_LANES_H
#else
#define AFTERSHADE_CORE_FILTER_STATIC_MOTION_LANES_H
#endif
#include <limits>

#include "core/filter/lane_geometry.h"
#include "core/filter/static_motion.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

inline Float at(const RowPolynomial& p, Float x, Float t) { return p.a + p.b * x + p.c * t; }

namespace detail {
inline Point displacement_at(const StaticMotion& m, Float from_axis, Float t, Float depth) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  const Float share = 1.0F / at(m.scale, from_axis, t);
  const Float dx = (at(m.move_x, from_axis, t) + from_axis * (m.x_squared * from_axis + m.x_t * t)) * share;
  const Float dy = at(m.move_y, from_axis, t) * share;
  return select(depth > 0.0F, {dx, dy, depth}, {kUnknown, kUnknown, kUnknown});
}
}  // namespace detail

/// {x' - x, y' - y, depth there} of a static surface whose pixel centre is at absolute x, at planar depth z
/// (algorithms 7.1); NaN behind the other camera.
inline Point static_displacement(const StaticMotion& m, Float x, Float z) {
  const Float from_axis = x - m.centre_x;
  const Float depth = m.orthographic ? at(m.z, from_axis, z) : (m.z.a + m.z.b * from_axis) * z + m.z.c;
  return detail::displacement_at(m, from_axis, m.orthographic ? z : 1.0F / z, depth);
}

/// The same of the background at infinity, which follows the camera's rotation alone; to an orthographic camera it
/// moves as what lies in the camera's own plane does. The third coordinate says nothing but whether it is seen (> 0).
inline Point background_displacement(const StaticMotion& m, Float x) {
  const Float from_axis = x - m.centre_x;
  const Float ahead = m.orthographic ? Float(1.0F) : m.z.a + m.z.b * from_axis;
  return detail::displacement_at(m, from_axis, 0.0F, ahead);
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
