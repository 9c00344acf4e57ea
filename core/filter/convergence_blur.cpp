#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/convergence_blur.cpp"  // this file, compiled once a SIMD target
#include "core/filter/convergence_blur.h"

#include <hwy/foreach_target.h>

#include <cmath>

#include "core/filter/convergence_blur_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

Plane converge_both_ways(const BilateralBlurParams& params, float radius, ConstPlaneView value,
                         ConstPlaneView convergence, const SampleGrid& grid, const Surface& surface) {
  const EdgeTolerance tolerance(params.edge_distance_m, params.edge_footprints, grid.step, surface.projection);
  const auto pass = [&](ConstPlaneView in, int dx, int dy) {
    Plane out = Plane::for_overwrite(in.width, in.height);
    for_rows(in.height, [&](int y) {
      convergence_blur_row({GridSamples(grid), NormalSamples(surface), Lens(surface.projection), tolerance, Samples(in),
                            Samples(convergence), dx, dy, static_cast<int>(std::ceil(radius)), radius, out.row(y)},
                           y);
    });
    return out;
  };
  return pass(pass(value, 1, 0), 0, 1);
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::filter {

namespace {
HWY_EXPORT(converge_both_ways);
}  // namespace

Plane convergence_blur(const BilateralBlurParams& params, ConstPlaneView value, ConstPlaneView convergence,
                       const SampleGrid& grid, const Surface& surface) {
  const float radius = radius_texels(params, surface.display_height);
  if (!(radius > 0)) return copy_of(value);
  return HWY_DYNAMIC_DISPATCH(converge_both_ways)(params, radius, value, convergence, grid, surface);
}

}  // namespace aftershade::filter
#endif
