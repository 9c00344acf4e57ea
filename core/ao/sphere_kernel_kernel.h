#if defined(AFTERSHADE_CORE_AO_SPHERE_KERNEL_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_SPHERE_KERNEL_KERNEL_H
#undef AFTERSHADE_CORE_AO_SPHERE_KERNEL_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_SPHERE_KERNEL_KERNEL_H
#endif
#include "core/ao/sphere_tap.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

struct SphereKernelRow {
  const SphereTaps& taps;
  RangeRow range;
  float* out;
};

/// StarCraft II's rule: the share, 0 to 1, by which the point counts as hidden. What hides a point above the tangent
/// plane is itself above it, for the eye is: so the height of the surface, and not a shift of the point, tells an
/// occluder from the rounding of a slope to pixels.
inline Float hidden_share(const SphereTaps& taps, const BallCentre& centre, const SphereTap& tap) {
  const Point v = tap.surface - centre.point;
  const Mask hidden = is_surface(tap.surface.z) & (tap.surface.z < tap.z) & (dot(v, centre.normal) > taps.bias_m);
  const Float near = sat(taps.radius_m / abs(v.z));
  return select(hidden, near * near * (3.0F - 2.0F * near), 0.0F);
}

/// Crysis' rule: 0 visible, 1 hidden, and towards 0.5 as the surface lies farther in front of the pixel than it does of
/// the camera.
inline Float literal_share(const BallCentre& centre, const SphereTap& tap) {
  const Mask seen = is_surface(tap.surface.z);
  const Float hidden = select(tap.surface.z < tap.z, Float(1.0F), Float(0.0F));
  const Float range = sat((centre.point.z - tap.surface.z) / tap.surface.z);
  return select(seen, hidden + (0.5F - hidden) * range, 0.0F);
}

template <bool kInside>
void sphere_kernel_vector(const SphereKernelRow& row, int x0, int y) {
  const SphereTaps& taps = row.taps;
  const Columns<kInside> x(x0, taps.grid.depth.width);
  const Mask here = is_surface(x(taps.grid.depth.row(y))) & x.inside;
  if (!any(here)) return store(row.out + x0, 1.0F);
  const BallCentre centre = ball_centre(taps, x, y);
  const Int first = row.range.first_of(x0), count = row.range.count_of(x0);
  const int shared = row.range.shared_first(x0);
  Float sum = 0.0F, inside = 0.0F;
  for (int i = 0; any(here & (Int(i) < count)); ++i) {
    const SphereTap tap = sphere_tap(taps, centre, ball_point(taps, first, shared, i));
    const Mask counts = tap.in_frame & (Int(i) < count);
    const Float share = taps.hemisphere ? hidden_share(taps, centre, tap) : literal_share(centre, tap);
    sum += select(counts, share, 0.0F);
    inside += select(counts, Float(1.0F), 0.0F);
  }
  const Float open = 1.0F - sum / inside;
  const Float visibility = taps.hemisphere ? open : sat(open * open + open);  // Crysis: algorithms 8
  store(row.out + x0, select(here & (inside > 0.0F), visibility, 1.0F));
}

inline void sphere_kernel_row(const SphereKernelRow& row, int y) {
  for_each_vector(row.taps.grid.depth.width, 0, 0,
                  [&](int x0, auto inside) { sphere_kernel_vector<decltype(inside)::value>(row, x0, y); });
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
