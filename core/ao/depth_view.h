#pragma once
#include <algorithm>
#include <cmath>

#include "core/camera/camera.h"
#include "core/image/plane.h"

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

/// What a pixel sees in one layer: where its surface begins and for how many metres it goes on along `ray`.
struct Solid {
  Vec front, ray;
  float length;
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
  ConstPlaneView depth, thickness;
  ConstPlaneView depth2, thickness2;  ///< the second layer; may be empty
  ConstPlaneView nx, ny, nz;
  Projection lens;
  float inv_fx, inv_fy;
  bool extend_border;

  Vec unproject(int x, int y, float z) const {
    const float s = lens.orthographic ? 1.0F : z;
    return {(static_cast<float>(x) + 0.5F - lens.cx) * inv_fx * s,
            -((static_cast<float>(y) + 0.5F - lens.cy) * inv_fy * s), z};
  }
  Vec ray(Vec front) const { return lens.orthographic ? Vec{0, 0, 1} : unit(front); }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < depth.width && y < depth.height; }

  /// Calls visit(Solid) for each layer at pixel (x, y); outside the image the border pixel's surface goes on as a plane
  /// (ours), unless the border is open.
  template <class Visit>
  void for_solids(int x, int y, Visit&& visit) const {
    if (!contains(x, y)) {
      if (extend_border) extended(x, y, visit);
      return;
    }
    const float z = depth(x, y);
    if (!is_surface(z)) return;
    Solid first{unproject(x, y, z), {}, thickness(x, y)};
    first.ray = ray(first.front);
    if (!depth2.empty() && is_surface(depth2(x, y)) && depth2(x, y) > z) {
      const Solid second{unproject(x, y, depth2(x, y)), first.ray, thickness2(x, y)};
      first.length = std::min(first.length, dot(second.front - first.front, first.ray));
      visit(second);
    }
    visit(first);
  }

  /// Unit normal of a pixel's surface seen along `ray`. One that faces away is turned to the camera as little as
  /// needed; without one the surface is taken to face the camera.
  Vec normal(int x, int y, Vec ray) const {
    Vec n{nx(x, y), ny(x, y), nz(x, y)};
    const float away = dot(n, ray);
    if (away > 0) n = n - ray * away;
    const float squared = dot(n, n);
    return squared > 0.01F && squared < 100 ? unit(n) : ray * -1;
  }

  Receiver receiver(int x, int y) const {
    const Vec point = unproject(x, y, depth(x, y)), along = ray(point);
    return {x, y, point, along * -1, normal(x, y, along)};
  }

 private:
  template <class Visit>
  void extended(int x, int y, Visit&& visit) const {
    const int bx = std::clamp(x, 0, depth.width - 1), by = std::clamp(y, 0, depth.height - 1);
    if (!is_surface(depth(bx, by))) return;
    const Vec border = unproject(bx, by, depth(bx, by)), n{nx(bx, by), ny(bx, by), nz(bx, by)},
              through = unproject(x, y, 1);
    const float z = lens.orthographic ? border.z - (n.x * (through.x - border.x) + n.y * (through.y - border.y)) / n.z
                                      : dot(n, border) / dot(n, through);
    if (!is_surface(z)) return;
    const Vec front = unproject(x, y, z);
    visit(Solid{front, ray(front), thickness(bx, by)});
  }
};

}  // namespace aftershade::ao
