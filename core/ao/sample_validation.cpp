#include "core/ao/sample_validation.h"

#include "core/ao/sample_validation_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::ao {

Plane sample_confidence(const SphereSamples& params, const ValidationParams& validation, const filter::Surface& surface,
                        const filter::SampleGrid& grid, const SampleRange& range, const PastSurface& past) {
  Plane out(grid.width(), grid.height(), 1.0F);
  if (validation.validation == Validation::off) return out;
  const SphereTaps taps(params, surface, grid);
  const PastSamples before(past);
  const filter::EdgeTolerance rounding(0, validation.validation_footprints, 1, surface.projection);
  const float limit_m = validation.validation == Validation::binary ? validation.validation_limit * params.radius_m
                                                                    : std::numeric_limits<float>::infinity();
  for_rows(out.height(), [&](int y) {
    sample_confidence_row({taps, before, RangeRow(range, y), rounding,
                           validation.validation_sharpness / params.radius_m, limit_m, past.same_depth, out.row(y)},
                          y);
  });
  return out;
}

}  // namespace aftershade::ao
