#if defined(AFTERSHADE_CORE_FILTER_NORMALS_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_NORMALS_KERNEL_H
#undef AFTERSHADE_CORE_FILTER_NORMALS_KERNEL_H
#else
#define AFTERSHADE_CORE_FILTER_NORMALS_KERNEL_H
#endif
#include <array>

#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

/// A row of depth with kBorder pixels more at both sides, and what is linear in it across the image of a plane: 1 / z,
/// in orthographic views z itself.
struct PlanarRow {
  const float *z, *planar;
};
inline constexpr int kBorder = 2;
inline constexpr float kOutside = -1.0F;  ///< the depth of what lies outside the image

/// From the first pixel of the padded row on; `depth` null: outside the image.
inline void planar_row(const float* depth, int width, bool orthographic, float* z, float* planar) {
  if (depth != nullptr)
    for (int x = 0; x < width; x += kLanes) store(z + kBorder + x, load(depth + x));
  else
    std::fill_n(z + kBorder, width, kOutside);
  std::fill_n(z, kBorder, kOutside);
  std::fill_n(z + kBorder + width, kBorder, kOutside);
  for (int x = 0; x < width + 2 * kBorder; x += kLanes)
    store(planar + x, orthographic ? load(z + x) : 1.0F / load(z + x));
}

struct NormalsRow {
  std::array<PlanarRow, 2 * kBorder + 1> rows;  ///< at their first pixels inside; those of y - 2 to y + 2
  Lens lens;
  float fx, fy;
  int width;
  float *nx, *ny, *nz;  ///< out
};

/// One side of a pixel along an axis: the depth next to it, and how badly the line through it misses the centre.
struct Side {
  Float z, miss;
};

/// The side in direction (dx, dy). Without a second pixel the depth is taken to stay what it is at the first;
/// without a first, the miss is infinite.
inline Side side(const NormalsRow& row, int x0, Float planar, int dx, int dy) {
  const PlanarRow& first = row.rows[static_cast<size_t>(kBorder + dy)];
  const PlanarRow& second = row.rows[static_cast<size_t>(kBorder + 2 * dy)];
  const Float near = load(first.z + x0 + dx), far = load(second.z + x0 + 2 * dx);
  const Float a = load(first.planar + x0 + dx), b = load(second.planar + x0 + 2 * dx);
  const Float predicted = select(is_surface(far), 2.0F * a - b, a);
  return {near, select(is_surface(near), abs(predicted - planar), HUGE_VALF)};
}

/// Depth slope k and depth ratio q toward the better side, for a step of +1 pixel: k = f (z(+1) - z) / z, q = z(+1) / z
/// (perspective), k = f (z(+1) - z), q = 1 (orthographic). Without any side: k = 0, a surface that faces the camera.
struct Slope {
  Float k, q;
};
inline Slope slope(const NormalsRow& row, Float z, Side minus, Side plus, float f) {
  const Mask take_minus = minus.miss <= plus.miss;
  const Float best = select(take_minus, minus.miss, plus.miss);
  const Float other = select(take_minus, minus.z, plus.z);
  const Float scale = row.lens.orthographic ? Float(1.0F) : z;
  const Float step = select(take_minus, z - other, other - z) / scale * f;
  const Mask known = is_finite(best);
  return {select(known, step, 0.0F), row.lens.orthographic ? Float(1.0F) : select(known, other / z, 1.0F)};
}

/// n = dP/dx x dP/dy, the tangents in units of a pixel's footprint at z, (u, v, 1) the ray of the pixel:
///   dP/dx = (u kx + qx, v kx, kx),  dP/dy = (u ky, v ky - qy, ky)
/// which faces the camera for every visible surface.
inline void normals_row(const NormalsRow& row, int y) {
  const PlanarRow& own = row.rows[kBorder];
  const float ray = row.lens.orthographic ? 0.0F : 1.0F;
  const Float v = -((Float(static_cast<float>(y)) + 0.5F - row.lens.cy) * row.lens.inv_fy) * ray;
  for (int x0 = 0; x0 < row.width; x0 += kLanes) {
    const Float z = load(own.z + x0), planar = load(own.planar + x0);
    const Slope sx = slope(row, z, side(row, x0, planar, -1, 0), side(row, x0, planar, 1, 0), row.fx);
    const Slope sy = slope(row, z, side(row, x0, planar, 0, -1), side(row, x0, planar, 0, 1), row.fy);
    const Float u = (to_float(iota(x0)) + 0.5F - row.lens.cx) * row.lens.inv_fx * ray;
    const Point tx{u * sx.k + sx.q, v * sx.k, sx.k}, ty{u * sy.k, v * sy.k - sy.q, sy.k};
    const Point n{tx.y * ty.z - tx.z * ty.y, tx.z * ty.x - tx.x * ty.z, tx.x * ty.y - tx.y * ty.x};
    const Float length = sqrt(dot(n, n));
    const Mask valid = is_surface(z) & is_finite(length) & (length > 0.0F);
    store(row.nx + x0, select(valid, n.x / length, 0.0F));
    store(row.ny + x0, select(valid, n.y / length, 0.0F));
    store(row.nz + x0, select(valid, n.z / length, 0.0F));
  }
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
