#if defined(AFTERSHADE_CORE_AO_DUAL_RESOLUTION_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_DUAL_RESOLUTION_KERNEL_H
#undef AFTERSHADE_CORE_AO_DUAL_RESOLUTION_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_DUAL_RESOLUTION_KERNEL_H
#endif
#include "core/filter/bilateral_upsample_kernel.h"
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

struct RepresentedRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  EdgeTolerance tolerance;
  Samples depth;
  int origin_x, origin_y;  ///< window index of block (0,0)'s first pixel
  float below;
  float* out;  ///< 1 where the pixel is a surface and less than `below` of the texels around it lie on it, else 0
};

/// The share of the 3x3 texels around that lie on the pixel's tangent plane, weighted as the upsampling weighs them.
inline Float represented_share(const RepresentedRow& row, Int x, Int y, Float z) {
  const Point centre = unproject(row.lens, to_float(x), to_float(y), z), normal = row.normals(x, y);
  const Float inv_tolerance = 1.0F / row.tolerance.at(z);
  Float on_surface = 0.0F, all = 0.0F;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) {
      const Int tx = ((x - Int(row.origin_x)) >> 1) + Int(i), ty = ((y - Int(row.origin_y)) >> 1) + Int(j);
      const Int sx = row.grid.depth.clamp_x(tx), sy = row.grid.depth.clamp_y(ty);
      const Point point = row.grid.point(row.lens, sx, sy);
      const Float d = plane_distance(point - centre, normal) * inv_tolerance;
      const Float f = tent(row.grid.x_of(sx, sy) - to_float(x)) * tent(row.grid.y_of(sx, sy) - to_float(y));
      const Float weight = select(row.grid.depth.contains(tx, ty), f, 0.0F);
      all += weight;
      on_surface += select(is_surface(point.z), weight * exp2(-(d * d)), 0.0F);
    }
  return on_surface / all;
}

inline void unrepresented_row(const RepresentedRow& row, int y) {
  for (int x0 = 0; x0 < row.depth.width; x0 += kLanes) {
    const Int x = row.depth.clamp_x(iota(x0)), iy = y;
    const Float z = row.depth(x, iy);
    const Mask refine = is_surface(z) & !(represented_share(row, x, iy, z) >= row.below);
    store(row.out + x0, select(refine, Float(1.0F), Float(0.0F)));
  }
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
