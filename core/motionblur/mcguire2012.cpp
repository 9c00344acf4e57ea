#include "core/motionblur/mcguire2012.h"

#include "core/motionblur/jitter.h"
#include "core/motionblur/mcguire2012_kernel.h"
#include "core/motionblur/tile_max.h"

namespace aftershade::motionblur {

const params::Table& Mcguire2012Params::table() {
  using P = Mcguire2012Params;
  params::TableBuilder<P> builder;
  static const params::Table table =
      add_motion(builder)
          .add("taps", &P::taps, {3, 999},
               "Samples per pixel with the centre; an even number counts as the next odd one, more give a smoother "
               "and more opaque blur.")
          .add("max_radius_px", &P::max_radius_px, {0, 1000},
               "Longest blur to either side of a pixel at the reference height; tile size and search radius too. 0: "
               "the frame's longest motion.")
          .add("reference_height_px", &P::reference_height_px, {1, 100000},
               "Image height that max_radius_px is meant for: at another height it scales and is rounded up.")
          .add("soft_depth_extent_m", &P::soft_depth_extent_m, {1e-5, 10000},
               "Depth difference over which a sample turns from beside the centre to clearly before or behind it.")
          .build();
  return table;
}

void mcguire2012_blur(const Mcguire2012Params& params, const GatherInput& input, std::span<Plane* const> channels) {
  const int radius = radius_px(params, *input.velocity, input.display_height);
  const TileGrid grid(radius, input.window);
  const HalfVelocity neighbours = neighbour_max(tile_max(*input.velocity, radius, input.window));
  if (!any_moves(neighbours)) return;
  const HalfVelocity wide = widened(neighbours, grid);
  const Plane jitter = random_jitter(input.window);
  const Mcguire2012Kernel kernel{params.taps | 1, 1.0F / params.soft_depth_extent_m};
  gather_rows(gather_source(*input.velocity, input.depth, channels), channels,
              [&](const GatherPlanes& planes, float* const* target, int y) {
                const int tile_row = grid.row_of(y);
                mcguire2012_row(kernel, planes, {wide.x.row(tile_row), wide.y.row(tile_row), jitter.row(y)}, target, y);
              });
}

}  // namespace aftershade::motionblur
