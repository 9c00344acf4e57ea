#include "tests/support/shapes.h"

#include <algorithm>
#include <cmath>

#include "core/math/sampling.h"

namespace aftershade::tests {

namespace {
using MaybeHit = std::optional<SurfaceHit>;

bool inside(const Ray& ray, double t) { return t > ray.t_min && t < ray.t_max; }

MaybeHit hit(const Sphere& sphere, const Ray& ray) {
  const Vec3 &o = ray.origin, &d = ray.direction;
  const double a = d.dot(d), half_b = o.dot(d), c = o.dot(o) - sphere.radius_m * sphere.radius_m;
  const double discriminant = half_b * half_b - a * c;
  if (discriminant < 0) return {};
  const double root = std::sqrt(discriminant);
  for (double t : {(-half_b - root) / a, (-half_b + root) / a})
    if (inside(ray, t)) return SurfaceHit{t, ray.at(t) / sphere.radius_m};
  return {};
}

/// Slabs: the ray is inside the box between its last entry and its first exit.
MaybeHit hit(const Box& box, const Ray& ray) {
  double enter = -1e30, leave = 1e30;
  int enter_axis = 0, leave_axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double inv = 1 / ray.direction[axis];
    const double t0 = (-box.half_m[axis] - ray.origin[axis]) * inv, t1 = (box.half_m[axis] - ray.origin[axis]) * inv;
    if (std::min(t0, t1) > enter) enter = std::min(t0, t1), enter_axis = axis;
    if (std::max(t0, t1) < leave) leave = std::max(t0, t1), leave_axis = axis;
  }
  if (!(enter <= leave)) return {};
  const bool from_outside = inside(ray, enter);
  if (!from_outside && !inside(ray, leave)) return {};
  const double t = from_outside ? enter : leave;
  const int axis = from_outside ? enter_axis : leave_axis;
  Vec3 normal(0);
  normal[axis] = ray.at(t)[axis] > 0 ? 1 : -1;
  return SurfaceHit{t, normal};
}

MaybeHit hit(const Cylinder& cylinder, const Ray& ray) {
  const Vec3 &o = ray.origin, &d = ray.direction;
  const double r2 = cylinder.radius_m * cylinder.radius_m, h = cylinder.half_height_m;
  MaybeHit best;
  const auto offer = [&](double t, const Vec3& normal) {
    if (inside(ray, t) && (!best || t < best->t)) best = SurfaceHit{t, normal};
  };
  const double a = d.x * d.x + d.z * d.z, half_b = o.x * d.x + o.z * d.z, c = o.x * o.x + o.z * o.z - r2;
  const double discriminant = half_b * half_b - a * c;
  if (discriminant < 0) return {};
  for (double sign : {-1.0, 1.0}) {
    const double t = (-half_b + sign * std::sqrt(discriminant)) / a;
    const Vec3 p = ray.at(t);
    if (std::abs(p.y) < h) offer(t, Vec3(p.x, 0, p.z) / cylinder.radius_m);
    const double cap = (sign * h - o.y) / d.y;
    const Vec3 q = ray.at(cap);
    if (q.x * q.x + q.z * q.z <= r2) offer(cap, Vec3(0, sign, 0));
  }
  return best;
}

MaybeHit hit(const Ground&, const Ray& ray) {
  const double t = -ray.origin.y / ray.direction.y;
  if (!inside(ray, t)) return {};
  return SurfaceHit{t, Vec3(0, 1, 0)};
}

/// Moeller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection".
MaybeHit hit(const Triangle& triangle, const Ray& ray) {
  const Vec3 e1 = triangle.b - triangle.a, e2 = triangle.c - triangle.a, p = ray.direction.cross(e2);
  const double determinant = e1.dot(p);
  if (determinant == 0) return {};
  const Vec3 s = ray.origin - triangle.a, q = s.cross(e1);
  const double u = s.dot(p) / determinant, v = ray.direction.dot(q) / determinant, t = e2.dot(q) / determinant;
  if (u < 0 || v < 0 || u + v > 1 || !inside(ray, t)) return {};
  return SurfaceHit{t, e1.cross(e2).normalized()};
}

MaybeHit hit(const CutOutCard& card, const Ray& ray) {
  const double t = -ray.origin.z / ray.direction.z;
  if (!inside(ray, t)) return {};
  const Vec3 p = ray.at(t);
  if (!card.opaque(p.x, p.y)) return {};
  return SurfaceHit{t, Vec3(0, 0, 1)};
}

Bounds symmetric(const Vec3& half) { return {half * -1, half}; }
std::optional<Bounds> extent(const Sphere& s) { return symmetric(Vec3(s.radius_m)); }
std::optional<Bounds> extent(const Box& b) { return symmetric(b.half_m); }
std::optional<Bounds> extent(const Cylinder& c) { return symmetric({c.radius_m, c.half_height_m, c.radius_m}); }
std::optional<Bounds> extent(const Ground&) { return std::nullopt; }
std::optional<Bounds> extent(const CutOutCard& c) { return symmetric({c.half_width_m, c.half_height_m, 0}); }
std::optional<Bounds> extent(const Triangle& triangle) {
  Bounds bounds;
  for (const Vec3& p : {triangle.a, triangle.b, triangle.c}) bounds.include(p);
  return bounds;
}
}  // namespace

void Bounds::include(const Vec3& p) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(low[axis], p[axis]);
    high[axis] = std::max(high[axis], p[axis]);
  }
}

bool CutOutCard::opaque(double x, double y) const {
  const double u = x / half_width_m, v = y / half_height_m;
  if (u * u + v * v > 1) return false;
  const int column = static_cast<int>(std::floor(x / leaf_m)), row = static_cast<int>(std::floor(y / leaf_m));
  for (int j = row - 1; j <= row + 1; ++j)
    for (int i = column - 1; i <= column + 1; ++i) {
      const auto random = [&](uint32_t index) {
        return static_cast<double>(
            unit_float(hash_counters(static_cast<uint32_t>(i), static_cast<uint32_t>(j), 0, index)));
      };
      const double dx = x / leaf_m - i - random(1), dy = y / leaf_m - j - random(2), r = 0.25 + 0.3 * random(3);
      if (dx * dx + dy * dy < r * r) return true;
    }
  return false;
}

std::optional<SurfaceHit> intersect(const Shape& shape, const Ray& ray) {
  return std::visit([&](const auto& s) { return hit(s, ray); }, shape);
}

std::optional<Bounds> bounds_of(const Shape& shape) {
  return std::visit([](const auto& s) { return extent(s); }, shape);
}

}  // namespace aftershade::tests
