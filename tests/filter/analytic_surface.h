#pragma once
#include <cmath>
#include <functional>
#include <limits>

#include "core/filter/normals.h"
#include "core/filter/surface.h"
#include "core/math/linear.h"

/// Surfaces given by a formula, for the tests of core/filter and core/ao.
namespace aftershade::tests {

inline constexpr float kInf = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A camera whose principal point is absolute pixel position (cx, cy).
struct Lens {
  float fx = 100, fy = 100, cx = 0, cy = 0;
  bool orthographic = false;
  Vec3 ray(double x, double y) const { return {(x - cx) / fx, -(y - cy) / fy, 1}; }
  Vec3 point(double x, double y, double z) const {
    const Vec3 d = ray(x, y);
    return orthographic ? Vec3(d.x, d.y, z) : d * z;
  }
};

struct Hit {
  double z = std::numeric_limits<double>::infinity();
  Vec3 normal{0, 0, 0};
};

/// What is seen at an absolute pixel position.
using View = std::function<Hit(double x, double y)>;

/// The depth at which the ray of (x, y) meets the plane {p : n . p = offset}.
inline Hit meet_plane(const Lens& lens, double x, double y, Vec3 n, double offset) {
  n.normalize();
  const Vec3 d = lens.ray(x, y);
  const double z = lens.orthographic ? (offset - n.x * d.x - n.y * d.y) / n.z : offset / n.dot(d);
  return {z, n};
}

struct Picture {
  Plane depth;
  filter::Normals normals;
  Projection projection;
  int origin_x = 0, origin_y = 0, display_height = 0;
  filter::Surface surface() const {
    return {depth, normals[0], normals[1], normals[2], projection, origin_x, origin_y, display_height};
  }
};

inline Picture picture(int width, int height, const Lens& lens, const View& view, int origin_x = 0, int origin_y = 0) {
  Picture out;
  out.depth = Plane(width, height);
  for (Plane& plane : out.normals) plane = Plane(width, height);
  out.projection = {lens.fx, lens.fy, lens.cx - static_cast<float>(origin_x), lens.cy - static_cast<float>(origin_y),
                    lens.orthographic};
  out.origin_x = origin_x;
  out.origin_y = origin_y;
  out.display_height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Hit hit = view(origin_x + x + 0.5, origin_y + y + 0.5);
      out.depth(x, y) = static_cast<float>(hit.z);
      out.normals[0](x, y) = static_cast<float>(hit.normal.x);
      out.normals[1](x, y) = static_cast<float>(hit.normal.y);
      out.normals[2](x, y) = static_cast<float>(hit.normal.z);
    }
  return out;
}

/// A slanted plane 5 m away.
inline View slanted_plane(const Lens& lens, Vec3 normal = {0.4, 0.6, -0.5}) {
  return [=](double x, double y) { return meet_plane(lens, x, y, normal, 5 * normal.z / normal.length()); };
}

/// The same picture with every length times `factor`.
inline Picture scaled(const Picture& source, float factor) {
  Picture out;
  out.depth = copy_of(source.depth);
  for (size_t i = 0; i < 3; ++i) out.normals[i] = copy_of(source.normals[i]);
  for (int y = 0; y < out.depth.height(); ++y)
    for (int x = 0; x < out.depth.width(); ++x) out.depth(x, y) *= factor;
  out.projection = source.projection;
  if (out.projection.orthographic) {
    out.projection.fx /= factor;
    out.projection.fy /= factor;
  }
  out.origin_x = source.origin_x;
  out.origin_y = source.origin_y;
  out.display_height = source.display_height;
  return out;
}

/// The pixels where two planes differ in any bit (NaN equals NaN).
inline int differing_pixels(ConstPlaneView a, ConstPlaneView b) {
  int count = a.width == b.width && a.height == b.height ? 0 : 1 << 30;
  for (int y = 0; y < a.height && count < (1 << 30); ++y)
    for (int x = 0; x < a.width; ++x) {
      const float u = a(x, y), v = b(x, y);
      count += !(u == v || (std::isnan(u) && std::isnan(v)));
    }
  return count;
}

}  // namespace aftershade::tests
