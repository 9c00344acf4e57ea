#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ao/hbao.cpp"  // this file, compiled once a SIMD target
#include "core/ao/hbao.h"

#include <hwy/foreach_target.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/ao/dual_resolution_kernel.h"
#include "core/ao/hbao_kernel.h"
#include "core/filter/bilateral_upsample.h"
#include "core/math/sampling.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

/// Evaluates the texels that `wanted` (of the grid's size; empty: all) marks.
void evaluate(const HbaoParams& params, const HbaoPattern& pattern, float max_reach_px, const filter::Surface& surface,
              const filter::SampleGrid& grid, ConstPlaneView wanted, Plane& out) {
  const Projection& lens = surface.projection;
  const auto bias = static_cast<float>(std::tan(static_cast<double>(params.bias_deg) * std::numbers::pi / 180));
  for_rows(out.height(), [&](int y) {
    hbao_row({.grid = GridSamples(grid),
              .normals = NormalSamples(surface),
              .lens = Lens(lens),
              .depth = Samples(surface.depth),
              .params = params,
              .pattern = pattern,
              .texel_px = grid.step,
              .aspect = lens.fx / lens.fy,
              .radius_px = params.radius_m * lens.fy / static_cast<float>(grid.step),
              .max_reach_px = max_reach_px,
              .inv_radius2 = 1.0F / (params.radius_m * params.radius_m),
              .tan_bias = bias,
              .texel_x = (surface.origin_x + grid.origin_x) / grid.step,
              .texel_y = (surface.origin_y + grid.origin_y) / grid.step,
              .wanted = wanted.empty() ? nullptr : wanted.row(y),
              .out = out.row(y)},
             y);
  });
}

