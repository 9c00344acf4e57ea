#pragma once
#include <span>

#include "core/filter/lane_geometry.h"

namespace aftershade::filter {

/// Brings one row of AO on a grid to the pixels, beside their scaled depth.
struct PackRow {
  const float *texels_above, *texels_below;  ///< the same row, or the two between which the pixels lie
  float share_below;
  int texel_count, step, origin_x;  ///< of the grid
  bool bilinear;
  const float* depth;
  float sharpness_per_m;
  int width;
  float *ao, *scaled_depth;  ///< out, readable as far as Plane's padding
};

/// Texels lie at the centres of their blocks, as a graphics card has it: 9:3:3:1 for blocks of two pixels.
inline Float bilinear_texel(const PackRow& row, Int x) {
  const auto texels = static_cast<float>(row.texel_count);
  const Float u =
      clamp((to_float(x - Int(row.origin_x)) + 0.5F) / static_cast<float>(row.step) - 0.5F, 0.0F, texels - 1);
  const Int left = to_int(u), right = min(left + Int(1), Int(row.texel_count - 1));
  const Float share = u - to_float(left);
  const auto across = [&](const float* texel) {
    const Float a = gather(texel, left);
    return a + share * (gather(texel, right) - a);
  };
  const Float above = across(row.texels_above);
  return above + row.share_below * (across(row.texels_below) - above);
}

inline void pack_row(const PackRow& row) {
  const int shift = row.step == 2 ? 1 : 0;
  for (int x0 = 0; x0 < row.width; x0 += kLanes) {
    const Int x = min(iota(x0), Int(row.width - 1));
    const Float ao = row.bilinear ? bilinear_texel(row, x) : gather(row.texels_above, (x - Int(row.origin_x)) >> shift);
    const Float z = load(row.depth + x0);
    const Mask known = is_finite(ao);
    store(row.ao + x0, select(known, ao, 1.0F));
    store(row.scaled_depth + x0, select(known & is_surface(z), z * row.sharpness_per_m, HUGE_VALF));
  }
}

/// What a linear tap between two pixels reads, for a row of them.
inline void mean_row(const float* a, const float* b, int width, float* out) {
  for (int x = 0; x < width; x += kLanes) store(out + x, (load(a + x) + load(b + x)) * 0.5F);
}

/// For pixel x of the row at work: the value and scaled depth at ao + x and depth + x.
struct CrossTap {
  const float *ao, *depth;
  float log2_weight;  ///< of the distance alone
  float distance;     ///< of the tap from the centre, pixels
};

/// One row of either pass.
struct CrossBilateralRow {
  const float *ao, *depth;                  ///< of the pixels themselves
  std::span<const CrossTap> before, after;  ///< the two sides, the nearest first
  bool depth_slope;
  int width;
  float* out;
};

/// seed 000, CrossBilateralWeight: exp2(-r^2 falloff - dz^2) with pre-scaled depths. The mean is taken of differences
/// from the centre (weight 1), so a constant stays the same to the bit.
inline void cross_bilateral_row(const CrossBilateralRow& row) {
  for (int x = 0; x < row.width; x += kLanes) {
    const Float base = load(row.ao + x), z0 = load(row.depth + x);
    Float sum = 0.0F, weights = 1.0F;
    for (const std::span<const CrossTap> side : {row.before, row.after}) {
      // HBAO+: depth is compared with z0 + r (z(1) - z0); algorithms 1.4.
      const Float rise = row.depth_slope ? load(side.front().depth + x) - z0 : Float(0.0F);
      const Float slope = select(is_finite(rise), rise, 0.0F);
      for (const CrossTap& tap : side) {
        const Float straight = load(tap.depth + x) - z0;
        const Float dz = row.depth_slope ? straight - tap.distance * slope : straight;
        const Float w = exp2(tap.log2_weight - dz * dz);
        sum += w * (load(tap.ao + x) - base);
        weights += w;
      }
    }
    store(row.out + x, select(is_finite(z0), base + sum / weights, 1.0F));
  }
}

}  // namespace aftershade::filter
