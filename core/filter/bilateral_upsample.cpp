#include "core/filter/bilateral_upsample.h"

#include "core/filter/bilateral_upsample_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::filter {

const params::Table& BilateralUpsampleParams::table() {
  using P = BilateralUpsampleParams;
  static const params::Table records =
      params::TableBuilder<P>()
          .add("edge_distance_m", &P::edge_distance_m, {0, 1000},
               "Distance from a pixel's tangent plane at which a texel's share has fallen to a half.")
          .add("edge_footprints", &P::edge_footprints, {0.1, 100},
               "The same distance in texel footprints at the pixel's depth; the larger of the two counts.")
          .build();
  return records;
}

Plane bilateral_upsample(const BilateralUpsampleParams& params, ConstPlaneView value, const SampleGrid& grid,
                         const Surface& surface) {
  if (grid.step == 1) return copy_of(value);
  const EdgeTolerance tolerance(params.edge_distance_m, params.edge_footprints, grid.step, surface.projection);
  Plane out(surface.depth.width, surface.depth.height, 1.0F);
  for_rows(out.height(), [&](int y) {
    bilateral_upsample_row({GridSamples(grid), NormalSamples(surface), Lens(surface.projection), tolerance,
                            Samples(surface.depth), Samples(value), grid.origin_x, grid.origin_y, out.row(y)},
                           y);
  });
  return out;
}

}  // namespace aftershade::filter
