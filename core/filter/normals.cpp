#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/normals.cpp"  // this file, compiled once a SIMD target
#include "core/filter/normals.h"

#include <hwy/foreach_target.h>

#include <algorithm>

#include "core/filter/normals_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

/// Rows y0 to y1 - 1, each of whose five rows of depth is prepared once.
void fill_normals(ConstPlaneView depth, const Projection& projection, int y0, int y1, Normals& out) {
  const int padded = depth.width + 2 * kBorder, prepared = y1 - y0 + 2 * kBorder;
  Plane z = Plane::for_overwrite(padded, prepared), planar = Plane::for_overwrite(padded, prepared);
  for (int i = 0; i < prepared; ++i) {
    const int y = y0 - kBorder + i;
    const float* row = y >= 0 && y < depth.height ? depth.row(y) : nullptr;
    planar_row(row, depth.width, projection.orthographic, z.row(i), planar.row(i));
  }
  for (int y = y0; y < y1; ++y) {
    NormalsRow row{{}, Lens(projection), projection.fx, projection.fy, depth.width, {}, {}, {}};
    for (int i = 0; i < 2 * kBorder + 1; ++i)
      row.rows[static_cast<size_t>(i)] = {z.row(y - y0 + i) + kBorder, planar.row(y - y0 + i) + kBorder};
    row.nx = out[0].row(y);
    row.ny = out[1].row(y);
    row.nz = out[2].row(y);
    normals_row(row, y);
  }
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::filter {

namespace {
HWY_EXPORT(fill_normals);
}  // namespace

Normals normals_from_depth(ConstPlaneView depth, const Projection& projection) {
  constexpr int kRows = 16;  // prepared and worked on while they are in the cache
  Normals out;
  for (Plane& plane : out) plane = Plane::for_overwrite(depth.width, depth.height);
  const auto fill = HWY_DYNAMIC_DISPATCH(fill_normals);
  for_rows((depth.height + kRows - 1) / kRows,
           [&](int band) { fill(depth, projection, band * kRows, std::min((band + 1) * kRows, depth.height), out); });
  return out;
}

}  // namespace aftershade::filter
#endif
