#if defined(AFTERSHADE_CORE_FILTER_SAMPLE_GRID_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_SAMPLE_GRID_KERNEL_H
#undef AFTERSHADE_CORE_FILTER_SAMPLE_GRID_KERNEL_H
#else
#define AFTERSHADE_CORE_FILTER_SAMPLE_GRID_KERNEL_H
#endif
#include <algorithm>
#include <array>

#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

/// Depth, +inf on background.
inline void surface_depth_row(const float* depth, int width, float* out) {
  for (int x = 0; x < width; x += kLanes) {
    const Float z = load(depth + x);
    store(out + x, select(is_surface(z), z, HUGE_VALF));
  }
}

/// One row of the half grid.
struct HalfGridRow {
  ConstPlaneView depth;    ///< of the window
  NormalSamples normals;   ///< of the window
  int origin_x, origin_y;  ///< window index of block (0,0)'s first pixel
  int block_x;             ///< absolute number of the row's first block
  int block_y;             ///< and of the row itself
  int width;
  float *out_depth, *out_x, *out_y;
  std::array<float*, 3> out_normal;
};

/// The pixel taken so far of each block, and that being offered.
struct Pick {
  Float x, y;
  Float depth = HUGE_VALF;
  /// Depths that are no surface's are +inf.
  void offer(Mask nearest, Float pixel_x, float pixel_y, Float z) {
    const Mask better = (nearest & (z < depth)) | ((!nearest) & (z < HUGE_VALF) & ((z > depth) | (depth == HUGE_VALF)));
    x = select(better, pixel_x, x);
    y = select(better, pixel_y, y);
    depth = select(better, z, depth);
  }
};

/// Depths of the two pixels of each block in a row of the window, +inf where there is no surface or no pixel.
template <bool kInside>
Pairs block_depths(const HalfGridRow& row, int first_x, int y) {
  const float* z = row.depth.row(y);
  Pairs out;
  if constexpr (kInside) {
    out = load_pairs(z + first_x);
  } else {
    const Int left = (iota(0) << 1) + Int(first_x), right = left + Int(1), last = row.depth.width - 1;
    out.even = select(left >= Int(0), gather(z, clamp(left, 0, last)), HUGE_VALF);
    out.odd = select(right < Int(row.depth.width), gather(z, clamp(right, 0, last)), HUGE_VALF);
  }
  return {select(is_surface(out.even), out.even, HUGE_VALF), select(is_surface(out.odd), out.odd, HUGE_VALF)};
}

/// The normals of the picked pixels; the first that might have been picked are at (first_x, first_y).
template <bool kInside>
Point picked_normals(const HalfGridRow& row, const Pick& pick, int first_x, int first_y) {
  if constexpr (!kInside) return row.normals(row.normals.nx.clamp_x(to_int(pick.x)), to_int(pick.y));
  const int above = std::max(first_y, 0), below = std::min(first_y + 1, row.depth.height - 1);
  const Mask right = pick.x > to_float((iota(0) << 1) + Int(first_x)), lower = pick.y > static_cast<float>(above);
  const auto along = [&](const Samples& axis) {
    const Pairs a = load_pairs(axis.row(above) + first_x), b = load_pairs(axis.row(below) + first_x);
    return select(lower, select(right, b.odd, b.even), select(right, a.odd, a.even));
  };
  return finite_normal({along(row.normals.nx), along(row.normals.ny), along(row.normals.nz)});
}

/// The nearest or farthest surface of each block; its first pixel inside the window where there is only background.
template <bool kInside>
void half_grid_vector(const HalfGridRow& row, int block, int y) {
  const int first_x = row.origin_x + 2 * block, first_y = row.origin_y + 2 * y;
  const Mask nearest = ((iota(row.block_x + block) + Int(row.block_y)) & 1) == Int(0);
  const Float left = to_float((iota(0) << 1) + Int(first_x));
  Pick pick{max(left, 0.0F), static_cast<float>(std::max(first_y, 0))};
  for (int py = std::max(first_y, 0); py < std::min(first_y + 2, row.depth.height); ++py) {
    const Pairs z = block_depths<kInside>(row, first_x, py);
    pick.offer(nearest, left, static_cast<float>(py), z.even);
    pick.offer(nearest, left + 1.0F, static_cast<float>(py), z.odd);
  }
  store(row.out_depth + block, pick.depth);
  store(row.out_x + block, pick.x);
  store(row.out_y + block, pick.y);
  if (row.out_normal[0] == nullptr) return;
  const Point normal = picked_normals<kInside>(row, pick, first_x, first_y);
  store(row.out_normal[0] + block, normal.x);
  store(row.out_normal[1] + block, normal.y);
  store(row.out_normal[2] + block, normal.z);
}

inline void half_grid_row(const HalfGridRow& row, int y) {
  for (int block = 0; block < row.width; block += kLanes) {
    const int first_x = row.origin_x + 2 * block;
    if (first_x >= 0 && first_x + 2 * kLanes <= row.depth.width)
      half_grid_vector<true>(row, block, y);
    else
      half_grid_vector<false>(row, block, y);
  }
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
