#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/guertin2014.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/guertin2014.h"

#include <hwy/foreach_target.h>

#include "core/motionblur/dilation.h"
#include "core/motionblur/guertin2014_kernel.h"
#include "core/motionblur/guertin_tiles.h"
#include "core/motionblur/jitter.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

void blur_rows(const Guertin2014Params& params, const GatherSource& source, const MovingTiles& moving,
               const TileChoice& tiles, const Plane& jitter, std::span<Plane* const> channels) {
  const Guertin2014Kernel kernel{params.taps, params.tap_jitter,
                                 static_cast<float>(params.taps) / params.centre_divisor, 1.0F / params.slow_px};
  gather_rows(source, moving, channels, [&](const GatherRow& row, Columns columns) {
    const Guertin2014Row choice{tiles.velocity.x.row(row.y), tiles.velocity.y.row(row.y), tiles.variance.row(row.y),
                                jitter.row(row.y)};
    guertin2014_row(kernel, choice, row, columns);
  });
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

namespace {
HWY_EXPORT(blur_rows);
}

const params::Table& Guertin2014Params::table() {
  using P = Guertin2014Params;
  params::TableBuilder<P> builder;
  static const params::Table table =
      add_motion(builder)
          .add("taps", &P::taps, {2, 999}, "Samples per pixel beside the centre; more give a smoother blur.")
          .add("max_radius_px", &P::max_radius_px, {0, 1000},
               "Longest blur to either side of a pixel at the reference height; tile size and search radius too. 0: "
               "the frame's longest motion.")
          .add("reference_height_px", &P::reference_height_px, {1, 100000},
               "Image height that max_radius_px is meant for: at another height it scales and is rounded up.")
          .add("tap_jitter", &P::tap_jitter, {0, 1},
               "How far samples shift from pixel to pixel to hide banding, as a share of their spacing (eta).")
          .add("tile_jitter", &P::tile_jitter, {0, 2},
               "How far a pixel looks for another tile at random to hide seams, in quarter tiles (tau).")
          .add("centre_divisor", &P::centre_divisor, {1e-4, 100000},
               "The pixel's own weight is taps / (centre_divisor |v|): higher blurs more thickly (kappa).")
          .add("slow_px", &P::slow_px, {1e-4, 1000},
               "Speed above half a pixel from which on samples follow the pixel's own motion; slower ones look across "
               "the motion around them (gamma).")
          .add("split", &P::split, {"even", "variance"},
               "How samples are shared between the two directions: half of them each, or more along the pixel's own "
               "motion where motions around it differ.")
          .build();
  return table;
}

VelocityTiles velocity_tiles(const Guertin2014Params& params, const GatherInput& input) {
  const int radius = radius_px(params, *input.velocity, input.display_height);
  HalfVelocity own = tile_max(*input.velocity, radius, input.window);
  HalfVelocity neighbours = dilated(Dilation::directional, *input.velocity, own, radius, input.window);
  return {radius, std::move(own), std::move(neighbours)};
}

void guertin2014_blur(const Guertin2014Params& params, const GatherInput& input, std::span<Plane* const> channels) {
  const auto [radius, own, neighbours] = velocity_tiles(params, input);
  const MovingTiles moving(neighbours, TileGrid(radius, input.window));
  if (!moving.any()) return;
  const bool even = params.split == TapSplit::even;
  const Plane share = even ? Plane(neighbours.x.width(), neighbours.x.height(), 0.5F) : direction_variance(neighbours);
  const TileChoice tiles = choose_tiles(neighbours, share, radius, input.window, 0.25F * params.tile_jitter);
  HWY_DYNAMIC_DISPATCH(blur_rows)
  (params, gather_source(*input.velocity, input.depth, channels, moving, true), moving, tiles,
   even_jitter(input.window), channels);
}

}  // namespace aftershade::motionblur
#endif
