#include "tests/support/placed_scene.h"

#include <algorithm>
#include <array>

namespace aftershade::tests {

namespace {
constexpr size_t kLeafSize = 2;
constexpr double kFlatness_m = 1e-9;  // flat shapes keep a box that rounding cannot miss

Bounds placed_bounds(const Bounds& own, const Mat4& to_world) {
  Bounds out;
  for (int corner = 0; corner < 8; ++corner)
    out.include(transform_point({(corner & 1) != 0 ? own.high.x : own.low.x, (corner & 2) != 0 ? own.high.y : own.low.y,
                                 (corner & 4) != 0 ? own.high.z : own.low.z},
                                to_world));
  return {out.low - Vec3(kFlatness_m), out.high + Vec3(kFlatness_m)};
}

bool meets(const Bounds& bounds, const Ray& ray, const Vec3& inverse_direction) {
  double enter = ray.t_min, leave = ray.t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double t0 = (bounds.low[axis] - ray.origin[axis]) * inverse_direction[axis];
    const double t1 = (bounds.high[axis] - ray.origin[axis]) * inverse_direction[axis];
    enter = std::max(enter, std::min(t0, t1));  // in this order a NaN (0 * inf) leaves the interval as it is
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter <= leave;
}
}  // namespace

PlacedScene::PlacedScene(const Scene& scene, double time) : scene_(&scene), time_(time) {
  std::vector<Bounds> bounds(scene.objects.size());
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const Mat4 to_world = object.motion.object_to_world(time);
    placements_.push_back({to_world, to_world.inverse(), object.motion.is_identity()});
    const auto own = bounds_of(object.shape);
    (own ? order_ : unbounded_).push_back(i);
    if (own) bounds[i] = placed_bounds(*own, to_world);
  }
  if (!order_.empty()) build(0, order_.size(), bounds);
}

/// Splits the longest axis at the median of the centres, down to kLeafSize objects.
void PlacedScene::build(size_t begin, size_t end, const std::vector<Bounds>& bounds) {
  Bounds all, centres;
  for (size_t i = begin; i < end; ++i) {
    all.include(bounds[order_[i]]);
    centres.include(bounds[order_[i]].centre());
  }
  const size_t index = nodes_.size();
  nodes_.push_back({all, static_cast<int>(begin), static_cast<int>(end - begin)});
  if (end - begin <= kLeafSize) return;
  const Vec3 size = centres.high - centres.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const size_t middle = (begin + end) / 2;
  const auto at = [&](size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](size_t a, size_t b) {
    return bounds[a].centre()[axis] < bounds[b].centre()[axis] ||
           (bounds[a].centre()[axis] == bounds[b].centre()[axis] && a < b);
  });
  build(begin, middle, bounds);
  nodes_[index].first = static_cast<int>(nodes_.size());
  nodes_[index].count = 0;
  build(middle, end, bounds);
}

bool PlacedScene::test(size_t object, Ray& ray, std::optional<Nearest>& best) const {
  const Placement& placement = placements_[object];
  Ray local = ray;
  if (!placement.identity) {
    local.origin = transform_point(ray.origin, placement.to_object);
    local.direction = transform_direction(ray.direction, placement.to_object);
  }
  const auto hit = intersect(scene_->objects[object].shape, local);
  if (!hit) return false;
  best = Nearest{*hit, object};
  ray.t_max = hit->t;
  return true;
}

std::optional<PlacedScene::Nearest> PlacedScene::nearest(Ray ray, bool any) const {
  std::optional<Nearest> best;
  for (size_t object : unbounded_)
    if (test(object, ray, best) && any) return best;
  if (nodes_.empty()) return best;
  const Vec3 inverse_direction(1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z);
  std::array<int, 64> stack{};
  size_t depth = 1;
  while (depth > 0) {
    const int index = stack[--depth];
    const Node& node = nodes_[static_cast<size_t>(index)];
    if (!meets(node.bounds, ray, inverse_direction)) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = index + 1;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      if (test(order_[static_cast<size_t>(i)], ray, best) && any) return best;
  }
  return best;
}

bool PlacedScene::blocked(const Ray& ray) const { return nearest(ray, true).has_value(); }

std::optional<double> PlacedScene::trace_distance(const Ray& ray) const {
  const auto best = nearest(ray, false);
  return best ? std::optional(best->surface.t) : std::nullopt;
}

std::optional<double> PlacedScene::trace_behind(Ray ray, const Hit& first) const {
  constexpr double kContact_m = 1e-6;  // nearer than that, surfaces touch
  const auto is_solid = [&](size_t object) {
    const Shape& shape = scene_->objects[object].shape;
    return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Box>(shape) ||
           std::holds_alternative<Cylinder>(shape);
  };
  ray.t_min = first.t + kContact_m;
  std::optional<Nearest> exit;
  if (Ray inside = ray; is_solid(first.object) && test(first.object, inside, exit))
    ray.t_min = exit->surface.t + kContact_m;
  while (const auto next = nearest(ray, false)) {
    const Vec3 outwards = transform_direction(next->surface.normal, placements_[next->object].to_world);
    if (!is_solid(next->object) || outwards.dot(ray.direction) < 0) return next->surface.t;
    ray.t_min = next->surface.t + kContact_m;
  }
  return std::nullopt;
}

std::optional<Hit> PlacedScene::trace(const Ray& ray) const {
  const auto best = nearest(ray, false);
  if (!best) return std::nullopt;
  const Placement& placement = placements_[best->object];
  Hit hit{best->surface.t, best->object, ray.at(best->surface.t), {}, {}, best->surface.normal};
  hit.object_position = transform_point(hit.position, placement.to_object);
  hit.normal = transform_direction(best->surface.normal, placement.to_world);
  if (hit.normal.dot(ray.direction) > 0) hit.normal *= -1;
  return hit;
}

}  // namespace aftershade::tests
