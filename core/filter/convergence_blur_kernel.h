#pragma once
#include "core/filter/lane_geometry.h"

namespace aftershade::filter {

/// One direction of the separable filter: taps at (x + t dx, y + t dy), |t| <= reach.
struct ConvergenceBlurRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  EdgeTolerance tolerance;
  Samples value, convergence;
  int dx, dy;
  int reach;     ///< ceil(radius)
  float radius;  ///< where nothing has converged
  float* out;
};

/// The mean is taken of differences from the centre, as in bilateral_blur_row; a texel counts by how much of it the
/// radius covers, so that the kernel shrinks without a jump.
inline void convergence_blur_row(const ConvergenceBlurRow& row, int y) {
  for (int x0 = 0; x0 < row.value.width; x0 += kLanes) {
    const Int x = row.value.clamp_x(iota(x0)), iy = y;
    const Point centre = row.grid.point(row.lens, x, iy);
    const Mask here = is_surface(centre.z);
    const Point normal = row.normals(to_int(row.grid.x_of(x, iy)), to_int(row.grid.y_of(x, iy)));
    const Float inv_tolerance = 1.0F / row.tolerance.at(centre.z);
    const Float radius = row.radius * (1.0F - sat(row.convergence(x, iy)));
    const Float sigma = (radius + 1.0F) * 0.5F, falloff = 0.5F / (sigma * sigma);
    const Float own = row.value(x, iy);
    const Float base = select(is_finite(own), own, 1.0F);
    Float sum = 0.0F, weights = 0.0F;
    for (int t = -row.reach; t <= row.reach; ++t) {
      const auto offset = static_cast<float>(t < 0 ? -t : t);
      const Int tx = x + Int(t * row.dx), ty = iy + Int(t * row.dy);
      const Int sx = row.value.clamp_x(tx), sy = row.value.clamp_y(ty);
      const Point point = row.grid.point(row.lens, sx, sy);
      const Float tap = row.value(sx, sy);
      const Mask valid = here & row.value.contains(tx, ty) & is_surface(point.z) & is_finite(tap);
      const Float d = plane_distance(point - centre, normal) * inv_tolerance;
      const Float share = sat(radius - offset + 1.0F) * sat(row.convergence(sx, sy));
      const Float w = exp2(-(falloff * (offset * offset) + d * d)) * share;
      sum += select(valid, w * (tap - base), 0.0F);
      weights += select(valid, w, 0.0F);
    }
    store(row.out + x0, base + select(weights > 0.0F, sum / weights, 0.0F));
  }
}

}  // namespace aftershade::filter
