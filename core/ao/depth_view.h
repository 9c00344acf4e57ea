#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/ao/depth_geometry.h"
#include "core/filter/surface.h"

/// The picture as points in camera space, in plain floats, for the estimators whose control flow resists lanes.
namespace aftershade::ao {

struct Vec {
  float x, y, z;
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(Vec a, float s) { return {a.x * s, a.y * s, a.z * s}; }
inline float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Vec unit(Vec a) { return a * (1 / std::sqrt(dot(a, a))); }

inline bool is_surface(float z) { return z > 0 && z <= 3.402823466e38F; }

/// Two unit vectors across unit vector `v` and each other.
struct Basis {
  Vec s, t;
};
inline Basis basis_across(Vec v) {
  const Vec s = unit(cross(v, std::fabs(v.x) < 0.7F ? Vec{1, 0, 0} : Vec{0, 1, 0}));
  return {s, cross(v, s)};
}

/// What a pixel sees in one layer: its surface begins at `front` and goes on to front + length ray.
struct Solid {
  Vec front, ray;  ///< ray: of one metre of planar depth
  float length;    ///< metres of planar depth
};

/// What is evaluated: a point of the first layer, the unit vector to the camera, the unit normal.
struct Receiver {
  int x, y;
  Vec point, view, normal;
};

/// Is all of the solid's centre line below the receiver's tangent plane? Then it hides nothing; the facets around it
/// that the line stands for must not hide either, or convex surfaces would hide themselves.
inline bool below_horizon(const Receiver& at, const Solid& solid) {
  const float height = dot(solid.front - at.point, at.normal);
  return height <= 0 && height + solid.length * dot(solid.ray, at.normal) <= 0;
}

struct DepthView {
  ConstPlaneView depth, thickness;    ///< thickness as planar_thickness has it
  ConstPlaneView depth2, thickness2;  ///< the second layer; may be empty
  ConstPlaneView nx, ny, nz;
  Projection lens;
  float inv_fx, inv_fy;
  bool extend_border;

  float slope_x(int x) const { return (static_cast<float>(x) + 0.5F - lens.cx) * inv_fx; }
  float slope_y(int y) const { return -((static_cast<float>(y) + 0.5F - lens.cy) * inv_fy); }
  Vec unproject(int x, int y, float z) const {
    const float s = lens.orthographic ? 1.0F : z;
    return {slope_x(x) * s, slope_y(y) * s, z};
  }
  /// The pixel's ray, one metre of planar depth long.
  Vec ray(int x, int y) const { return lens.orthographic ? Vec{0, 0, 1} : Vec{slope_x(x), slope_y(y), 1}; }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < depth.width && y < depth.height; }

  int layers() const { return depth2.empty() ? 1 : 2; }

  /// What pixel (x, y) shows in a layer, 0 or 1; outside the image the border pixel's surface goes on as a plane
  /// (ours), unless the border is open.
  std::optional<Solid> solid(int x, int y, int layer) const {
    if (!contains(x, y)) return extend_border && layer == 0 ? extended(x, y) : std::nullopt;
    const float z = depth(x, y);
    if (!is_surface(z)) return {};
    const bool covers = !depth2.empty() && is_surface(depth2(x, y)) && depth2(x, y) > z;
    if (layer == 0) {
      const float length = covers ? std::min(thickness(x, y), depth2(x, y) - z) : thickness(x, y);
      return Solid{unproject(x, y, z), ray(x, y), length};
    }
    if (!covers) return {};
    return Solid{unproject(x, y, depth2(x, y)), ray(x, y), thickness2(x, y)};
  }

  /// Unit normal of a pixel's surface seen along unit vector `along`. One that faces away is turned to the camera as
  /// little as needed; without one the surface is taken to face the camera.
  Vec normal(int x, int y, Vec along) const {
    Vec n{nx(x, y), ny(x, y), nz(x, y)};
    const float away = dot(n, along);
    if (away > 0) n = n - along * away;
    const float squared = dot(n, n);
    return squared > 0.01F && squared < 100 ? unit(n) : along * -1;
  }

  Receiver receiver(int x, int y) const {
    const Vec along = unit(ray(x, y));
    return {x, y, unproject(x, y, depth(x, y)), along * -1, normal(x, y, along)};
  }

 private:
  std::optional<Solid> extended(int x, int y) const {
    const int bx = std::clamp(x, 0, depth.width - 1), by = std::clamp(y, 0, depth.height - 1);
    if (!is_surface(depth(bx, by))) return {};
    const Vec border = unproject(bx, by, depth(bx, by)), n{nx(bx, by), ny(bx, by), nz(bx, by)},
              through = unproject(x, y, 1);
    const float z = lens.orthographic ? border.z - (n.x * (through.x - border.x) + n.y * (through.y - border.y)) / n.z
                                      : dot(n, border) / dot(n, through);
    if (!is_surface(z)) return {};
    return Solid{unproject(x, y, z), ray(x, y), thickness(bx, by)};
  }
};

/// The planes must outlive the view.
inline DepthView depth_view(const DepthGeometry& geometry, const filter::Surface& surface, ConstPlaneView thickness,
                            ConstPlaneView depth2, ConstPlaneView thickness2) {
  const Projection& lens = surface.projection;
  return {surface.depth,
          thickness,
          depth2,
          thickness2,
          surface.nx,
          surface.ny,
          surface.nz,
          lens,
          1 / lens.fx,
          1 / lens.fy,
          geometry.border == Border::extend};
}

}  // namespace aftershade::ao
