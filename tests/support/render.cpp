#include "tests/support/render.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel/rows.h"

namespace aftershade::tests {

namespace {
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::vector<Plane> planes(size_t count, int width, int height, float fill = 0) {
  std::vector<Plane> out;
  for (size_t i = 0; i < count; ++i) out.emplace_back(width, height, fill);
  return out;
}

struct Radiance {
  Vec3 total{0, 0, 0}, ambient{0, 0, 0};
  double alpha = 0;
};

Radiance radiance(const PlacedScene& placed, const Ray& ray) {
  const Light& light = placed.scene().light;
  const auto hit = placed.trace(ray);
  if (!hit) return {light.sky(ray.direction), Vec3(0), 0};
  const Vec3 albedo = albedo_at(placed.scene().objects[hit->object].material, hit->object_position, hit->object_normal);
  const Vec3 ambient = albedo * light.ambient(hit->normal);
  const Vec3 to_sun = light.to_sun.normalized();
  const double cosine = hit->normal.dot(to_sun);
  const bool lit = cosine > 0 && !placed.blocked({hit->position + hit->normal * kSurfaceOffset_m, to_sun});
  return {ambient + (lit ? albedo * light.sun * cosine : Vec3(0)), ambient, 1};
}

/// The mean over the sample grid of the pixel at (x, y).
Radiance pixel_radiance(const PlacedScene& placed, const RayFan& rays, int x, int y, int side) {
  Radiance sum;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const Radiance sample = radiance(placed, rays(x + (i + 0.5) / side, y + (j + 0.5) / side));
      sum.total += sample.total;
      sum.ambient += sample.ambient;
      sum.alpha += sample.alpha;
    }
  const double weight = 1.0 / (side * side);
  return {sum.total * weight, sum.ambient * weight, sum.alpha * weight};
}

/// The view of a scene at a time before or after, to see where surfaces come from and go to.
struct OtherTime {
  const Scene* scene;
  Camera camera;
  std::vector<Mat4> to_world;

  OtherTime(const Scene& s, double time, int width, int height) : scene(&s), camera(camera_at(s, time, width, height)) {
    for (const Object& object : s.objects) to_world.push_back(object.motion.object_to_world(time));
  }
  Vec3 image_of(const Hit& hit) const {
    const Vec3 world = transform_point(hit.object_position, to_world[hit.object]);
    return camera.project(transform_point(world, *camera.world_to_camera));
  }
  /// Of a point infinitely far; an orthographic camera sees it nowhere else.
  Vec3 image_of(const Vec3& direction, double x, double y) const {
    if (camera.orthographic) return {x, y, 0};
    return camera.project(transform_direction(direction, *camera.world_to_camera));
  }
};

/// The geometry of a frame: what the pixel centre sees.
class GeometryPass {
 public:
  GeometryPass(const PlacedScene& placed, Frame& frame)
      : placed_(placed),
        frame_(frame),
        rays_(*frame.camera),
        before_(placed.scene(), placed.time() - 1, frame.window.width(), frame.window.height()),
        after_(placed.scene(), placed.time() + 1, frame.window.width(), frame.window.height()) {}

  void row(int y) {
    for (int x = 0; x < frame_.window.width(); ++x) {
      const Ray ray = rays_(x + 0.5, y + 0.5);
      const auto hit = placed_.trace(ray);
      if (frame_.has(Role::depth)) frame_.planes(Role::depth)[0](x, y) = hit ? static_cast<float>(hit->t) : kInfinity;
      if (hit && frame_.has(Role::depth2))
        if (const auto behind = placed_.trace_behind(ray, *hit))
          frame_.planes(Role::depth2)[0](x, y) = static_cast<float>(*behind);
      if (hit) put(Role::normal, x, y, transform_direction(hit->normal, *frame_.camera->world_to_camera));
      const Vec3 here(x + 0.5, y + 0.5, 0);
      const auto displacement = [&](const OtherTime& other) {
        return (hit ? other.image_of(*hit) : other.image_of(ray.direction, here.x, here.y)) - here;
      };
      if (frame_.has(Role::velocity_prev)) put(Role::velocity_prev, x, y, displacement(before_));
      if (frame_.has(Role::velocity_next)) put(Role::velocity_next, x, y, displacement(after_));
    }
  }

 private:
  void put(Role role, int x, int y, const Vec3& value) {
    auto& target = frame_.planes(role);
    for (size_t c = 0; c < target.size(); ++c) target[c](x, y) = static_cast<float>(value[static_cast<int>(c)]);
  }

  const PlacedScene& placed_;
  Frame& frame_;
  RayFan rays_;
  OtherTime before_, after_;
};
}  // namespace

RayFan::RayFan(const Camera& camera) : camera_(camera), camera_to_world_(inverse(*camera.world_to_camera).value()) {}

Ray RayFan::operator()(double x_px, double y_px) const {
  const Vec3 on_unit_plane = camera_.unproject(x_px, y_px, 1);
  const Vec3 start = camera_.orthographic ? on_unit_plane - Vec3(0, 0, 1) : Vec3(0);
  return {transform_point(start, camera_to_world_), transform_direction(on_unit_plane - start, camera_to_world_)};
}

Shaded shade(const PlacedScene& placed, const RenderSettings& settings) {
  const RayFan rays(camera_at(placed.scene(), placed.time(), settings.width, settings.height));
  const int side = static_cast<int>(std::ceil(std::sqrt(std::max(1, settings.colour_samples))));
  Shaded out{planes(4, settings.width, settings.height), planes(3, settings.width, settings.height)};
  for_rows(settings.height, [&](int y) {
    for (int x = 0; x < settings.width; ++x) {
      const Radiance pixel = pixel_radiance(placed, rays, x, y, side);
      for (int c = 0; c < 3; ++c) {
        out.rgba[static_cast<size_t>(c)](x, y) = static_cast<float>(pixel.total[c]);
        out.ambient[static_cast<size_t>(c)](x, y) = static_cast<float>(pixel.ambient[c]);
      }
      out.rgba[3](x, y) = static_cast<float>(pixel.alpha);
    }
  });
  return out;
}

Frame render(const Scene& scene, double time, const RenderSettings& settings, RoleSet roles, bool with_layers) {
  const PlacedScene placed(scene, time);
  Frame frame;
  frame.number = static_cast<int>(std::lround(time));
  frame.window = frame.display = {0, 0, settings.width - 1, settings.height - 1};
  frame.camera = camera_at(scene, time, settings.width, settings.height);
  for (const RoleInfo& role : kRoles)
    if (roles.contains(role.role) && role.role != Role::ambient && role.role != Role::ao)
      frame.planes(role.role) = planes(static_cast<size_t>(role.planes), settings.width, settings.height,
                                       role.role == Role::depth2 ? kInfinity : 0);
  GeometryPass geometry(placed, frame);
  for_rows(settings.height, [&](int y) { geometry.row(y); });
  if (!with_layers && !roles.contains(Role::ambient)) return frame;
  Shaded shaded = shade(placed, settings);
  if (roles.contains(Role::ambient)) frame.planes(Role::ambient) = std::move(shaded.ambient);
  if (!with_layers) return frame;
  Layer beauty;
  beauty.channels = {"R", "G", "B", "A"};
  beauty.planes = std::move(shaded.rgba);
  beauty.alpha = 3;
  beauty.receives_ao = beauty.receives_blur = beauty.is_beauty = true;
  beauty.data_window = frame.window;
  frame.layers.push_back(std::move(beauty));
  return frame;
}

}  // namespace aftershade::tests
