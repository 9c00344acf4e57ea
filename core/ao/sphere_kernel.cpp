#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ao/sphere_kernel.cpp"  // this file, compiled once a SIMD target
#include "core/ao/sphere_kernel.h"

#include <hwy/foreach_target.h>

#include "core/ao/sphere_kernel_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

Plane visibility_in_ball(const SphereSamples& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                         const SampleRange& range) {
  const SphereTaps taps(params, surface, grid);
  Plane out = Plane::for_overwrite(grid.width(), grid.height());
  for_rows(out.height(), [&](int y) { sphere_kernel_row({taps, RangeRow(range, y), out.row(y)}, y); });
  return out;
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::ao {

const params::Table& SphereKernelParams::table() {
  using P = SphereKernelParams;
  static const params::Table records = [] {
    params::TableBuilder<P> table;
    table.add("resolution", &P::resolution, {"full", "half"},
              "Evaluate the AO at every pixel, or at one pixel of every 2x2 block.");
    return add_sphere_samples(table)
        .add("per_frame_noise", &P::per_frame_noise, "Test new points every frame, for a temporal filter to average.")
        .build();
  }();
  return records;
}

int first_of_frame(int number, int count) {
  const auto first = static_cast<long long>(number) * count % kSequenceLength;
  return static_cast<int>(first < 0 ? first + kSequenceLength : first);
}

namespace {
HWY_EXPORT(visibility_in_ball);
}  // namespace

Plane sphere_kernel(const SphereSamples& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                    const SampleRange& range) {
  return HWY_DYNAMIC_DISPATCH(visibility_in_ball)(params, surface, grid, range);
}

}  // namespace aftershade::ao
#endif
