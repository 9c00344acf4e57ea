#if defined(AFTERSHADE_CORE_FILTER_BILATERAL_UPSAMPLE_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_BILATERAL_UPSAMPLE_KERNEL_H
#undef AFTERSHADE_CORE_FILTER_BILATERAL_UPSAMPLE_KERNEL_H
#else
#define AFTERSHADE_CORE_FILTER_BILATERAL_UPSAMPLE_KERNEL_H
#endif
#include <algorithm>
#include <type_traits>

#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

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

struct Texel {
  Float x, tent_y, value;  ///< x: of its pixel; value: 0 where it is not usable
  Point point;
  Mask usable;
};

/// A pixel, and running sums over the texels around it: of differences from `base`, so that a constant stays the same
/// to the bit.
struct UpsampledPixel {
  Float x;
  Point centre, normal;
  Float inv_tolerance;
  Float base, sum, weights;
  Float nearest, nearest_difference;

  /// Kopf et al. 2007: S_p = 1/k sum S_q f(|p - q|) g(surface distance); weights multiply (algorithms 11).
  HWY_INLINE void add(const Texel& texel) {
    const Float d = plane_distance(texel.point - centre, normal) * inv_tolerance;
    const Float f = tent(texel.x - x) * texel.tent_y;
    const Float w = select(texel.usable, f * exp2(-(d * d)), 0.0F), difference = texel.value - base;
    sum += w * difference;
    weights += w;
    const Float gap = abs(texel.point.z - centre.z);
    const Mask nearer = texel.usable & (gap < nearest);
    nearest = select(nearer, gap, nearest);
    nearest_difference = select(nearer, difference, nearest_difference);
  }
  /// 1 on background. algorithms 11: "if sum of weights < 1e-3 use nearest-depth sample".
  HWY_INLINE Float result() const {
    return select(is_surface(centre.z), base + select(weights < 1e-3F, nearest_difference, sum / weights), 1.0F);
  }
};
/// `own`: the value of the pixel's block.
HWY_INLINE UpsampledPixel upsampled_pixel(const BilateralUpsampleRow& row, Float x, int y, Float z, Point normal,
                                          Float own) {
  return {x,
          unproject(row.lens, x, static_cast<float>(y), z),
          normal,
          1.0F / row.tolerance.at(z),
          select(is_finite(own), own, 1.0F),
          0.0F,
          0.0F,
          HUGE_VALF,
          0.0F};
}

/// The texels of grid row ty, seen from the pixels of row y.
template <class Column>
HWY_INLINE Texel texel_at(const BilateralUpsampleRow& row, const Column& x, int ty, int y) {
  const Float px = x(row.grid.pixel_x.row(ty)), py = x(row.grid.pixel_y.row(ty)), z = x(row.grid.depth.row(ty));
  const Float value = x(row.value.row(ty));
  Mask usable = is_surface(z) & is_finite(value);
  if constexpr (!std::is_same_v<Column, Columns<true>>) usable = usable & x.inside;
  return {px, tent(py - static_cast<float>(y)), select(usable, value, 0.0F), unproject(row.lens, px, py, z), usable};
}

/// Columns of the blocks that pixels lie in, moved by some; those outside the grid have the border's values.
struct BlockColumns {
  BlockColumns(const BilateralUpsampleRow& row, Int x, int move) {
    const Int block = ((x - Int(row.origin_x)) >> 1) + Int(move);
    inside = (block >= Int(0)) & (block < Int(row.value.width));
    index = clamp(block, 0, row.value.width - 1);
  }
  Int index;
  Mask inside;
  Float operator()(const float* texels) const { return gather(texels, index); }
};

/// Rows of the 3x3 blocks around a row of pixels.
struct BlockRows {
  BlockRows(const BilateralUpsampleRow& row, int y)
      : own((y - row.origin_y) >> 1), first(std::max(own - 1, 0)), last(std::min(own + 1, row.value.height - 1)) {}
  int own, first, last;
};

/// Pixels from x0 on, wherever they are.
inline void upsample_pixels(const BilateralUpsampleRow& row, const BlockRows& blocks, int x0, int y) {
  const Columns<false> x(x0, row.depth.width);
  const Float own = BlockColumns(row, x.index, 0)(row.value.row(blocks.own));
  UpsampledPixel pixel = upsampled_pixel(row, to_float(x.index), y, x(row.depth.row(y)), row.normals(x, y), own);
  for (int ty = blocks.first; ty <= blocks.last; ++ty)
    for (int i = -1; i <= 1; ++i) pixel.add(texel_at(row, BlockColumns(row, x.index, i), ty, y));
  store(row.out + x0, pixel.result());
}

/// All pixels of kLanes blocks, whose neighbours on both sides are inside: a texel is read once for the two pixels of
/// each block.
inline void upsample_blocks(const BilateralUpsampleRow& row, const BlockRows& blocks, int block, int y) {
  const int x0 = row.origin_x + 2 * block;
  const Pairs z = load_pairs(row.depth.row(y) + x0);
  if (!any(is_surface(z.even) | is_surface(z.odd))) return store_pairs(row.out + x0, 1.0F, 1.0F);
  const auto normal = [&](const Samples& axis) { return load_pairs(axis.row(y) + x0); };
  const Pairs nx = normal(row.normals.nx), ny = normal(row.normals.ny), nz = normal(row.normals.nz);
  const Float own = load(row.value.row(blocks.own) + block), x = to_float((iota(0) << 1) + Int(x0));
  UpsampledPixel even = upsampled_pixel(row, x, y, z.even, finite_normal({nx.even, ny.even, nz.even}), own);
  UpsampledPixel odd = upsampled_pixel(row, x + 1.0F, y, z.odd, finite_normal({nx.odd, ny.odd, nz.odd}), own);
  for (int ty = blocks.first; ty <= blocks.last; ++ty)
    for (int i = -1; i <= 1; ++i) {
      const Texel texel = texel_at(row, Columns<true>(block + i, row.value.width), ty, y);
      even.add(texel);
      odd.add(texel);
    }
  store_pairs(row.out + x0, even.result(), odd.result());
}

inline void bilateral_upsample_row(const BilateralUpsampleRow& row, int y) {
  const BlockRows blocks(row, y);
  int block = 1;
  for (int x0 = 0; x0 < row.origin_x + 2 * block && x0 < row.depth.width; x0 += kLanes)
    upsample_pixels(row, blocks, x0, y);
  for (; block + kLanes + 1 <= row.value.width && row.origin_x + 2 * (block + kLanes) <= row.depth.width;
       block += kLanes)
    upsample_blocks(row, blocks, block, y);
  for (int x0 = row.origin_x + 2 * block; x0 < row.depth.width; x0 += kLanes) upsample_pixels(row, blocks, x0, y);
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
