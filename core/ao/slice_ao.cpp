#include "core/ao/slice_ao.h"

#include <array>
#include <cmath>
#include <vector>

#include "core/ao/pixel_filter.h"
#include "core/ao/slice_ao_kernel.h"
#include "core/ao/thickness.h"
#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "core/simd/scalar.h"

namespace aftershade::ao {

const params::Table& SliceAoParams::table() {
  using P = SliceAoParams;
  static const params::Table records = [] {
    params::TableBuilder<P> table;
    table
        .add("resolution", &P::resolution, {"full", "half"},
             "Evaluate the AO at every pixel, or at one pixel of every 2x2 block.")
        .add("slices", &P::slices, {1, 1024}, "Planes through the pixel's ray that are searched, each to both sides.")
        .add("steps", &P::steps, {0, 65536},
             "Samples to each side of a slice, every pixel near and wider apart far away; 0 for every pixel.")
        .add("radius_m", &P::radius_m, {1e-6, 1e6}, "Distance at which a surface no longer occludes.")
        .add("pixel_filter_px", &P::pixel_filter_px, {0, 16},
             "Standard deviation of the pixel filter that rendered images have and values at pixel centres lack; 0 for "
             "none.");
    add_depth_geometry(table);
    table.add("per_frame_noise", &P::per_frame_noise, "Turn the slices every frame, for a temporal filter to average.");
    return table.build();
  }();
  return records;
}

namespace {

/// Half a turn in `count` parts, shifted by 16ths of a part from pixel to pixel of a 4x4 block. Successive multiples of
/// the golden ratio turn the whole pattern from frame to frame.
std::vector<slice::Direction> directions(int count, bool per_frame, int frame_number) {
  const double noise = per_frame ? frame_number * 0.6180339887498949 : 0;
  std::vector<slice::Direction> out;
  for (const float shift : kBayer4x4)
    for (int k = 0; k < count; ++k) {
      const double turns = 0.5 * (k + static_cast<double>(shift) + noise - std::floor(noise)) / count;
      const lanes::UnitVector direction = lanes::unit_vector(static_cast<float>(turns));
      out.push_back({direction.x, direction.y});
    }
  return out;
}

/// Sample offsets in another order than the turns.
std::array<float, 16> sample_offsets() {
  std::array<float, 16> out{};
  for (size_t i = 0; i < 16; ++i) out[i] = kBayer4x4[(5 * i + 3) % 16];
  return out;
}

}  // namespace

Plane slice_ao(const SliceAoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
               int frame_number, ConstPlaneView depth2) {
  const Projection& lens = surface.projection;
  const Plane thickness = planar_thickness(params, surface.depth, lens);
  const Plane thickness2 = depth2.empty() ? Plane() : planar_thickness(params, depth2, lens);
  const auto turns = directions(params.slices, params.per_frame_noise, frame_number);
  const auto offsets = sample_offsets();
  const slice::Slices slices{depth_view(params, surface, thickness, depth2, thickness2),
                             params.radius_m,
                             params.steps,
                             params.slices,
                             turns,
                             offsets};
  const int texel_x = (surface.origin_x + grid.origin_x) / grid.step,
            texel_y = (surface.origin_y + grid.origin_y) / grid.step;
  Plane out(grid.width(), grid.height(), 1.0F);
  for_rows(out.height(), [&](int y) {
    std::vector<slice::Interval> list;
    for (int x = 0; x < out.width(); ++x) {
      if (!is_surface(grid.depth(x, y))) continue;
      const int px = grid.step == 1 ? x : static_cast<int>(grid.pixel_x(x, y));
      const int py = grid.step == 1 ? y : static_cast<int>(grid.pixel_y(x, y));
      const int cell = ((y + texel_y) & 3) * 4 + ((x + texel_x) & 3);
      out(x, y) = slice::visibility(slices, slices.view.receiver(px, py), cell, list);
    }
  });
  if (!(params.pixel_filter_px > 0)) return out;
  return pixel_filtered(out, grid.depth, params.pixel_filter_px / static_cast<float>(grid.step));
}

}  // namespace aftershade::ao
