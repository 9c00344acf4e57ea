#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/sample_grid.cpp"  // this file, compiled once a SIMD target
#include "core/filter/sample_grid.h"

#include <hwy/foreach_target.h>

#include "core/filter/sample_grid_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

void fill_full_grid(const Surface& surface, SampleGrid& grid) {
  for_rows(grid.height(),
           [&](int y) { surface_depth_row(surface.depth.row(y), surface.depth.width, grid.depth.row(y)); });
}

void fill_half_grid(const Surface& surface, SampleGrid& grid) {
  const auto normal = [&](size_t axis, int y) {
    return grid.normal[axis].empty() ? nullptr : grid.normal[axis].row(y);
  };
  for_rows(grid.height(), [&](int y) {
    half_grid_row({.depth = surface.depth,
                   .normals = NormalSamples(surface),
                   .origin_x = grid.origin_x,
                   .origin_y = grid.origin_y,
                   .block_x = surface.origin_x >> 1,
                   .block_y = (surface.origin_y >> 1) + y,
                   .width = grid.width(),
                   .out_depth = grid.depth.row(y),
                   .out_x = grid.pixel_x.row(y),
                   .out_y = grid.pixel_y.row(y),
                   .out_normal = {normal(0, y), normal(1, y), normal(2, y)}},
                  y);
  });
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::filter {

namespace {

HWY_EXPORT(fill_full_grid);
HWY_EXPORT(fill_half_grid);

int blocks(int origin, int size) { return size <= 0 ? 0 : ((origin + size - 1) >> 1) - (origin >> 1) + 1; }

}  // namespace

SampleGrid full_grid(const Surface& surface) {
  SampleGrid grid;
  grid.depth = Plane::for_overwrite(surface.depth.width, surface.depth.height);
  HWY_DYNAMIC_DISPATCH(fill_full_grid)(surface, grid);
  return grid;
}

SampleGrid half_grid(const Surface& surface) {
  const int width = blocks(surface.origin_x, surface.depth.width),
            height = blocks(surface.origin_y, surface.depth.height);
  SampleGrid grid{2,
                  -(surface.origin_x & 1),
                  -(surface.origin_y & 1),
                  Plane::for_overwrite(width, height),
                  Plane::for_overwrite(width, height),
                  Plane::for_overwrite(width, height)};
  if (!surface.nx.empty())
    for (Plane& axis : grid.normal) axis = Plane::for_overwrite(width, height);
  HWY_DYNAMIC_DISPATCH(fill_half_grid)(surface, grid);
  return grid;
}

Plane values_at_pixels(ConstPlaneView values, const SampleGrid& grid, const Surface& surface) {
  Plane out = Plane::for_overwrite(surface.depth.width, surface.depth.height);
  const int shift = grid.step == 2 ? 1 : 0;
  for_rows(out.height(), [&](int y) {
    const float* row = values.row((y - grid.origin_y) >> shift);
    for (int x = 0; x < out.width(); ++x) out(x, y) = row[(x - grid.origin_x) >> shift];
  });
  return out;
}

}  // namespace aftershade::filter
#endif
