#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/bilateral_blur.cpp"  // this file, compiled once a SIMD target
#include "core/filter/bilateral_blur.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>

#include "core/filter/bilateral_blur_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

Plane blur_both_ways(const BilateralBlurParams& params, float radius, ConstPlaneView value, const SampleGrid& grid,
                     const Surface& surface) {
  constexpr int kBand = 16;  // rows whose points are worked out together
  const int reach = static_cast<int>(std::ceil(radius));
  const float sigma = (radius + 1) / 2;
  const EdgeTolerance tolerance(params.edge_distance_m, params.edge_footprints, grid.step, surface.projection);
  const GridSamples texels(grid);
  const auto pass = [&](ConstPlaneView in, int dx, int dy) {
    Plane out = Plane::for_overwrite(in.width, in.height);
    for_rows((in.height + kBand - 1) / kBand, [&](int band) {
      const int first = band * kBand, last = std::min(first + kBand, in.height) - 1;
      const TexelPoints points(texels, Lens(surface.projection), std::max(first - dy * reach, 0),
                               std::min(last + dy * reach, in.height - 1));
      for (int y = first; y <= last; ++y)
        bilateral_blur_row({texels, points, NormalSamples(surface), tolerance, Samples(in), dx, dy, reach,
                            radius - static_cast<float>(reach - 1), 1 / (2 * sigma * sigma), out.row(y)},
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

float radius_texels(const BilateralBlurParams& params, int display_height) {
  constexpr float kPatternReach = 2;  // across a 4x4 pattern
  return std::max(scaled_px(params.radius_px, params.reference_height_px, display_height),
                  std::min(params.radius_px, kPatternReach));
}

const params::Table& BilateralBlurParams::table() {
  using P = BilateralBlurParams;
  static const params::Table records =
      params::TableBuilder<P>()
          .add("channel", &P::channel,
               "Name of a channel of the file, without its view, that is blurred at full resolution and written back; "
               "empty for the AO.")
          .add("radius_px", &P::radius_px, {0, 64},
               "Reach of the blur to each side, in texels of the AO's own grid at the reference height; 0 switches it "
               "off.")
          .add("reference_height_px", &P::reference_height_px, {1, 65536},
               "Image height at which radius_px is meant; at other heights it scales with the height, though not below "
               "2.")
          .add("edge_distance_m", &P::edge_distance_m, {0, 1000},
               "Distance from a pixel's tangent plane at which another pixel's share has fallen to a half.")
          .add("edge_footprints", &P::edge_footprints, {0.1, 100},
               "The same distance in texel footprints at the pixel's depth; the larger of the two counts.")
          .build();
  return records;
}

namespace {
HWY_EXPORT(blur_both_ways);
}  // namespace

Plane bilateral_blur(const BilateralBlurParams& params, ConstPlaneView value, const SampleGrid& grid,
                     const Surface& surface) {
  const float radius = radius_texels(params, surface.display_height);
  if (!(radius > 0)) return copy_of(value);
  return HWY_DYNAMIC_DISPATCH(blur_both_ways)(params, radius, value, grid, surface);
}

}  // namespace aftershade::filter
#endif
