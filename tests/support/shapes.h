#pragma once
#include <optional>
#include <variant>

#include "core/math/linear.h"

/// Analytic surfaces in their own object space (metres, +Y up) and their intersection with rays.
namespace aftershade::tests {

/// Points origin + t * direction; the direction need not be unit, t counts in its lengths.
struct Ray {
  Vec3 origin, direction;
  double t_min = 0, t_max = 1e30;
  Vec3 at(double t) const { return origin + direction * t; }
};

struct SurfaceHit {
  double t;
  Vec3 normal;  ///< unit, object space, on either side of a thin surface
};

struct Bounds {
  Vec3 low{1e30, 1e30, 1e30}, high{-1e30, -1e30, -1e30};
  void include(const Vec3& p);
  void include(const Bounds& b) {
    include(b.low);
    include(b.high);
  }
  Vec3 centre() const { return (low + high) * 0.5; }
};

struct Sphere {
  double radius_m;
};
/// Centred at the origin.
struct Box {
  Vec3 half_m;
};
/// Solid of revolution about +Y, centred at the origin, with flat ends.
struct Cylinder {
  double radius_m, half_height_m;
};
/// The infinite plane y = 0.
struct Ground {};
/// One piece of a thin blade.
struct Triangle {
  Vec3 a, b, c;
};
/// A thin card in the plane z = 0, opaque only inside leaves: hashed discs on a lattice, kept within an ellipse of the
/// card's size.
struct CutOutCard {
  double half_width_m, half_height_m, leaf_m;
  bool opaque(double x, double y) const;
};

using Shape = std::variant<Sphere, Box, Cylinder, Ground, Triangle, CutOutCard>;

/// The nearest intersection with t_min < t < t_max.
std::optional<SurfaceHit> intersect(const Shape& shape, const Ray& ray);
/// nullopt for unbounded shapes.
std::optional<Bounds> bounds_of(const Shape& shape);

}  // namespace aftershade::tests
