#include "core/filter/convergence_blur.h"

#include <algorithm>
#include <cmath>

#include "core/filter/convergence_blur_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::filter {

Plane convergence_blur(const BilateralBlurParams& params, ConstPlaneView value, ConstPlaneView convergence,
                       const SampleGrid& grid, const Surface& surface) {
  constexpr float kPatternReach = 2;  // texels, across a 4x4 pattern; the least radius, unless less is asked for
  const float radius = std::max(scaled_px(params.radius_px, params.reference_height_px, surface.display_height),
                                std::min(params.radius_px, kPatternReach));
  if (!(radius > 0)) return copy_of(value);
  const EdgeTolerance tolerance(params.edge_distance_m, params.edge_footprints, grid.step, surface.projection);
  const auto pass = [&](ConstPlaneView in, int dx, int dy) {
    Plane out(in.width, in.height);
    for_rows(in.height, [&](int y) {
      convergence_blur_row({GridSamples(grid), NormalSamples(surface), Lens(surface.projection), tolerance, Samples(in),
                            Samples(convergence), dx, dy, static_cast<int>(std::ceil(radius)), radius, out.row(y)},
                           y);
    });
    return out;
  };
  return pass(pass(value, 1, 0), 0, 1);
}

}  // namespace aftershade::filter
