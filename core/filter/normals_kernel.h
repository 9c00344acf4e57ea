#pragma once
#include "core/filter/lane_geometry.h"

namespace aftershade::filter {

struct NormalsRow {
  Samples depth;
  Lens lens;
  float fx, fy;
  float *nx, *ny, *nz;  ///< out
};

/// One side of a pixel along an axis: the depth next to it, and how badly the line through it misses the centre.
struct Side {
  Float z, miss;
};

/// 1 / z is linear across the image of a plane, in orthographic views z itself.
inline Float planar(const NormalsRow& row, Float z) { return row.lens.orthographic ? z : 1.0F / z; }

/// The side in direction (dx, dy). Without a second pixel the depth is taken to stay what it is at the first;
/// without a first, the miss is infinite.
inline Side side(const NormalsRow& row, Int x, Int y, Float z, int dx, int dy) {
  const auto depth_at = [&](int steps) {
    const Int tx = x + Int(dx * steps), ty = y + Int(dy * steps);
    return select(row.depth.contains(tx, ty), row.depth(row.depth.clamp_x(tx), row.depth.clamp_y(ty)), -1.0F);
  };
  const Float near = depth_at(1), far = depth_at(2);
  const Float a = planar(row, near), b = planar(row, far);
  const Float predicted = select(is_surface(far), 2.0F * a - b, a);
  return {near, select(is_surface(near), abs(predicted - planar(row, z)), HUGE_VALF)};
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
  for (int x0 = 0; x0 < row.depth.width; x0 += kLanes) {
    const Int x = iota(x0), iy = y;
    const Float z = load(row.depth.data + y * row.depth.stride + x0);
    const Slope sx = slope(row, z, side(row, x, iy, z, -1, 0), side(row, x, iy, z, 1, 0), row.fx);
    const Slope sy = slope(row, z, side(row, x, iy, z, 0, -1), side(row, x, iy, z, 0, 1), row.fy);
    const Float ray = row.lens.orthographic ? 0.0F : 1.0F;
    const Float u = (to_float(x) + 0.5F - row.lens.cx) * row.lens.inv_fx * ray;
    const Float v = -((to_float(iy) + 0.5F - row.lens.cy) * row.lens.inv_fy) * ray;
    const Point tx{u * sx.k + sx.q, v * sx.k, sx.k}, ty{u * sy.k, v * sy.k - sy.q, sy.k};
    const Point n{tx.y * ty.z - tx.z * ty.y, tx.z * ty.x - tx.x * ty.z, tx.x * ty.y - tx.y * ty.x};
    const Float length = sqrt(dot(n, n));
    const Mask valid = is_surface(z) & is_finite(length) & (length > 0.0F);
    store(row.nx + x0, select(valid, n.x / length, 0.0F));
    store(row.ny + x0, select(valid, n.y / length, 0.0F));
    store(row.nz + x0, select(valid, n.z / length, 0.0F));
  }
}

}  // namespace aftershade::filter
