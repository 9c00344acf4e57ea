#pragma once
#include <limits>

#include "core/camera/camera.h"
#include "core/simd/lanes.h"

namespace aftershade::temporal {
using namespace lanes;

/// One row of the AO's grid: depth in metres and the window index of the pixel each texel was picked from.
struct TexelRow {
  const float* depth;
  const float *pixel_x, *pixel_y;  ///< null on a full grid: texel (x, y) is pixel (x, y)
  int y;
};

struct ContinuityRow {
  TexelRow here, above, below;  ///< at the border the side that exists stands for both
  int width;
  Projection projection;
  float distance_m;     ///< L is at least this ...
  float footprints_px;  ///< ... and this many pixels at the texel's depth
  float* mask;
};

struct TexelPoint {
  Float x, y, z;
};

inline Mask is_surface(Float depth) { return is_finite(depth) & (depth > 0.0F); }

/// The camera-space point (y down: only distances matter) of the picked pixel's centre.
inline TexelPoint texel_point(const TexelRow& row, Int index, const Projection& lens) {
  const Float z = gather(row.depth, index);
  const Float px = row.pixel_x != nullptr ? gather(row.pixel_x, index) : to_float(index);
  const Float py = row.pixel_y != nullptr ? gather(row.pixel_y, index) : to_float(Int(row.y));
  const Float scale = lens.orthographic ? Float(1.0F) : z;
  return {(px + 0.5F - lens.cx) / lens.fx * scale, (py + 0.5F - lens.cy) / lens.fy * scale, z};
}

inline Float distance(const TexelPoint& p, const TexelPoint& q) {
  const Float dx = q.x - p.x, dy = q.y - p.y, dz = q.z - p.z;
  return select(is_surface(q.z), sqrt(dx * dx + dy * dy + dz * dz), std::numeric_limits<float>::infinity());
}

/// continuityMask = |P_x - P| < L && |P_y - P| < L, P_x and P_y the nearer of two neighbours (seed 000, "Piecewise
/// Continuity Test", "Two Half-Res Passes"). L grows with the pixel's footprint: algorithms 14, item 7.
inline void continuity_row(const ContinuityRow& row) {
  for (int x = 0; x < row.width; x += kLanes) {
    const Int last(row.width - 1), here = min(iota(x), last);
    const Int left = min(select(here < Int(1), Int(1), here - Int(1)), last);
    const Int right = select(here < last, here + Int(1), max(last - Int(1), Int(0)));
    const TexelPoint p = texel_point(row.here, here, row.projection);
    const auto to = [&](const TexelRow& side, Int index) {
      return distance(p, texel_point(side, index, row.projection));
    };
    const Float along_x = min(to(row.here, left), to(row.here, right));
    const Float along_y = min(to(row.above, here), to(row.below, here));
    const Float footprint = (row.projection.orthographic ? Float(1.0F) : p.z) / row.projection.fx;
    const Float limit = max(row.distance_m, footprint * row.footprints_px);
    const Mask continuous = is_surface(p.z) & (along_x < limit) & (along_y < limit);
    store(row.mask + x, select(continuous, Float(1.0F), Float(0.0F)));
  }
}

}  // namespace aftershade::temporal
