#if defined(AFTERSHADE_CORE_FILTER_ADDITIVE_UPSAMPLE_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_ADDITIVE_UPSAMPLE_KERNEL_H
#undef AFTERSHADE_CORE_FILTER_ADDITIVE_UPSAMPLE_KERNEL_H
#else
#define AFTERSHADE_CORE_FILTER_ADDITIVE_UPSAMPLE_KERNEL_H
#endif
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

struct AdditiveUpsampleRow {
  Samples depth;
  Samples texel_depth, value;
  int origin_x, origin_y;  ///< window index of block (0,0)'s first pixel
  float range_m;
  bool literal;
  float* out;
};

/// SOMA's upsampling as ports of its shader have it (algorithms 5.1), over the texels base + {0, 1}^2:
///   weight = w_b + 30 max(1e-5, 0.1 - |z_s - z|),  w_b = (i - w.x)(j - w.y),  w = 1 - fract,  base + fract = position
/// in metres, here over the range of 0.1 m. Literally position = (pixel + 0.5) / 2; otherwise w_b is |w_b| and position
/// is that less a half, since a block's centre lies at its number plus a half. Texels outside the grid and on
/// background do not count.
inline void additive_upsample_row(const AdditiveUpsampleRow& row, int y) {
  constexpr float kSurfaceWeight = 3, kLeast = 1e-4F;  // 30 0.1 and 1e-5 / 0.1
  const float half = row.literal ? 0.0F : 0.5F;
  const Float position_y = (static_cast<float>(y - row.origin_y) + 0.5F) * 0.5F - half, base_y = floor(position_y);
  for (int x0 = 0; x0 < row.depth.width; x0 += kLanes) {
    const Int x = row.depth.clamp_x(iota(x0)), iy = y;
    const Float z = row.depth(x, iy);
    const Mask here = is_surface(z);
    const Float position_x = (to_float(x - Int(row.origin_x)) + 0.5F) * 0.5F - half, base_x = floor(position_x);
    const Float wx = 1.0F - (position_x - base_x), wy = 1.0F - (position_y - base_y);
    const Float own = row.value((x - Int(row.origin_x)) >> 1, (iy - Int(row.origin_y)) >> 1);
    const Float base = select(is_finite(own), own, 1.0F);  // a constant stays the same to the bit
    Float sum = 0.0F, weights = 0.0F;
    for (int tap = 0; tap < 4; ++tap) {
      const int i = tap & 1, j = tap >> 1;
      const Int tx = to_int(base_x) + Int(i), ty = to_int(base_y) + Int(j);
      const Int sx = row.value.clamp_x(tx), sy = row.value.clamp_y(ty);
      const Float texel_z = row.texel_depth(sx, sy), value = row.value(sx, sy);
      const Mask valid = here & row.value.contains(tx, ty) & is_surface(texel_z) & is_finite(value);
      const Float product = (static_cast<float>(i) - wx) * (static_cast<float>(j) - wy);
      const Float bilinear = row.literal ? product : abs(product);
      const Float w = bilinear + kSurfaceWeight * max(1.0F - abs(texel_z - z) / row.range_m, kLeast);
      sum += select(valid, w * (value - base), 0.0F);
      weights += select(valid, w, 0.0F);
    }
    const Float mean = base + select(abs(weights) > 0.0F, sum / weights, 0.0F);
    store(row.out + x0, select(here, row.literal ? sat(mean) : mean, 1.0F));
  }
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
