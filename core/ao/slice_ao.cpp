#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/ao/slice_ao.cpp"  // this file, compiled once a SIMD target
#include "core/ao/slice_ao.h"

#include <hwy/foreach_target.h>

#include "core/ao/pixel_filter.h"
#include "core/ao/slice_ao_kernel.h"
#include "core/ao/thickness.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

Plane slices_of_plane(const SliceAoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                      const filter::DepthPyramid& pyramid, const SliceTurns& turns, ConstPlaneView thickness,
                      ConstPlaneView depth2, ConstPlaneView thickness2) {
  const DepthLevels depth = depth_levels(pyramid, params.depth_mips);
  const auto border = params.border == Border::extend ? border_planes(surface) : std::vector<BorderPlane>();
  Plane out = Plane::for_overwrite(grid.width(), grid.height());
  for_rows(out.height(), [&](int y) {
    std::array<Intervals, 2> lists;
    slice_ao_row({.grid = GridSamples(grid),
                  .nx = Samples(surface.nx),
                  .ny = Samples(surface.ny),
                  .nz = Samples(surface.nz),
                  .lens = Lens(surface.projection),
                  .fx = surface.projection.fx,
                  .fy = surface.projection.fy,
                  .depth = depth,
                  .thickness = Samples(thickness),
                  .border = border,
                  .depth2 = Samples(depth2),
                  .thickness2 = Samples(thickness2),
                  .params = params,
                  .turns = turns,
                  .texel_x = (surface.origin_x + grid.origin_x) / grid.step,
                  .texel_y = (surface.origin_y + grid.origin_y) / grid.step,
                  .lists = lists,
                  .out = out.row(y)},
                 y);
  });
  return out;
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
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
        .add("noise_tile", &P::noise_tile, {"4x4", "3x3"},
             "Block of pixels after which the turns of the slices repeat: a filter of that size takes their pattern "
             "away.")
        .add("depth_mips", &P::depth_mips, "Let samples far from their pixel read reduced depth, which is faster.")
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
HWY_EXPORT(slices_of_plane);
}

Plane slice_ao(const SliceAoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
               int frame_number, ConstPlaneView depth2) {
  const bool measured = params.thickness == ThicknessModel::width;
  const auto thickness_of = [&](ConstPlaneView depth) {
    return measured && !depth.empty() ? planar_thickness(params, depth, surface.projection) : Plane();
  };
  const Plane thickness = thickness_of(surface.depth), thickness2 = thickness_of(depth2);
  // Successive multiples of the golden ratio turn the whole pattern from frame to frame.
  const SliceTurns turns(params.noise_tile, params.slices,
                         params.per_frame_noise ? frame_number * 0.6180339887498949 : 0);
  const filter::DepthPyramid pyramid(surface.depth, params.depth_mips ? filter::kDepthLevels : 1,
                                     surface.origin_x, surface.origin_y);
  Plane out =
      HWY_DYNAMIC_DISPATCH(slices_of_plane)(params, surface, grid, pyramid, turns, thickness, depth2, thickness2);
  if (!(params.pixel_filter_px > 0)) return out;
  return pixel_filtered(out, grid.depth, params.pixel_filter_px / static_cast<float>(grid.step));
}

}  // namespace aftershade::ao
#endif
