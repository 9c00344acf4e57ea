#pragma once
#include <limits>
#include <span>

#include "core/ao/depth_view.h"

/// Rays through a depth buffer. Plain scalar code: each ray goes its own way.
namespace aftershade::ao::march {

struct Direction {
  float x, y, z;  ///< z along the normal
};

struct Rays {
  DepthView view;
  float radius_m;
  bool squared_falloff;
  std::span<const Direction> directions;
};

/// A ray from the receiver and its image, a straight line: pixel position at tau in [0, 1], the image's end at 1.
struct Path {
  Vec direction;  ///< unit
  float end_m;    ///< metres at tau = 1
  float x, y, dx, dy;
  float z0, z1;  ///< depths at both ends; 1 and 1 without perspective

  /// Metres from the receiver at tau: 1/z is linear along the image of a line.
  float metres(float tau) const { return end_m * (tau * z0) / ((1 - tau) * z1 + tau * z0); }
};

inline Path path(const Rays& all, const Receiver& at, Vec direction) {
  const Projection& lens = all.view.lens;
  constexpr float kNearest = 1e-3F;  // a ray that comes close to the camera's plane ends at this part of its depth
  const float to_camera =
      lens.orthographic || direction.z >= 0 ? all.radius_m : at.point.z * (kNearest - 1) / direction.z;
  const float end_m = std::min(all.radius_m, to_camera);
  const Vec end = at.point + direction * end_m;
  const float s0 = lens.orthographic ? 1 : at.point.z, s1 = lens.orthographic ? 1 : end.z;
  return {direction,
          end_m,
          static_cast<float>(at.x) + 0.5F,
          static_cast<float>(at.y) + 0.5F,
          (end.x / s1 - at.point.x / s0) * lens.fx,
          -(end.y / s1 - at.point.y / s0) * lens.fy,
          s0,
          s1};
}

/// Where along [enter, leave] (metres) the ray is between the front and the back facet of the solid; +inf: nowhere.
/// Both lie across the solid's own normal.
inline float meets(Vec from, Vec direction, const Solid& solid, Vec normal, float enter, float leave) {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  const float above = dot(from - solid.front, normal), rise = dot(direction, normal);
  const float below = above - solid.length * dot(solid.ray, normal);  // above the back
  if (rise == 0) return above < 0 && below > 0 && enter < leave ? enter : kNever;
  const float front = -above / rise, back = -below / rise;
  const float first = std::max(enter, std::min(front, back));
  return first < std::min(leave, std::max(front, back)) ? first : kNever;
}

/// Metres to the nearest thing that the ray meets; +inf: none. Amanatides and Woo's walk over the pixels.
inline float distance(const Rays& all, const Receiver& at, Vec direction) {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  const Path p = path(all, at, direction);
  const int step_x = p.dx < 0 ? -1 : 1, step_y = p.dy < 0 ? -1 : 1;
  const float each_x = p.dx != 0 ? 1 / std::fabs(p.dx) : kNever, each_y = p.dy != 0 ? 1 / std::fabs(p.dy) : kNever;
  const int most = all.view.depth.width + all.view.depth.height;
  float next_x = 0.5F * each_x, next_y = 0.5F * each_y, tau = 0;
  int x = at.x, y = at.y;
  for (int pixels = 0; pixels < most && tau < 1; ++pixels) {
    const float leave = std::min({next_x, next_y, 1.0F});
    float nearest = kNever;
    for (int layer = 0; pixels > 0 && layer < all.view.layers(); ++layer) {
      const std::optional<Solid> solid = all.view.solid(x, y, layer);
      if (!solid || below_horizon(at, *solid)) continue;
      const int nx = std::clamp(x, 0, all.view.depth.width - 1), ny = std::clamp(y, 0, all.view.depth.height - 1);
      const Vec normal = all.view.normal(nx, ny, unit(solid->ray));
      nearest = std::min(nearest, meets(at.point, direction, *solid, normal, p.metres(tau), p.metres(leave)));
    }
    if (nearest < all.radius_m) return nearest;
    tau = leave;
    if (next_x <= next_y) {
      x += step_x;
      next_x += each_x;
    } else {
      y += step_y;
      next_y += each_y;
    }
  }
  return kNever;
}

/// The share of the rays that is open; `turn` rotates them about the normal.
inline float visibility(const Rays& all, const Receiver& at, float cosine, float sine) {
  const Basis basis = basis_across(at.normal);
  float hidden = 0;
  for (const Direction& d : all.directions) {
    const float u = d.x * cosine - d.y * sine, v = d.x * sine + d.y * cosine;
    const float r = distance(all, at, basis.s * u + basis.t * v + at.normal * d.z) / all.radius_m;
    if (r < 1) hidden += all.squared_falloff ? 1 - r * r : 1;
  }
  return 1 - hidden / static_cast<float>(all.directions.size());
}

}  // namespace aftershade::ao::march
