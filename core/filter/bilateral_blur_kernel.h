#if defined(AFTERSHADE_CORE_FILTER_BILATERAL_BLUR_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_FILTER_BILATERAL_BLUR_KERNEL_H
#undef AFTERSHADE_CORE_FILTER_BILATERAL_BLUR_KERNEL_H
#else
#define AFTERSHADE_CORE_FILTER_BILATERAL_BLUR_KERNEL_H
#endif
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

/// Points of a grid's texels, row by row from `first_row` on. One is needed by all whose taps see it.
struct TexelPoints {
  TexelPoints(const GridSamples& grid, const Lens& lens, int first, int last)
      : x(Plane::for_overwrite(grid.depth.width, last - first + 1)),
        y(Plane::for_overwrite(grid.depth.width, last - first + 1)),
        first_row(first) {
    for (int row = first; row <= last; ++row)
      for_each_vector(grid.depth.width, 0, 0, [&](int x0, auto inside) {
        const Point point = grid.point(lens, Columns<decltype(inside)::value>(x0, grid.depth.width), row);
        store(x.row(row - first) + x0, point.x);
        store(y.row(row - first) + x0, point.y);
      });
  }
  Plane x, y;
  int first_row;
  template <bool kInside>
  Point operator()(const GridSamples& grid, const Columns<kInside>& column, int row) const {
    return {column(x.row(row - first_row)), column(y.row(row - first_row)), column(grid.depth.row(row))};
  }
};

/// One direction of the separable blur: taps at (x + t dx, y + t dy), |t| <= reach.
struct BilateralBlurRow {
  const GridSamples& grid;
  const TexelPoints& points;
  NormalSamples normals;
  EdgeTolerance tolerance;
  Samples value;
  int dx, dy;
  int reach;          ///< ceil(radius)
  float outer_share;  ///< of the taps at |t| == reach: how much of their texel the radius covers, (0, 1]
  float falloff;      ///< 1 / (2 sigma^2), with exp2 as seed 000's CrossBilateralWeight has it
  float* out;
};

/// The mean is taken of differences from the centre, so a constant stays the same to the bit. kInside: all taps lie in
/// columns of the image.
template <bool kInside>
void bilateral_blur_vector(const BilateralBlurRow& row, int x0, int y) {
  const Columns<kInside> x(x0, row.value.width);
  const Float own = x(row.value.row(y));
  const Float base = select(is_finite(own), own, 1.0F);
  const Point centre = row.points(row.grid, x, y);
  const Mask here = is_surface(centre.z);
  Float sum = 0.0F, weights = 0.0F;
  if (any(here)) {
    const Point normal = row.grid.normal(row.normals, x, y);
    const Float inv_tolerance = 1.0F / row.tolerance.at(centre.z);
    for (int t = -row.reach; t <= row.reach; ++t) {
      const int ty = y + t * row.dy;
      if (ty < 0 || ty >= row.value.height) continue;
      const Columns<kInside> tx(x0 + t * row.dx, row.value.width);
      const Point point = row.points(row.grid, tx, ty);
      const Float tap = tx(row.value.row(ty));
      Mask valid = here & is_surface(point.z) & is_finite(tap);
      if constexpr (!kInside) valid = valid & tx.inside;
      const Float d = plane_distance(point - centre, normal) * inv_tolerance;
      const float share = t == row.reach || t == -row.reach ? row.outer_share : 1.0F;
      // exp2(-r^2 falloff - d^2): seed 000, CrossBilateralWeight; distance to the plane instead of depth,
      // algorithms 10.
      const Float w = exp2(-(static_cast<float>(t * t) * row.falloff + d * d)) * share;
      sum += select(valid, w * (tap - base), 0.0F);
      weights += select(valid, w, 0.0F);
    }
  }
  store(row.out + x0, base + select(weights > 0.0F, sum / weights, 0.0F));
}

inline void bilateral_blur_row(const BilateralBlurRow& row, int y) {
  const int across = row.dx * row.reach;
  for_each_vector(row.value.width, across, across,
                  [&](int x0, auto inside) { bilateral_blur_vector<decltype(inside)::value>(row, x0, y); });
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
