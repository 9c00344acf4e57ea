#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ao/scalable_ao.cpp"  // this file, compiled once a SIMD target
#include "core/ao/scalable_ao.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/ao/scalable_ao_kernel.h"
#include "core/ao/tap_pattern.h"
#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "core/simd/scalar.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

/// By the lowest two bits of a texel's absolute row; `texel_x`: absolute column of the grid's first. `turns` is added
/// to every texel's rotation, a mirrored pattern repeats after half a turn.
std::array<DirectionTable, 4> direction_tables(std::span<const Tap> taps, TapPattern pattern, float turns,
                                               int texel_x) {
  const float share = pattern == TapPattern::mirrored ? 0.5F : 1.0F;
  std::array<DirectionTable, 4> tables;
  for (size_t row = 0; row < 4; ++row)
    for (const Tap& tap : taps)
      for (int column = 0; column < DirectionTable::kColumns; ++column) {
        const auto cell = 4 * row + static_cast<size_t>((texel_x + column) & 3);
        const lanes::UnitVector rotation = lanes::unit_vector(kBayer4x4[cell] * share + turns);
        tables[row].x.push_back(tap.x * rotation.x - tap.y * rotation.y);
        tables[row].y.push_back(tap.x * rotation.y + tap.y * rotation.x);
      }
  return tables;
}

std::vector<float> tap_falloffs(std::span<const Tap> taps, DistanceFalloff kind) {
  alignas(64) std::array<float, kLanes> lanes;
  std::vector<float> out;
  for (const Tap& tap : taps) {
    store(lanes.data(), distance_falloff(kind, tap.radius));
    out.push_back(lanes[0]);
  }
  return out;
}

Plane one_pass(const ScalableAoParams& params, const filter::Surface& surface, const filter::DepthPyramid& pyramid,
               const filter::SampleGrid& grid, float turns) {
  const auto taps = params.pattern == TapPattern::mirrored ? mirrored_taps(params.taps) : spiral_taps(params.taps);
  const auto falloffs = tap_falloffs(taps, params.falloff);
  const float clamp_px = filter::scaled_px(params.max_radius_px, params.reference_height_px, surface.display_height);
  const int texel_x = (surface.origin_x + grid.origin_x) / grid.step,
            texel_y = (surface.origin_y + grid.origin_y) / grid.step;
  const auto directions = direction_tables(taps, params.pattern, turns, texel_x);
  const DepthLevels levels = depth_levels(pyramid, params.depth_mips);
  Plane out = Plane::for_overwrite(grid.width(), grid.height());
  for_rows(out.height(), [&](int y) {
    scalable_ao_row({.grid = GridSamples(grid),
                     .normals = NormalSamples(surface),
                     .lens = Lens(surface.projection),
                     .depth = levels,
                     .taps = taps,
                     .tap_falloffs = falloffs,
                     .directions = directions[static_cast<size_t>((texel_y + y) & 3)],
                     .params = params,
                     .radius_px_x = params.radius_m * surface.projection.fx,
                     .radius_px_y = params.radius_m * surface.projection.fy,
                     .max_radius_px = params.max_radius_px > 0 ? clamp_px : std::numeric_limits<float>::infinity(),
                     .out = out.row(y)},
                    y);
  });
  return out;
}

void add_pass(ConstPlaneView pass, Plane& sum) {
  for_rows(sum.height(), [&](int y) { add_row(pass.row(y), sum.width(), sum.row(y)); });
}

void divide(int passes, Plane& sum) {
  for_rows(sum.height(), [&](int y) { divide_row(static_cast<float>(passes), sum.width(), sum.row(y)); });
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::ao {

const params::Table& ScalableAoParams::table() {
  using P = ScalableAoParams;
  static const params::Table records =
      params::TableBuilder<P>()
          .add("resolution", &P::resolution, {"full", "half"},
               "Evaluate the AO at every pixel, or at one pixel of every 2x2 block.")
          .add("pattern", &P::pattern, {"mirrored", "spiral"},
               "Taps in opposite pairs (current-gen), or along a spiral over the whole circle (DX11).")
          .add("taps", &P::taps, {1, 1024}, "Taps per pixel; the mirrored pattern rounds an odd count up.")
          .add("radius_m", &P::radius_m, {1e-6, 1e6}, "Distance at which a surface no longer occludes.")
          .add(
              "max_radius_px", &P::max_radius_px, {0, 65536},
              "Largest projected radius at the reference height, beyond which the radius is shortened; 0 for no limit.")
          .add("reference_height_px", &P::reference_height_px, {1, 65536},
               "Image height at which max_radius_px is meant; at other heights it scales with the height.")
          .add("radius_clamp", &P::radius_clamp, {"radius", "taps"},
               "What max_radius_px shortens: the radius with its falloff, or only how far taps reach, which keeps more "
               "occlusion but outlines near objects.")
          .add("falloff", &P::falloff, {"linear", "quadratic", "cubic", "none"},
               "How occlusion falls with the distance d in radii: 1 - d (the talk's), 1 - d^2, (1 - d^2)^3, or not "
               "until "
               "the radius.")
          .add("bias", &P::bias, {0, 1},
               "Sine of the angle above the surface below which nothing occludes, against self-occlusion.")
          .add("bias_m", &P::bias_m, {0, 1e6},
               "Height above the surface below which nothing occludes: the bias as the talk's text has it.")
          .add("scale", &P::scale, {0, 100}, "Strength of the occlusion before it is squared.")
          .add("squared", &P::squared, "Square the occlusion, as the talk does: contact shadows are emphasised.")
          .add("passes", &P::passes, {1, 1024},
               "Runs with different rotations of the taps, averaged: less noise, as bright.")
          .add("depth_mips", &P::depth_mips, "Let taps far from their pixel read reduced depth, which is faster.")
          .add("normals", &P::normals, {"auto", "file", "depth"},
               "Where normals come from: the file if it has them and else the depth, the file only, or the depth only.")
          .add("per_frame_noise", &P::per_frame_noise,
               "Rotate the taps anew every frame, for a temporal filter to average.")
          .build();
  return records;
}

namespace {

HWY_EXPORT(one_pass);
HWY_EXPORT(add_pass);
HWY_EXPORT(divide);

/// Successive multiples of the golden ratio fill the circle evenly, whatever the number of passes and frames.
float noise_turns(const ScalableAoParams& params, int frame_number, int pass) {
  const double seed = (params.per_frame_noise ? static_cast<double>(frame_number) * params.passes : 0.0) + pass;
  const double turns = seed * 0.6180339887498949;
  return static_cast<float>(turns - std::floor(turns));
}

}  // namespace

Plane scalable_ao(const ScalableAoParams& params, const filter::Surface& surface, const filter::DepthPyramid& pyramid,
                  const filter::SampleGrid& grid, int frame_number) {
  const auto pass = [&](int i) {
    return HWY_DYNAMIC_DISPATCH(one_pass)(params, surface, pyramid, grid, noise_turns(params, frame_number, i));
  };
  Plane out = pass(0);
  for (int i = 1; i < params.passes; ++i) HWY_DYNAMIC_DISPATCH(add_pass)(pass(i), out);
  if (params.passes > 1) HWY_DYNAMIC_DISPATCH(divide)(params.passes, out);
  return out;
}

}  // namespace aftershade::ao
#endif
