#pragma once
#include "core/ao/sphere_tap.h"

namespace aftershade::ao {

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
  const Mask hidden =
      filter::is_surface(tap.surface.z) & (tap.surface.z < tap.z) & (dot(v, centre.normal) > taps.bias_m);
  const Float near = sat(taps.radius_m / abs(v.z));
  return select(hidden, near * near * (3.0F - 2.0F * near), 0.0F);
}

/// Crysis' rule: 0 visible, 1 hidden, and towards 0.5 as the surface lies farther in front of the pixel than it does of
/// the camera.
inline Float literal_share(const BallCentre& centre, const SphereTap& tap) {
  const Mask seen = filter::is_surface(tap.surface.z);
  const Float hidden = select(tap.surface.z < tap.z, Float(1.0F), Float(0.0F));
  const Float range = sat((centre.point.z - tap.surface.z) / tap.surface.z);
  return select(seen, hidden + (0.5F - hidden) * range, 0.0F);
}

inline void sphere_kernel_row(const SphereKernelRow& row, int y) {
  const SphereTaps& taps = row.taps;
  for (int x0 = 0; x0 < taps.grid.depth.width; x0 += kLanes) {
    const BallCentre centre = ball_centre(taps, taps.grid.depth.clamp_x(iota(x0)), y);
    const Mask here = filter::is_surface(centre.point.z);
    const Int first = row.range.first_of(x0), count = row.range.count_of(x0);
    Float sum = 0.0F, inside = 0.0F;
    for (int i = 0; any(here & (Int(i) < count)); ++i) {
      const SphereTap tap = sphere_tap(taps, centre, first + Int(i));
      const Mask counts = tap.in_frame & (Int(i) < count);
      const Float share = taps.hemisphere ? hidden_share(taps, centre, tap) : literal_share(centre, tap);
      sum += select(counts, share, 0.0F);
      inside += select(counts, Float(1.0F), 0.0F);
    }
    const Float open = 1.0F - sum / inside;
    const Float visibility = taps.hemisphere ? open : sat(open * open + open);  // Crysis: algorithms 8
    store(row.out + x0, select(here & (inside > 0.0F), visibility, 1.0F));
  }
}

}  // namespace aftershade::ao
