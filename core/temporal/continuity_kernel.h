#if defined(AFTERSHADE_CORE_TEMPORAL_CONTINUITY_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_TEMPORAL_CONTINUITY_KERNEL_H
#undef AFTERSHADE_CORE_TEMPORAL_CONTINUITY_KERNEL_H
#else
#define AFTERSHADE_CORE_TEMPORAL_CONTINUITY_KERNEL_H
#endif
#include <limits>

#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

struct ContinuityParams {
  GridSamples texels;
  Lens lens;
  EdgeTolerance limit;  ///< L
};

/// From texel to texel; infinite where the other is no surface.
inline Float texel_distance(const Point& p, const Point& q) {
  const Point v = q - p;
  return select(is_surface(q.z), sqrt(dot(v, v)), std::numeric_limits<float>::infinity());
}

/// The distance to the nearer of the two texels beside each in a row. At the border the side that exists stands for
/// both; where neither does, the texel itself: nothing there is discontinuous.
template <bool kInside>
Float nearer_in_row(const ContinuityParams& params, const Point& p, int x0, int y) {
  const int width = params.texels.depth.width;
  const auto distance = [&](int step) {
    const Columns<kInside> there(x0 + step, width);
    const Float seen = texel_distance(p, params.texels.point(params.lens, there, y));
    if constexpr (kInside) return seen;
    const Columns<kInside> opposite(x0 - step, width);
    const Float other = texel_distance(p, params.texels.point(params.lens, opposite, y));
    return select(there.inside, seen, other);
  };
  return min(distance(-1), distance(1));
}

/// The same in a column.
template <bool kInside>
Float nearer_in_column(const ContinuityParams& params, const Point& p, const Columns<kInside>& x, int y) {
  const int height = params.texels.depth.height;
  const auto distance = [&](int step) {
    const bool exists = y + step >= 0 && y + step < height;
    const int to = std::clamp(exists ? y + step : y - step, 0, height - 1);
    return texel_distance(p, params.texels.point(params.lens, x, to));
  };
  return min(distance(-1), distance(1));
}

/// continuityMask = |P_x - P| < L && |P_y - P| < L, P_x and P_y the nearer of two neighbours (seed 000, "Piecewise
/// Continuity Test", "Two Half-Res Passes"). L grows with the pixel's footprint: algorithms 14, item 7.
inline void continuity_row(const ContinuityParams& params, int y, float* mask) {
  const int width = params.texels.depth.width;
  for_each_vector(width, 1, 1, [&](int x0, auto inside) {
    const Columns<inside()> x(x0, width);
    const Point p = params.texels.point(params.lens, x, y);
    const Float limit = params.limit.at(p.z);
    const Mask continuous = is_surface(p.z) & (nearer_in_row<inside()>(params, p, x0, y) < limit) &
                            (nearer_in_column(params, p, x, y) < limit);
    store(mask + x0, select(continuous, Float(1.0F), Float(0.0F)));
  });
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
