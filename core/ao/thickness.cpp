#include "core/ao/thickness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/ao/depth_view.h"
#include "core/parallel/rows.h"

namespace aftershade::ao {

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
/// Two neighbours belong to one surface up to a gap of so many pixel footprints (ours).
constexpr float kGapFootprints = 3;

/// Pixels (x + i dx, y + i dy) of one line through the image.
struct Line {
  ConstPlaneView image;
  const Projection& lens;
  int x, y, dx, dy, count;

  float depth(int i) const { return image(x + i * dx, y + i * dy); }
  float footprint(float z) const {
    const float step = static_cast<float>(dx) / lens.fx, rise = static_cast<float>(dy) / lens.fy;
    return std::sqrt(step * step + rise * rise) * (lens.orthographic ? 1.0F : z);
  }
  /// Depth that the surface through pixels i - 2s and i - s has at i; planes are linear in 1/z (z if orthographic).
  float extended(int i, int s) const {
    const int far = i - 2 * s;
    const float near = depth(i - s);
    if (far < 0 || far >= count || !is_surface(depth(far))) return near;
    if (lens.orthographic) return 2 * near - depth(far);
    return 1 / (2 / near - 1 / depth(far));
  }
  /// Do pixels i and i + 1, both surface, show one surface?
  bool joined(int i) const {
    const float a = depth(i), b = depth(i + 1), limit = kGapFootprints * footprint(std::min(a, b));
    return std::abs(a - b) <= limit || std::abs(extended(i + 1, 1) - b) <= limit ||
           std::abs(extended(i, -1) - a) <= limit;
  }
};

/// Shortens the widths of the pixels of one line.
void measure(const Line& line, Plane& widths) {
  for (int first = 0; first < line.count;) {
    if (!is_surface(line.depth(first++))) continue;
    const int begin = first - 1;
    while (first < line.count && is_surface(line.depth(first)) && line.joined(first - 1)) ++first;
    const auto silhouette = [&](int inside, int outside) {
      return outside >= 0 && outside < line.count &&
             !(is_surface(line.depth(outside)) && line.depth(outside) <= line.depth(inside));
    };
    if (!silhouette(begin, begin - 1) || !silhouette(first - 1, first)) continue;
    const auto pixels = static_cast<float>(first - begin);
    for (int i = begin; i < first; ++i) {
      float& width = widths(line.x + i * line.dx, line.y + i * line.dy);
      width = std::min(width, pixels * line.footprint(line.depth(i)));
    }
  }
}

}  // namespace

Plane object_widths(ConstPlaneView depth, const Projection& lens) {
  const int w = depth.width, h = depth.height;
  Plane widths(w, h);
  for_rows(h, [&](int y) {
    for (int x = 0; x < w; ++x) widths(x, y) = is_surface(depth(x, y)) ? kInf : 0.0F;
    measure({depth, lens, 0, y, 1, 0, w}, widths);
  });
  for_rows(w, [&](int x) { measure({depth, lens, x, 0, 0, 1, h}, widths); });
  for (const int dx : {1, -1})  // diagonals start at the top row and at one side
    for_rows(w + h - 1, [&](int k) {
      const int along = std::max(k - (h - 1), 0), y = std::max(h - 1 - k, 0);
      const int x = dx > 0 ? along : w - 1 - along;
      measure({depth, lens, x, y, dx, 1, std::min(h - y, w - along)}, widths);
    });
  return widths;
}

Plane thickness_map(const DepthGeometry& geometry, ConstPlaneView depth, const Projection& lens) {
  if (geometry.thickness == ThicknessModel::constant) return Plane(depth.width, depth.height, geometry.max_thickness_m);
  Plane map = object_widths(depth, lens);
  for_rows(map.height(), [&](int y) {
    for (int x = 0; x < map.width(); ++x) {
      const float wanted = std::max(geometry.thickness_ratio * map(x, y), geometry.min_thickness_m);
      map(x, y) = std::min(wanted, geometry.max_thickness_m);
    }
  });
  return map;
}

Plane planar_thickness(const DepthGeometry& geometry, ConstPlaneView depth, const Projection& lens) {
  Plane map = thickness_map(geometry, depth, lens);
  if (lens.orthographic) return map;
  for_rows(map.height(), [&](int y) {
    const float v = (static_cast<float>(y) + 0.5F - lens.cy) / lens.fy;
    for (int x = 0; x < map.width(); ++x) {
      const float u = (static_cast<float>(x) + 0.5F - lens.cx) / lens.fx;
      map(x, y) /= std::sqrt(u * u + v * v + 1);
    }
  });
  return map;
}

}  // namespace aftershade::ao
