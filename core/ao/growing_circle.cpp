#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ao/growing_circle.cpp"  // this file, compiled once a SIMD target
#include "core/ao/growing_circle.h"

#include <hwy/foreach_target.h>

#include <cmath>
#include <span>
#include <vector>

#include "core/ao/growing_circle_kernel.h"
#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "core/simd/scalar.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

Plane occlusion_of_taps(const GrowingCircleParams& params, const filter::Surface& surface,
                        const filter::SampleGrid& grid, int screen_px, std::span<const Tap> taps,
                        const std::array<float, 16>& rotation_turns) {
  Plane out = Plane::for_overwrite(grid.width(), grid.height());
  for_rows(out.height(), [&](int y) {
    growing_circle_row(
        {GridSamples(grid), NormalSamples(surface), Lens(surface.projection), Samples(surface.depth), taps,
         params.radius_m, params.radius_m * surface.projection.fx, params.radius_m * surface.projection.fy,
         params.reach_screens * static_cast<float>(screen_px), params.bias, params.strength, rotation_turns,
         (surface.origin_x + grid.origin_x) / grid.step, (surface.origin_y + grid.origin_y) / grid.step, out.row(y)},
        y);
  });
  return out;
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::ao {

const params::Table& GrowingCircleParams::table() {
  using P = GrowingCircleParams;
  static const params::Table records =
      params::TableBuilder<P>()
          .add("resolution", &P::resolution, {"full", "half"},
               "Evaluate the AO at every pixel, or at one pixel of every 2x2 block.")
          .add("taps", &P::taps, {1, 1024}, "Taps per pixel, along the growing circle.")
          .add("growth", &P::growth, {"linear", "sqrt"},
               "How the circle grows from tap to tap: by equal steps of its radius, dense near the pixel, or of its "
               "area.")
          .add("radius_m", &P::radius_m, {1e-6, 1e6}, "Distance at which a surface no longer occludes.")
          .add("reach_screens", &P::reach_screens, {1e-4, 4},
               "Farthest that taps go from their pixel, as a share of the image's longer side.")
          .add("bias", &P::bias, {0, 1},
               "Sine of the angle above the surface below which nothing occludes, against self-occlusion.")
          .add("strength", &P::strength, {0, 100}, "Factor on the mean occlusion of the taps.")
          .add("pixel_rotation", &P::pixel_rotation,
               "Rotate the taps from pixel to pixel in a 4x4 pattern, which turns bands into grain for the blur.")
          .add("per_frame_noise", &P::per_frame_noise,
               "Rotate the taps anew every frame, for a temporal filter to average.")
          .add("normals", &P::normals, {"auto", "file", "depth"},
               "Where normals come from: the file if it has them and else the depth, the file only, or the depth only.")
          .build();
  return records;
}

namespace {

HWY_EXPORT(occlusion_of_taps);

double fraction(double x) { return x - std::floor(x); }

/// Turns from one tap to the next: the golden section of a turn, so that any number of taps surrounds the pixel evenly.
constexpr double kGoldenTurns = 0.3819660112501051;

std::vector<Tap> circle_taps(const GrowingCircleParams& params) {
  std::vector<Tap> taps;
  for (int i = 0; i < params.taps; ++i) {
    const double radius = (i + 0.5) / params.taps;
    const lanes::UnitVector direction = lanes::unit_vector(static_cast<float>(fraction(i * kGoldenTurns)));
    taps.push_back({static_cast<float>(params.growth == CircleGrowth::sqrt ? std::sqrt(radius) : radius), direction.x,
                    direction.y});
  }
  return taps;
}

/// Successive multiples of the golden ratio fill the circle evenly, whatever the number of frames.
std::array<float, 16> rotations(const GrowingCircleParams& params, int frame_number) {
  const double frame = params.per_frame_noise ? fraction(frame_number * 0.6180339887498949) : 0;
  std::array<float, 16> turns{};
  for (size_t i = 0; i < turns.size(); ++i)
    turns[i] = static_cast<float>(frame) + (params.pixel_rotation ? kBayer4x4[i] : 0.0F);
  return turns;
}

}  // namespace

Plane growing_circle(const GrowingCircleParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                     int screen_px, int frame_number) {
  return HWY_DYNAMIC_DISPATCH(occlusion_of_taps)(params, surface, grid, screen_px, circle_taps(params),
                                                 rotations(params, frame_number));
}

}  // namespace aftershade::ao
#endif
