#pragma once
#include <span>
#include <vector>

#include "core/ao/depth_view.h"

/// Slices with exact interval visibility. Plain scalar code: lists of intervals resist lanes.
namespace aftershade::ao::slice {

/// The angle of (x, y) from the x axis in [0, pi], for y >= 0 and not both 0; absolute error below 5e-7, relative error
/// below 5e-7 near 0. Reduced to |t| <= tan(pi/8) by atan(t) = pi/4 + atan((t - 1) / (t + 1)); there atan(t) =
/// t + t^3 p(t^2), p a Chebyshev fit.
inline float angle_of(float x, float y) {
  constexpr float kPi = 3.14159265F, kTanEighth = 0.41421356F;
  const float a = std::fabs(x);
  const bool steep = y > a;
  float t = steep ? a / y : y / a, offset = 0;
  if (t > kTanEighth) {
    t = (t - 1) / (t + 1);
    offset = kPi / 4;
  }
  const float z = t * t;
  float p = 8.52979248e-2F;
  p = p * z - 1.40265502e-1F;
  p = p * z + 1.99913941e-1F;
  p = p * z - 3.33332881e-1F;
  float angle = offset + (t + t * z * p);
  if (steep) angle = kPi / 2 - angle;
  return x < 0 ? kPi - angle : angle;
}

/// Elevations are kept as t = -cot(theta), which grows with the angle theta from the view vector.
struct Interval {
  float from, to;
};

/// Adds [from, to] to a sorted list of disjoint intervals.
inline void unite(std::vector<Interval>& list, Interval added) {
  size_t first = list.size();
  while (first > 0 && list[first - 1].to >= added.from) --first;
  size_t last = first;
  for (; last < list.size() && list[last].from <= added.to; ++last) {
    added.from = std::min(added.from, list[last].from);
    added.to = std::max(added.to, list[last].to);
  }
  const auto at = list.begin() + static_cast<std::ptrdiff_t>(first);
  if (first == last) {
    list.insert(at, added);
  } else {
    *at = added;
    list.erase(at + 1, list.begin() + static_cast<std::ptrdiff_t>(last));
  }
}

/// One side of a slice: gamma is the angle of the projected normal, positive towards this side, at most a right angle.
struct Arc {
  float sin_gamma, cos_gamma;
  /// Int_0^theta cos(t - gamma) sin t dt = (cos g + 2 theta sin g - cos(2 theta - g)) / 4   (algorithms 9.1), as
  /// (sin^2 theta cos g + (theta - sin theta cos theta) sin g) / 2, in which nothing large cancels.
  float up_to(float cos, float sin) const {
    return 0.5F * (sin * sin * cos_gamma + (angle_of(cos, sin) - sin * cos) * sin_gamma);
  }
  float operator()(float t) const {
    const float sin = 1 / std::sqrt(1 + t * t);
    return up_to(-t * sin, sin);
  }
  float horizon() const { return sin_gamma / cos_gamma; }  ///< t of gamma + pi/2
  float whole() const { return up_to(-sin_gamma, cos_gamma); }
  float hidden(std::span<const Interval> list) const {
    float sum = 0;
    for (const Interval& i : list) sum += (*this)(i.to) - (*this)(i.from);
    return sum;
  }
};

struct Direction {
  float cos, sin;
};

struct Slices {
  DepthView view;
  float radius_m;
  int steps, count;                       ///< samples a side (0: every pixel), slices
  std::span<const Direction> directions;  ///< 16 rotations of `count` directions
  std::span<const float> offsets;         ///< 16 shifts of the sample positions, in [0, 1)
};

/// A side of one slice: the unit vector across the view vector, that across the slice, and how a point slides into it.
struct Side {
  Vec across, beside;
  float slide_across, slide_view;
  Arc arc;
  float horizon;
};

/// A sample beside the slice is slid into it along the receiver's tangent plane, by the shortest way (ours): a surface
/// parallel to the receiver's keeps its height, so a plane never occludes itself.
inline Side make_side(Vec across, Vec beside, const Receiver& at) {
  const float nd = dot(at.normal, across), nv = dot(at.normal, at.view), ne = dot(at.normal, beside);
  const float squared = nd * nd + nv * nv, length = std::sqrt(squared);
  const Arc arc{nd / length, nv / length};
  return {across, beside, ne * nd / squared, ne * nv / squared, arc, arc.horizon()};
}

/// t of the point `a` > 0 across and `b` towards the camera; squares stay finite.
inline float elevation(float a, float b) { return std::clamp(-b / a, -1e9F, 1e9F); }

/// What the solid hides of the arc: from its front to its back, inside the sphere. Nothing: from >= to.
inline Interval hidden_by(const Side& side, const Receiver& at, const Solid& solid, float radius_m) {
  constexpr Interval kNothing{1, -1};
  if (below_horizon(at, solid)) return kNothing;
  const Vec d = solid.front - at.point;
  const float c = dot(d, side.beside);
  const float a = dot(d, side.across) + c * side.slide_across, b = dot(d, at.view) + c * side.slide_view;
  const float ra = dot(solid.ray, side.across), rb = dot(solid.ray, at.view);
  // (a, b) + l (ra, rb) is inside the sphere where rr l^2 + 2 half l + outside < 0.
  const float rr = ra * ra + rb * rb, half = a * ra + b * rb, outside = a * a + b * b - radius_m * radius_m;
  float first = 0, last = solid.length;
  const bool front_inside = outside < 0, back_inside = (rr * last + 2 * half) * last + outside < 0;
  if (!front_inside || !back_inside) {
    const float discriminant = half * half - rr * outside;
    if ((!front_inside && half >= 0) || !(discriminant > 0)) return kNothing;
    const float root = std::sqrt(discriminant);
    if (!front_inside) first = (-half - root) / rr;
    last = std::min(last, (root - half) / rr);
  }
  const float a0 = a + first * ra, a1 = a + last * ra;
  if (!(first < last) || !(a0 > 0) || !(a1 > 0)) return kNothing;
  return {elevation(a0, b + first * rb), std::min(elevation(a1, b + last * rb), side.horizon)};
}

/// From the receiver to where this side leaves the projected sphere of the radius, in pixels.
struct Screen {
  float x, y;
};
/// The tangent to the sphere leaves the eye at asin(R / |P|) from the receiver's ray, also off axis; a sphere around
/// the camera, or one that reaches beside it, has no end in the image.
inline Screen reach(const Slices& all, const Receiver& at, Vec across) {
  const Projection& lens = all.view.lens;
  if (lens.orthographic) return {across.x * all.radius_m * lens.fx, -across.y * all.radius_m * lens.fy};
  const Vec p = at.point * (1 / at.point.z);
  const float sine = all.radius_m / std::sqrt(dot(at.point, at.point));
  if (sine < 1) {
    const Vec edge = across * sine - at.view * std::sqrt(1 - sine * sine);
    if (edge.z > 0) return {(edge.x / edge.z - p.x) * lens.fx, -(edge.y / edge.z - p.y) * lens.fy};
  }
  constexpr float kBeyond = 1e6F;
  const float x = (across.x - p.x * across.z) * lens.fx, y = -(across.y - p.y * across.z) * lens.fy;
  const float scale = kBeyond / std::max(std::fabs(x), std::fabs(y));
  return {x * scale, y * scale};
}

/// Nearest integer, |x| < 2^22; in lanes round_small.
inline int nearest(float x) { return static_cast<int>((x + 12582912.0F) - 12582912.0F); }

/// Samples from the receiver outwards, i + (r - steps) ((i - offset) / steps)^2 pixels away: every pixel near, wider
/// apart far away (XeGTAO distributes by the square too, algorithms 9.2).
inline float hidden_on_side(const Slices& all, const Receiver& at, const Side& side, float offset,
                            std::vector<Interval>& list) {
  list.clear();
  const Screen end = reach(all, at, side.across);
  const float longest = std::max(std::fabs(end.x), std::fabs(end.y)), dx = end.x / longest, dy = end.y / longest;
  const auto image = static_cast<float>(std::max(all.view.depth.width, all.view.depth.height));
  const int last = static_cast<int>(std::min(longest, image) + 0.5F);
  const int count = all.steps > 0 ? std::min(all.steps, last) : last, layers = all.view.layers();
  if (count == 0) return 0;
  const auto n = static_cast<float>(count);
  const float growth = (static_cast<float>(last) - n) / (n * n);
  for (int i = 1; i <= count; ++i) {
    const float k = static_cast<float>(i) - offset, r = static_cast<float>(i + static_cast<int>(growth * k * k));
    const int x = at.x + nearest(dx * r), y = at.y + nearest(dy * r);
    for (int layer = 0; layer < layers; ++layer) {
      const std::optional<Solid> solid = all.view.solid(x, y, layer);
      if (!solid) continue;
      const Interval hidden = hidden_by(side, at, *solid, all.radius_m);
      if (hidden.from < hidden.to) unite(list, hidden);
    }
  }
  return side.arc.hidden(list);
}

/// 1 - sum |N'| hidden / sum |N'| whole over the slices (algorithms 9.1 and 9.3; GTAO has the mean of |N'| whole, which
/// is 1 only for many slices).
inline float visibility(const Slices& all, const Receiver& at, int cell, std::vector<Interval>& list) {
  const Basis basis = basis_across(at.view);
  float hidden = 0, whole = 0;
  for (int k = 0; k < all.count; ++k) {
    const Direction turn = all.directions[static_cast<size_t>(cell * all.count + k)];
    const Vec across = basis.s * turn.cos + basis.t * turn.sin, beside = cross(across, at.view);
    const float nd = dot(at.normal, across), nv = dot(at.normal, at.view), weight = std::sqrt(nd * nd + nv * nv);
    if (!(weight > 1e-4F)) continue;  // the slice's plane is the tangent plane
    for (const float sign : {1.0F, -1.0F}) {
      const Side side = make_side(across * sign, beside * sign, at);
      hidden += weight * hidden_on_side(all, at, side, all.offsets[static_cast<size_t>(cell)], list);
      whole += weight * side.arc.whole();
    }
  }
  return whole > 0 ? std::clamp(1 - hidden / whole, 0.0F, 1.0F) : 1.0F;
}

}  // namespace aftershade::ao::slice
