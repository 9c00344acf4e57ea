#pragma once
#include <optional>
#include <vector>

#include "tests/support/scene.h"

namespace aftershade::tests {

/// A point of a surface as a ray sees it, in world space.
struct Hit {
  double t;       ///< in lengths of the ray's direction
  size_t object;  ///< index in Scene::objects
  Vec3 position;
  Vec3 normal;           ///< unit, turned towards the ray's origin
  Vec3 object_position;  ///< the same point in the object's own space: it keeps this for all times
  Vec3 object_normal;    ///< as the shape has it
};

/// A scene at one time, ready for rays: objects placed, a hierarchy of boxes around them.
class PlacedScene {
 public:
  PlacedScene(const Scene& scene, double time);
  std::optional<Hit> trace(const Ray& ray) const;
  /// The distance t of the nearest hit alone; nullopt when the ray is free.
  std::optional<double> trace_distance(const Ray& ray) const;
  bool blocked(const Ray& ray) const;  ///< is there any hit?
  /// The t of the next surface that shows once the ray has left the object of its `first` hit: where it enters another
  /// solid or meets a thin surface. Solids that overlap count as one; the floor under what stands on it does not show.
  std::optional<double> trace_behind(Ray ray, const Hit& first) const;
  const Scene& scene() const { return *scene_; }
  double time() const { return time_; }

 private:
  struct Placement {
    Mat4 to_world, to_object;
    bool identity;
  };
  struct Node {
    Bounds bounds;
    int first, count;  ///< leaf: range of order_; inner node (count 0): children at index + 1 and at `first`
  };
  struct Nearest {
    SurfaceHit surface;
    size_t object;
  };
  void build(size_t begin, size_t end, const std::vector<Bounds>& bounds);
  bool test(size_t object, Ray& ray, std::optional<Nearest>& best) const;
  std::optional<Nearest> nearest(Ray ray, bool any) const;

  const Scene* scene_;
  double time_;
  std::vector<Placement> placements_;
  std::vector<size_t> order_, unbounded_;
  std::vector<Node> nodes_;
};

}  // namespace aftershade::tests
