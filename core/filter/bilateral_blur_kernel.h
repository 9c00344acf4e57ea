#pragma once
#include "core/filter/lane_geometry.h"

namespace aftershade::filter {

/// One direction of the separable blur: taps at (x + t dx, y + t dy), |t| <= reach.
struct BilateralBlurRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  EdgeTolerance tolerance;
  Samples value;
  int dx, dy;
  int reach;          ///< ceil(radius)
  float outer_share;  ///< of the taps at |t| == reach: how much of their texel the radius covers, (0, 1]
  float falloff;      ///< 1 / (2 sigma^2), with exp2 as seed 000's CrossBilateralWeight has it
  float* out;
};

/// The mean is taken of differences from the centre, so a constant stays the same to the bit.
inline void bilateral_blur_row(const BilateralBlurRow& row, int y) {
  for (int x0 = 0; x0 < row.value.width; x0 += kLanes) {
    const Int x = row.value.clamp_x(iota(x0)), iy = y;
    const Point centre = row.grid.point(row.lens, x, iy);
    const Mask here = is_surface(centre.z);
    const Point normal = row.normals(to_int(row.grid.x_of(x, iy)), to_int(row.grid.y_of(x, iy)));
    const Float inv_tolerance = 1.0F / row.tolerance.at(centre.z);
    const Float own = row.value(x, iy);
    const Float base = select(is_finite(own), own, 1.0F);
    Float sum = 0.0F, weights = 0.0F;
    for (int t = -row.reach; t <= row.reach; ++t) {
      const Int tx = x + Int(t * row.dx), ty = iy + Int(t * row.dy);
      const Int sx = row.value.clamp_x(tx), sy = row.value.clamp_y(ty);
      const Point point = row.grid.point(row.lens, sx, sy);
      const Float tap = row.value(sx, sy);
      const Mask valid = here & row.value.contains(tx, ty) & is_surface(point.z) & is_finite(tap);
      const Float d = plane_distance(point - centre, normal) * inv_tolerance;
      const float share = t == row.reach || t == -row.reach ? row.outer_share : 1.0F;
      // exp2(-r^2 falloff - d^2): seed 000, CrossBilateralWeight; distance to the plane instead of depth,
      // algorithms 10.
      const Float w = exp2(-(static_cast<float>(t * t) * row.falloff + d * d)) * share;
      sum += select(valid, w * (tap - base), 0.0F);
      weights += select(valid, w, 0.0F);
    }
    store(row.out + x0, base + select(weights > 0.0F, sum / weights, 0.0F));
  }
}

}  // namespace aftershade::filter
