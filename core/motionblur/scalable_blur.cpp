#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/scalable_blur.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/scalable_blur.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>

#include "core/motionblur/scalable_blur_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

VelocityRow row_of(const HalfVelocity& velocity, int y) { return {velocity.x.row(y), velocity.y.row(y)}; }

void blur_rows(const ScalableBlurKernel& kernel, const GatherSource& source, const BlurTiles& tiles,
               std::span<Plane* const> channels) {
  gather_rows(source, tiles.moving, channels, [&](const GatherRow& row, Columns columns) {
    const int tile_row = tiles.grid.row_of(row.y);
    scalable_blur_row(
        kernel, row,
        {row_of(tiles.velocity, row.y), row_of(tiles.neighbourhood, tile_row), row_of(tiles.own, tile_row)}, columns);
  });
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

const params::Table& ScalableBlurParams::table() {
  using P = ScalableBlurParams;
  params::TableBuilder<P> builder;
  static const params::Table table =
      add_motion(builder)
          .add("taps", &P::taps, {3, 999},
               "Samples per pixel with the centre; an even number counts as the next odd one, more give a smoother "
               "blur.")
          .add("passes", &P::passes, {1, 64},
               "How often the taps are taken, each time with other jitter; the mean of all is less noisy.")
          .add("max_radius_px", &P::max_radius_px, {0, 1000},
               "Longest blur to either side of a pixel at the reference height; tile size and search radius too. 0: "
               "the frame's longest motion.")
          .add("reference_height_px", &P::reference_height_px, {1, 100000},
               "Image height that max_radius_px is meant for: at another height it scales and is rounded up.")
          .add("jitter", &P::jitter, {"checkerboard", "random4x4"},
               "How taps shift from pixel to pixel to hide banding: two phases, or sixteen.")
          .add("directions", &P::directions, {"neighbourhood", "alternate", "alternate-literal", "three"},
               "Take all taps along the fastest motion nearby, or every second one along the pixel's own motion "
               "(literally: no farther than it moves), or every third one along that and along the fastest of the "
               "pixel's tile.")
          .add("dilation", &P::dilation, {"3x3", "directional", "line"},
               "Whose motion counts as nearby: that of all tiles around, of those whose fastest points along the way "
               "to the pixel's tile, or of the pixels whose blur crosses that tile.")
          .add("comparison", &P::comparison, {"soft-extent", "relative"},
               "Compare depths by their difference over soft_depth_extent_m, or as a share of the nearer one.")
          .add("soft_depth_extent_m", &P::soft_depth_extent_m, {1e-5, 10000},
               "With comparison soft-extent: depth difference over which a sample turns from beside the centre to "
               "clearly before or behind it.")
          .add("background_weight", &P::background_weight, {0, 1000},
               "Weight of samples behind a moving pixel: what shows through its blur.")
          .add("foreground_weight", &P::foreground_weight, {0, 1000},
               "Weight of moving samples before the pixel: how strongly objects blur over their surroundings.")
          .add("both_moving_weight", &P::both_moving_weight, {0, 1000},
               "Weight added to a sample where it and the centre both move far enough to overlap.")
          .add("centre_weight", &P::centre_weight, {1e-4, 1000},
               "Factor of the pixel's own weight 1 / |v|: higher is subtler, lower is thicker.")
          .add("velocity_bits", &P::velocity_bits, {"float", "8"},
               "Precision of the velocity: as it is, or literally the slides' 8 bits from -max_radius to max_radius.")
          .build();
  return table;
}

int max_radius_px(const ScalableBlurParams& params, int display_height) {
  return radius_at(params.max_radius_px, params.reference_height_px, display_height);
}

int radius_px(const ScalableBlurParams& params, const HalfVelocity& velocity, int display_height) {
  if (params.max_radius_px > 0) return max_radius_px(params, display_height);
  const int side = std::max(velocity.x.width(), velocity.x.height());
  return std::clamp(static_cast<int>(std::ceil(longest_px(velocity))), 1, side);
}

namespace {

HWY_EXPORT(blur_rows);

ScalableBlurKernel kernel_of(const ScalableBlurParams& params, Window window) {
  return {window.min_x,
          window.min_y,
          params.taps | 1,
          params.passes,
          params.jitter == Jitter::checkerboard,
          params.directions,
          params.comparison == DepthComparison::relative,
          1.0F / params.soft_depth_extent_m,
          params.background_weight,
          params.foreground_weight,
          params.both_moving_weight,
          params.centre_weight};
}

VelocityTiles tiles_of(const ScalableBlurParams& params, const HalfVelocity& velocity, int radius, Window window) {
  HalfVelocity own = tile_max(velocity, radius, window);
  HalfVelocity neighbours = dilated(params.dilation, velocity, own, radius, window);
  return {radius, std::move(own), std::move(neighbours)};
}

void blur(const ScalableBlurParams& params, const GatherInput& input, const HalfVelocity& velocity, int radius,
          std::span<Plane* const> channels) {
  const TileGrid grid(radius, input.window);
  const VelocityTiles tiles = tiles_of(params, velocity, radius, input.window);
  const MovingTiles moving(tiles.neighbours, grid);
  if (moving.any()) HWY_DYNAMIC_DISPATCH(blur_rows)
  (kernel_of(params, input.window), gather_source(velocity, input.depth, channels, moving),
   {grid, moving, velocity, widened(tiles.neighbours, grid), widened(tiles.own, grid)}, channels);
}

}  // namespace

void scalable_motion_blur(const ScalableBlurParams& params, const GatherInput& input,
                          std::span<Plane* const> channels) {
  const int radius = radius_px(params, *input.velocity, input.display_height);
  if (params.velocity_bits == VelocityBits::exact)
    blur(params, input, *input.velocity, radius, channels);
  else
    blur(params, input, at_8_bits(*input.velocity, static_cast<float>(radius)), radius, channels);
}

VelocityTiles velocity_tiles(const ScalableBlurParams& params, const GatherInput& input) {
  const int radius = radius_px(params, *input.velocity, input.display_height);
  if (params.velocity_bits == VelocityBits::exact) return tiles_of(params, *input.velocity, radius, input.window);
  return tiles_of(params, at_8_bits(*input.velocity, static_cast<float>(radius)), radius, input.window);
}

}  // namespace aftershade::motionblur
#endif