Plane unrepresented(const HbaoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid) {
  Plane out = Plane::for_overwrite(surface.depth.width, surface.depth.height);
  for_rows(out.height(), [&](int y) {
    unrepresented_row(
        {.grid = GridSamples(grid),
         .normals = NormalSamples(surface),
         .lens = Lens(surface.projection),
         .tolerance = EdgeTolerance(params.edge_distance_m, params.edge_footprints, 2, surface.projection),
         .depth = Samples(surface.depth),
         .origin_x = grid.origin_x,
         .origin_y = grid.origin_y,
         .below = params.refine_below,
         .out = out.row(y)},
        y);
  });
  return out;
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::ao {

const params::Table& HbaoParams::table() {
  using P = HbaoParams;
  static const params::Table records =
      params::TableBuilder<P>()
          .add("resolution", &P::resolution, {"full", "half", "dual"},
               "Evaluate the AO at every pixel, at one pixel of every 2x2 block, or so and again at every pixel that "
               "those blocks do not represent.")
          .add("directions", &P::directions, {1, 1024}, "Directions around each pixel.")
          .add("steps", &P::steps, {1, 1024}, "Taps along each direction.")
          .add("radius_m", &P::radius_m, {1e-6, 1e6}, "Distance at which a surface no longer occludes.")
          .add("bias_deg", &P::bias_deg, {0, 89},
               "Angle above the surface's tangent below which nothing occludes, against self-occlusion.")
          .add("strength", &P::strength, {0, 100}, "Factor of the occlusion.")
          .add("power_exponent", &P::power_exponent, {0.01, 100}, "Exponent of the AO: above 1 is darker.")
          .add("max_footprint", &P::max_footprint, {0, 1},
               "Farthest reach of the taps in the picture, as a share of its height; 0 for no limit.")
          .add("tangents", &P::tangents, {"shorter-difference", "normals"},
               "Take the surface's tangents from the nearer neighbour on each axis, as Battlefield 3 does, or from "
               "normals.")
          .add("normals", &P::normals, {"auto", "file", "depth"},
               "Where normals come from: the file if it has them and else the depth, the file only, or the depth only.")
          .add("border", &P::border, {"clamp", "open", "renormalise"},
               "Taps outside the image see the depth at the border, do not occlude, or are made up for by directions "
               "that stay inside.")
          .add("literal", &P::literal,
               "Round the step instead of each tap, measure all but the first tap of a direction from one tangent, and "
               "count half of max_footprint in texels at any resolution, as the SDK's shader does; slopes occlude "
               "themselves a little.")
          .add("per_frame_noise", &P::per_frame_noise,
               "Turn and shift the taps anew every frame, for a temporal filter to average.")
          .add("refine_below", &P::refine_below, {0, 1},
               "At dual resolution, pixels are evaluated again where a smaller share of the texels around lies on "
               "their surface.")
          .add("edge_distance_m", &P::edge_distance_m, {0, 1000},
               "At dual resolution, distance from a pixel's tangent plane at which a texel's share has fallen to a "
               "half.")
          .add("edge_footprints", &P::edge_footprints, {0.1, 100},
               "At dual resolution, the same distance in texel footprints at the pixel's depth; the larger counts.")
          .build();
  return records;
}

HbaoPattern hbao_pattern() {
  HbaoPattern pattern{kBayer4x4, {}};
  for (size_t cell = 0; cell < 16; ++cell) {
    const size_t x0 = cell & 1, x1 = (cell >> 1) & 1, y0 = (cell >> 2) & 1, y1 = cell >> 3;
    const size_t order = (x0 ^ x1) << 3 | (y0 ^ y1) << 2 | x0 << 1 | y0;
    pattern.shift[cell] = (static_cast<float>(order) + 0.5F) / 16.0F;
  }
  return pattern;
}

namespace {

HWY_EXPORT(evaluate);
HWY_EXPORT(unrepresented);

/// The pattern of one frame: with per-frame noise shifted by the R2 sequence (M. Roberts), powers of the reciprocal
/// plastic number, which fills the square evenly whatever the number of frames.
HbaoPattern pattern_of(const HbaoParams& params, int frame_number) {
  HbaoPattern pattern = hbao_pattern();
  if (!params.per_frame_noise) return pattern;
  const auto shift_all = [&](std::array<float, 16>& values, double rate) {
    for (float& value : values) {
      const double moved = static_cast<double>(value) + rate * frame_number;
      value = static_cast<float>(moved - std::floor(moved));
    }
  };
  shift_all(pattern.rotation, 0.7548776662466927);
  shift_all(pattern.shift, 0.5698402909980532);
  return pattern;
}

float max_reach_px(const HbaoParams& params, const filter::Surface& surface, int step) {
  if (params.max_footprint == 0) return std::numeric_limits<float>::infinity();
  const float texels_per_height = static_cast<float>(surface.display_height) / static_cast<float>(step);
  return params.max_footprint * texels_per_height;
}

Plane evaluated(const HbaoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                int frame_number, ConstPlaneView wanted, Plane out) {
  HWY_DYNAMIC_DISPATCH(evaluate)
  (params, pattern_of(params, frame_number), max_reach_px(params, surface, params.literal ? 2 : grid.step), surface,
   grid, wanted, out);
  return out;
}

}  // namespace

Plane hbao(const HbaoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid, int frame_number) {
  return evaluated(params, surface, grid, frame_number, {}, Plane::for_overwrite(grid.width(), grid.height()));
}

Plane dual_resolution_hbao(const HbaoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                           int frame_number) {
  const filter::BilateralUpsampleParams upsampling{params.edge_distance_m, params.edge_footprints};
  const Plane wanted = HWY_DYNAMIC_DISPATCH(unrepresented)(params, surface, grid);
  Plane coarse = filter::bilateral_upsample(upsampling, hbao(params, surface, grid, frame_number), grid, surface);
  return evaluated(params, surface, filter::full_grid(surface), frame_number, wanted, std::move(coarse));
}

}  // namespace aftershade::ao
#endif
