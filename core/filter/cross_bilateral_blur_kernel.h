#pragma once
#include <limits>
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

/// The pixel at offset `first`, or the mean of those at `first` and `second` (a linear tap between them).
struct CrossTap {
  int first, second;
  float log2_weight;  ///< of the distance alone
  float distance;     ///< of the tap from the centre, pixels
};

/// One row of either pass: ao[reach + r] + x is the pixel r steps along the pass from pixel x of this row.
struct CrossBilateralRow {
  std::span<const float*const> ao, depth;  ///< 2 * reach + 1 each
  int reach;
  std::span<const CrossTap> taps;  ///< of the side of positive offsets; the other mirrors it
  bool depth_slope;
  int width;
  float* out;
};

/// seed 000, CrossBilateralWeight: exp2(-r^2 falloff - dz^2) with pre-scaled depths. The mean is taken of differences
/// from the centre (weight 1), so a constant stays the same to the bit.
inline void cross_bilateral_row(const CrossBilateralRow& row) {
  const float* const* ao = row.ao.data() + row.reach;
  const float* const* depth = row.depth.data() + row.reach;
  for (int x = 0; x < row.width; x += kLanes) {
    const Float base = load(ao[0] + x), z0 = load(depth[0] + x);
    const Mask here = is_finite(z0);
    Float sum = 0.0F, weights = 1.0F;
    for (int side = 1; side >= -1; side -= 2) {
      // HBAO+: depth is compared with z0 + r (z(1) - z0); algorithms 1.4.
      const Float rise = row.depth_slope ? load(depth[side] + x) - z0 : Float(0.0F);
      const Float slope = select(is_finite(rise), rise, 0.0F);
      for (const CrossTap& tap : row.taps) {
        const int a = side * tap.first, b = side * tap.second;
        Float value = load(ao[a] + x), z = load(depth[a] + x);
        if (a != b) {
          value = (value + load(ao[b] + x)) * 0.5F;
          z = (z + load(depth[b] + x)) * 0.5F;
        }
        const Float dz = row.depth_slope ? z - (z0 + tap.distance * slope) : z - z0;
        const Float w = exp2(tap.log2_weight - dz * dz);
        sum += w * (value - base);
        weights += w;
      }
    }
    store(row.out + x, select(here, base + sum / weights, 1.0F));
  }
}

}  // namespace aftershade::filter
