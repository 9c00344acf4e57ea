#if defined(AFTERSHADE_CORE_FILTER_CROSS_BILATERAL_BLUR_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_CROSS_BILATERAL_BLUR_KERNEL_H
#undef AFTERSHADE_CORE_FILTER_CROSS_BILATERAL_BLUR_KERNEL_H
#else
#define AFTERSHADE_CORE_FILTER_CROSS_BILATERAL_BLUR_KERNEL_H
#endif
#include <initializer_list>
#include <span>

#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

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

/// For pixel x of the row at work: the value and scaled depth at ao + x and depth + x; with `next_ao` and `next_depth`
/// the means of these and those, which is what a linear tap between two pixels reads.
struct CrossTap {
  const float *ao, *depth;
  const float *next_ao, *next_depth;
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

inline Float tapped(const float* one, const float* next, int x) {
  return next != nullptr ? (load(one + x) + load(next + x)) * 0.5F : load(one + x);
}

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
        const Float straight = tapped(tap.depth, tap.next_depth, x) - z0;
        const Float dz = row.depth_slope ? straight - tap.distance * slope : straight;
        const Float w = exp2(tap.log2_weight - dz * dz);
        sum += w * (tapped(tap.ao, tap.next_ao, x) - base);
        weights += w;
      }
    }
    store(row.out + x, select(is_finite(z0), base + sum / weights, 1.0F));
  }
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
