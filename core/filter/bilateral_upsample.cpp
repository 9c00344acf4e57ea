#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/bilateral_upsample.cpp"  // this file, compiled once a SIMD target
#include "core/filter/bilateral_upsample.h"

#include <hwy/foreach_target.h>

#include "core/filter/additive_upsample_kernel.h"
#include "core/filter/bilateral_upsample_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

void upsample_additively(const BilateralUpsampleParams& params, ConstPlaneView value, const SampleGrid& grid,
                         const Surface& surface, Plane& out) {
  const bool literal = params.weights == UpsampleWeights::additive_literal;
  for_rows(out.height(), [&](int y) {
    additive_upsample_row({Samples(surface.depth), Samples(grid.depth), Samples(value), grid.origin_x, grid.origin_y,
                           params.additive_range_m, literal, out.row(y)},
                          y);
  });
}

void upsample_multiplicatively(const BilateralUpsampleParams& params, ConstPlaneView value, const SampleGrid& grid,
                               const Surface& surface, Plane& out) {
  const EdgeTolerance tolerance(params.edge_distance_m, params.edge_footprints, grid.step, surface.projection);
  for_rows(out.height(), [&](int y) {
    bilateral_upsample_row({GridSamples(grid), NormalSamples(surface), Lens(surface.projection), tolerance,
                            Samples(surface.depth), Samples(value), grid.origin_x, grid.origin_y, out.row(y)},
                           y);
  });
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::filter {

const params::Table& BilateralUpsampleParams::table() {
  using P = BilateralUpsampleParams;
  static const params::Table records =
      params::TableBuilder<P>()
          .add("edge_distance_m", &P::edge_distance_m, {0, 1000},
               "Distance from a pixel's tangent plane at which a texel's share has fallen to a half.")
          .add("edge_footprints", &P::edge_footprints, {0.1, 100},
               "The same distance in texel footprints at the pixel's depth; the larger of the two counts.")
          .add("weights", &P::weights, {"multiplicative", "additive", "additive-literal"},
               "How a texel's place and surface weigh together: multiplied; added, as in SOMA, over depths alone and "
               "softer; or added as SOMA's shader was printed, with negative weights and shifted by a pixel.")
          .add("additive_range_m", &P::additive_range_m, {1e-6, 1000},
               "Difference in depth at which a texel counts as another surface when weights are added.")
          .build();
  return records;
}

namespace {
HWY_EXPORT(upsample_additively);
HWY_EXPORT(upsample_multiplicatively);
}  // namespace

Plane bilateral_upsample(const BilateralUpsampleParams& params, ConstPlaneView value, const SampleGrid& grid,
                         const Surface& surface) {
  if (grid.step == 1) return copy_of(value);
  Plane out = Plane::for_overwrite(surface.depth.width, surface.depth.height);
  if (params.weights == UpsampleWeights::multiplicative)
    HWY_DYNAMIC_DISPATCH(upsample_multiplicatively)(params, value, grid, surface, out);
  else
    HWY_DYNAMIC_DISPATCH(upsample_additively)(params, value, grid, surface, out);
  return out;
}

}  // namespace aftershade::filter
#endif
