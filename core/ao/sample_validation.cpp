#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ao/sample_validation.cpp"  // this file, compiled once a SIMD target
#include "core/ao/sample_validation.h"

#include <hwy/foreach_target.h>

#include "core/ao/sample_validation_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

Plane confidence_of_samples(const SphereSamples& params, const ValidationParams& validation,
                            const filter::Surface& surface, const filter::SampleGrid& grid, const SampleRange& range,
                            const PastSurface& past) {
  Plane out = Plane::for_overwrite(grid.width(), grid.height());
  const SphereTaps taps(params, surface, grid);
  const PastSamples before(past);
  const EdgeTolerance rounding(0, validation.validation_footprints, 1, surface.projection);
  const float limit_m = validation.validation == Validation::binary ? validation.validation_limit * params.radius_m
                                                                    : std::numeric_limits<float>::infinity();
  for_rows(out.height(), [&](int y) {
    sample_confidence_row({taps, before, RangeRow(range, y), rounding,
                           validation.validation_sharpness / params.radius_m, limit_m, past.same_depth, out.row(y)},
                          y);
  });
  return out;
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::ao {

namespace {
HWY_EXPORT(confidence_of_samples);
}  // namespace

Plane sample_confidence(const SphereSamples& params, const ValidationParams& validation, const filter::Surface& surface,
                        const filter::SampleGrid& grid, const SampleRange& range, const PastSurface& past) {
  if (validation.validation == Validation::off) return Plane(grid.width(), grid.height(), 1.0F);
  return HWY_DYNAMIC_DISPATCH(confidence_of_samples)(params, validation, surface, grid, range, past);
}

}  // namespace aftershade::ao
#endif
