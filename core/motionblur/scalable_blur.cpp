#include "core/motionblur/scalable_blur.h"

#include <algorithm>
#include <cmath>

#include "core/filter/surface.h"
#include "core/motionblur/gather_source.h"
#include "core/motionblur/scalable_blur_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

const params::Table& ScalableBlurParams::table() {
  using P = ScalableBlurParams;
  params::TableBuilder<P> builder;
  static const params::Table table =
      add_motion(builder)
          .add("taps", &P::taps, {3, 999},
               "Samples per pixel with the centre; an even number counts as the next odd one, more give a smoother "
               "blur.")
          .add("max_radius_px", &P::max_radius_px, {1, 1000},
               "Longest blur to either side of a pixel at the reference height; tile size and search radius too.")
          .add("reference_height_px", &P::reference_height_px, {1, 100000},
               "Image height that max_radius_px is meant for: at another height it scales and is rounded up.")
          .add("jitter", &P::jitter, {"checkerboard", "random4x4"},
               "How taps shift from pixel to pixel to hide banding: two phases, or sixteen.")
          .add("directions", &P::directions, {"neighbourhood", "alternate"},
               "Take all taps along the fastest motion nearby, or every second one along the pixel's own motion.")
          .add("soft_depth_extent_m", &P::soft_depth_extent_m, {1e-5, 10000},
               "Depth difference over which a sample turns from beside the centre to clearly before or behind it.")
          .add("background_weight", &P::background_weight, {0, 1000},
               "Weight of samples behind a moving pixel: what shows through its blur.")
          .add("foreground_weight", &P::foreground_weight, {0, 1000},
               "Weight of moving samples before the pixel: how strongly objects blur over their surroundings.")
          .add("both_moving_weight", &P::both_moving_weight, {0, 1000},
               "Weight added to a sample where it and the centre both move far enough to overlap.")
          .add("centre_weight", &P::centre_weight, {1e-4, 1000},
               "Factor of the pixel's own weight 1 / |v|: higher is subtler, lower is thicker.")
          .build();
  return table;
}

int max_radius_px(const ScalableBlurParams& params, int display_height) {
  return std::max(
      1,
      static_cast<int>(std::ceil(filter::scaled_px(params.max_radius_px, params.reference_height_px, display_height))));
}

namespace {

bool is_moving(const HalfVelocity& tiles) {
  for (int row = 0; row < tiles.x.height(); ++row)
    for (int column = 0; column < tiles.x.width(); ++column)
      if (std::hypot(tiles.x(column, row), tiles.y(column, row)) > kLeastRadius_px) return true;
  return false;
}

ScalableBlurKernel kernel_of(const ScalableBlurParams& params, const BlurInput& input, const GatherSource& source) {
  ScalableBlurKernel kernel{};
  kernel.width = input.window.width();
  kernel.height = input.window.height();
  kernel.stride = static_cast<int>(source.speed.view().stride);
  kernel.origin_x = input.window.min_x;
  kernel.origin_y = input.window.min_y;
  kernel.speed = source.speed.row(0);
  kernel.depth = source.depth.row(0);
  kernel.taps = params.taps | 1;
  kernel.checkerboard = params.jitter == Jitter::checkerboard;
  kernel.alternate = params.directions == Directions::alternate;
  kernel.inverse_soft_extent = 1.0F / params.soft_depth_extent_m;
  kernel.background_weight = params.background_weight;
  kernel.foreground_weight = params.foreground_weight;
  kernel.both_moving_weight = params.both_moving_weight;
  kernel.centre_weight = params.centre_weight;
  return kernel;
}

}  // namespace

void scalable_motion_blur(const ScalableBlurParams& params, const BlurInput& input, std::span<Plane* const> channels,
                          HalfVelocity* tiles) {
  const int radius = max_radius_px(params, input.display_height);
  const TileGrid grid(radius, input.window);
  HalfVelocity neighbours = neighbour_max(tile_max(*input.velocity, radius, input.window));
  if (is_moving(neighbours)) {
    const HalfVelocity wide = widened(neighbours, grid);
    const GatherSource source = gather_source(*input.velocity, input.depth, channels);
    ScalableBlurKernel kernel = kernel_of(params, input, source);
    constexpr auto group = static_cast<size_t>(ScalableBlurKernel::kChannels);
    for (size_t first = 0; first < channels.size(); first += group) {
      kernel.channels = static_cast<int>(std::min(group, channels.size() - first));
      for (size_t c = 0; c < static_cast<size_t>(kernel.channels); ++c)
        kernel.source[c] = source.colour[first + c].row(0);
      for_rows(kernel.height, [&](int y) {
        const int tile_row = grid.row_of(y);
        ScalableBlurRow row{
            input.velocity->x.row(y), input.velocity->y.row(y), wide.x.row(tile_row), wide.y.row(tile_row), {}};
        for (size_t c = 0; c < static_cast<size_t>(kernel.channels); ++c) row.target[c] = channels[first + c]->row(y);
        scalable_blur_row(kernel, row, y);
      });
    }
  }
  if (tiles != nullptr) *tiles = std::move(neighbours);
}

}  // namespace aftershade::motionblur
