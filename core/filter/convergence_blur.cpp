#include "core/filter/convergence_blur.h"

#include <cmath>

#include "core/filter/convergence_blur_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::filter {

Plane convergence_blur(const BilateralBlurParams& params, ConstPlaneView value, ConstPlaneView convergence,
                       const SampleGrid& grid, const Surface& surface) {
  const float radius = radius_texels(params, surface.display_height);
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
