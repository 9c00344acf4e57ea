#pragma once
#include <limits>

#include "core/filter/lane_geometry.h"

namespace aftershade::temporal {
using namespace lanes;

struct ContinuityParams {
  filter::GridSamples texels;
  filter::Lens lens;
  filter::EdgeTolerance limit;  ///< L
};

/// From texel to texel; infinite where the other is no surface.
inline Float texel_distance(const ContinuityParams& params, const filter::Point& p, Int x, Int y) {
  const filter::Point q = params.texels.point(params.lens, x, y), v = q - p;
  return select(filter::is_surface(q.z), sqrt(filter::dot(v, v)), std::numeric_limits<float>::infinity());
}

/// The distance to the nearer of two neighbours at offsets -step and +step. At the border the side that exists stands
/// for both; where neither does, the texel itself: nothing there is discontinuous.
inline Float nearer_neighbour(const ContinuityParams& params, const filter::Point& p, Int x, Int y, int step_x,
                              int step_y) {
  const filter::Samples& inside = params.texels.depth;
  const auto distance = [&](Int dx, Int dy) {
    const Mask exists = inside.contains(x + dx, y + dy);
    const Int to_x = select(exists, x + dx, x - dx), to_y = select(exists, y + dy, y - dy);
    return texel_distance(params, p, inside.clamp_x(to_x), inside.clamp_y(to_y));
  };
  return min(distance(-step_x, -step_y), distance(step_x, step_y));
}

/// continuityMask = |P_x - P| < L && |P_y - P| < L, P_x and P_y the nearer of two neighbours (seed 000, "Piecewise
/// Continuity Test", "Two Half-Res Passes"). L grows with the pixel's footprint: algorithms 14, item 7.
inline void continuity_row(const ContinuityParams& params, int y, float* mask) {
  const filter::Samples& depth = params.texels.depth;
  for (int i = 0; i < depth.width; i += kLanes) {
    const Int x = depth.clamp_x(iota(i));
    const filter::Point p = params.texels.point(params.lens, x, y);
    const Float limit = params.limit.at(p.z);
    const Mask continuous = filter::is_surface(p.z) & (nearer_neighbour(params, p, x, y, 1, 0) < limit) &
                            (nearer_neighbour(params, p, x, y, 0, 1) < limit);
    store(mask + i, select(continuous, Float(1.0F), Float(0.0F)));
  }
}

}  // namespace aftershade::temporal
