#include "core/ao/reference_ao.h"

#include <array>
#include <cmath>
#include <vector>

#include "core/ao/pixel_filter.h"
#include "core/ao/reference_ao_kernel.h"
#include "core/ao/thickness.h"
#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "core/simd/scalar.h"

namespace aftershade::ao {

const params::Table& ReferenceAoParams::table() {
  using P = ReferenceAoParams;
  static const params::Table records = [] {
    params::TableBuilder<P> table;
    table
        .add("resolution", &P::resolution, {"full", "half"},
             "Evaluate the AO at every pixel, or at one pixel of every 2x2 block.")
        .add("rays", &P::rays, {1, 1048576}, "Rays followed from each pixel, over the hemisphere about its normal.")
        .add("radius_m", &P::radius_m, {1e-6, 1e6}, "Distance at which a surface no longer occludes.")
        .add("weighting", &P::weighting, {"cosine", "uniform"},
             "How directions count: by the cosine from the normal as light does, or all alike.")
        .add("falloff", &P::falloff, {"hard", "squared"},
             "How much a surface within the radius occludes: fully, or 1 - (r/R)^2 at distance r.")
        .add("pixel_filter_px", &P::pixel_filter_px, {0, 16},
             "Standard deviation of the pixel filter that rendered images have and values at pixel centres lack; 0 for "
             "none.");
    add_depth_geometry(table);
    return table.build();
  }();
  return records;
}

namespace {

/// A spiral by the golden angle over the hemisphere, its strata equal in weight.
std::vector<march::Direction> hemisphere(int rays, RayWeighting weighting) {
  std::vector<march::Direction> out;
  for (int i = 0; i < rays; ++i) {
    const double u = (i + 0.5) / rays, turns = i * 0.6180339887498949;
    const double height = weighting == RayWeighting::cosine ? std::sqrt(1 - u) : 1 - u;
    const auto across = static_cast<float>(std::sqrt(1 - height * height));
    const lanes::UnitVector azimuth = lanes::unit_vector(static_cast<float>(turns - std::floor(turns)));
    out.push_back({across * azimuth.x, across * azimuth.y, static_cast<float>(height)});
  }
  return out;
}

/// Turns of the hemisphere, one of 256 by the pixel's absolute coordinates.
std::array<lanes::UnitVector, 256> pixel_turns() {
  std::array<lanes::UnitVector, 256> out{};
  for (size_t i = 0; i < out.size(); ++i) out[i] = lanes::unit_vector(static_cast<float>(i) / 256);
  return out;
}

}  // namespace

Plane reference_ao(const ReferenceAoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                   ConstPlaneView depth2) {
  const Projection& lens = surface.projection;
  const Plane thickness = planar_thickness(params, surface.depth, lens);
  const Plane thickness2 = depth2.empty() ? Plane() : planar_thickness(params, depth2, lens);
  const auto directions = hemisphere(params.rays, params.weighting);
  const auto turns = pixel_turns();
  const march::Rays rays{depth_view(params, surface, thickness, depth2, thickness2), params.radius_m,
                         params.falloff == RayFalloff::squared, directions};
  Plane out(grid.width(), grid.height(), 1.0F);
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x) {
      if (!is_surface(grid.depth(x, y))) continue;
      const int px = grid.step == 1 ? x : static_cast<int>(grid.pixel_x(x, y));
      const int py = grid.step == 1 ? y : static_cast<int>(grid.pixel_y(x, y));
      const uint32_t turn =
          hash_counters(static_cast<uint32_t>(px + surface.origin_x), static_cast<uint32_t>(py + surface.origin_y)) &
          255;
      out(x, y) = march::visibility(rays, rays.view.receiver(px, py), turns[turn].x, turns[turn].y);
    }
  });
  if (!(params.pixel_filter_px > 0)) return out;
  return pixel_filtered(out, grid.depth, params.pixel_filter_px / static_cast<float>(grid.step));
}

}  // namespace aftershade::ao
