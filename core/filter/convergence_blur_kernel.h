#if defined(AFTERSHADE_CORE_FILTER_CONVERGENCE_BLUR_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_CONVERGENCE_BLUR_KERNEL_H
#undef AFTERSHADE_CORE_FILTER_CONVERGENCE_BLUR_KERNEL_H
#else
#define AFTERSHADE_CORE_FILTER_CONVERGENCE_BLUR_KERNEL_H
#endif
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

/// One direction of the separable filter: taps at (x + t dx, y + t dy), |t| <= reach.
struct ConvergenceBlurRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  EdgeTolerance tolerance;
  Samples value, convergence;
  int dx, dy;
  int reach;     ///< ceil(radius)
  float radius;  ///< where nothing has converged
  float* out;
};

/// The mean is taken of differences from the centre, as in bilateral_blur_row; a texel counts by how much of it the
/// radius covers, so that the kernel shrinks without a jump. kInside: all taps lie in columns of the image.
template <bool kInside>
void convergence_blur_vector(const ConvergenceBlurRow& row, int x0, int y) {
  const Columns<kInside> x(x0, row.value.width);
  const Float own = x(row.value.row(y));
  const Float base = select(is_finite(own), own, 1.0F);
  const Point centre = row.grid.point(row.lens, x, y);
  const Mask here = is_surface(centre.z);
  const Float radius = row.radius * (1.0F - sat(x(row.convergence.row(y))));
  Float sum = 0.0F, weights = 0.0F;
  if (any(here)) {
    const Point normal = row.grid.normal(row.normals, x, y);
    const Float inv_tolerance = 1.0F / row.tolerance.at(centre.z);
    const Float sigma = (radius + 1.0F) * 0.5F, falloff = 0.5F / (sigma * sigma);
    for (int t = -row.reach; t <= row.reach; ++t) {
      const auto offset = static_cast<float>(t < 0 ? -t : t);
      const int ty = y + t * row.dy;
      if (ty < 0 || ty >= row.value.height) continue;
      const Columns<kInside> tx(x0 + t * row.dx, row.value.width);
      const Point point = row.grid.point(row.lens, tx, ty);
      const Float tap = tx(row.value.row(ty));
      Mask valid = here & is_surface(point.z) & is_finite(tap);
      if constexpr (!kInside) valid = valid & tx.inside;
      const Float d = plane_distance(point - centre, normal) * inv_tolerance;
      const Float share = sat(radius - offset + 1.0F) * sat(tx(row.convergence.row(ty)));
      const Float w = exp2(-(falloff * (offset * offset) + d * d)) * share;
      sum += select(valid, w * (tap - base), 0.0F);
      weights += select(valid, w, 0.0F);
    }
  }
  store(row.out + x0, base + select(weights > 0.0F, sum / weights, 0.0F));
}

inline void convergence_blur_row(const ConvergenceBlurRow& row, int y) {
  const int across = row.dx * row.reach;
  for_each_vector(row.value.width, across, across,
                  [&](int x0, auto inside) { convergence_blur_vector<decltype(inside)::value>(row, x0, y); });
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
