#pragma once
#include "core/filter/lane_geometry.h"

namespace aftershade::filter {

struct BilateralUpsampleRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  EdgeTolerance tolerance;
  Samples depth, value;
  int origin_x, origin_y;  ///< window index of block (0,0)'s first pixel
  float* out;
};

/// A tent of half-width 3 px: picked pixels are at most 3 px apart, and it is 0 beyond the 3x3 blocks around the
/// pixel's.
inline Float tent(Float distance_px) { return max(0.0F, 1.0F - abs(distance_px) * (1.0F / 3.0F)); }

/// Running sums over the texels; differences from `base`, so that a constant stays the same to the bit.
struct UpsampleSum {
  Float base;
  Float sum = 0.0F, weights = 0.0F;
  Float nearest = HUGE_VALF, nearest_difference = 0.0F;

  void add(Mask valid, Float w, Float depth_gap, Float value) {
    const Float difference = select(valid, value - base, 0.0F);
    sum += select(valid, w * difference, 0.0F);
    weights += select(valid, w, 0.0F);
    const Mask nearer = valid & (depth_gap < nearest);
    nearest = select(nearer, depth_gap, nearest);
    nearest_difference = select(nearer, difference, nearest_difference);
  }
  /// algorithms 11: "if sum of weights < 1e-3 use nearest-depth sample".
  Float result() const { return base + select(weights < 1e-3F, nearest_difference, sum / weights); }
};

inline void bilateral_upsample_row(const BilateralUpsampleRow& row, int y) {
  const int block_y = (y - row.origin_y) >> 1;
  for (int x0 = 0; x0 < row.depth.width; x0 += kLanes) {
    const Int x = row.depth.clamp_x(iota(x0)), iy = y;
    const Int block_x = (x - Int(row.origin_x)) >> 1;
    const Float z = row.depth(x, iy);
    const Mask here = is_surface(z);
    const Point centre = unproject(row.lens, to_float(x), to_float(iy), z);
    const Point normal = row.normals(x, iy);
    const Float inv_tolerance = 1.0F / row.tolerance.at(z);
    const Float own = row.value(block_x, block_y);
    UpsampleSum total{select(is_finite(own), own, 1.0F)};
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i) {
        const Int tx = block_x + Int(i), ty = block_y + j;
        const Int sx = row.value.clamp_x(tx), sy = row.value.clamp_y(ty);
        const Point point = row.grid.point(row.lens, sx, sy);
        const Float value = row.value(sx, sy);
        const Mask valid = here & row.value.contains(tx, ty) & is_surface(point.z) & is_finite(value);
        const Float d = plane_distance(point - centre, normal) * inv_tolerance;
        // Kopf et al. 2007: S_p = 1/k sum S_q f(|p - q|) g(surface distance); weights multiply (algorithms 11).
        const Float f = tent(row.grid.x_of(sx, sy) - to_float(x)) * tent(row.grid.y_of(sx, sy) - to_float(iy));
        total.add(valid, f * exp2(-(d * d)), abs(point.z - z), value);
      }
    store(row.out + x0, select(here, total.result(), 1.0F));
  }
}

}  // namespace aftershade::filter
