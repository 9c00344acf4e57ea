#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/mcguire2012.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/mcguire2012.h"

#include <hwy/foreach_target.h>

#include "core/motionblur/jitter.h"
#include "core/motionblur/mcguire2012_kernel.h"
#include "core/motionblur/tile_max.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

/// `wide`: the velocities v_N of each row of tiles.
void blur_rows(const Mcguire2012Params& params, const GatherSource& source, const MovingTiles& tiles,
               const TileGrid& grid, const HalfVelocity& wide, const Plane& jitter, std::span<Plane* const> channels) {
  gather_rows(source, tiles, channels, [&](const GatherRow& row, Columns columns) {
    const int tile_row = grid.row_of(row.y);
    mcguire2012_row({params.taps | 1, 1.0F / params.soft_depth_extent_m, wide.x.row(tile_row), wide.y.row(tile_row),
                     jitter.row(row.y)},
                    row, columns);
  });
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

namespace {
HWY_EXPORT(blur_rows);
}

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

VelocityTiles velocity_tiles(const Mcguire2012Params& params, const GatherInput& input) {
  const int radius = radius_px(params, *input.velocity, input.display_height);
  HalfVelocity own = tile_max(*input.velocity, radius, input.window);
  HalfVelocity neighbours = neighbour_max(own);
  return {radius, std::move(own), std::move(neighbours)};
}

void mcguire2012_blur(const Mcguire2012Params& params, const GatherInput& input, std::span<Plane* const> channels) {
  const auto [radius, own, neighbours] = velocity_tiles(params, input);
  const TileGrid grid(radius, input.window);
  const MovingTiles tiles(neighbours, grid);
  if (!tiles.any()) return;
  HWY_DYNAMIC_DISPATCH(blur_rows)
  (params, gather_source(*input.velocity, input.depth, channels, tiles), tiles, grid, widened(neighbours, grid),
   random_jitter(input.window), channels);
}

}  // namespace aftershade::motionblur
#endif
