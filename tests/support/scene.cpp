#include "tests/support/scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/sampling.h"

namespace aftershade::tests {

namespace {
double random_of_cell(int i, int j) {
  return static_cast<double>(unit_float(hash_counters(static_cast<uint32_t>(i), static_cast<uint32_t>(j), 7)));
}

int cell(double x) { return static_cast<int>(std::floor(x)); }
double fraction(double x) { return x - std::floor(x); }
Vec3 mix(const Vec3& a, const Vec3& b, double t) { return a * (1 - t) + b * t; }

/// Value noise: hashed corner values, smoothly interpolated.
double smooth_noise(double u, double v) {
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const int i = cell(u), j = cell(v);
  const double s = ease(fraction(u)), t = ease(fraction(v));
  const double below = random_of_cell(i, j) * (1 - s) + random_of_cell(i + 1, j) * s;
  const double above = random_of_cell(i, j + 1) * (1 - s) + random_of_cell(i + 1, j + 1) * s;
  return below * (1 - t) + above * t;
}

/// A piece with joints around it, each piece with its own brightness.
Vec3 piece(const Material& material, double u, double v, double joint_u, double joint_v) {
  if (fraction(u) < joint_u || fraction(v) < joint_v) return material.second;
  return material.albedo * (0.75 + 0.4 * random_of_cell(cell(u), cell(v)));
}

struct TexturePoint {
  double u, v;
};
TexturePoint texture_point(const Vec3& p, const Vec3& normal) {
  const Vec3 n(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
  if (n.y >= n.x && n.y >= n.z) return {p.x, p.z};
  return n.z >= n.x ? TexturePoint{p.x, p.y} : TexturePoint{p.z, p.y};
}
}  // namespace

Mat4 Motion::object_to_world(double time) const {
  Mat4 turn;
  turn.setAxisAngle(spin_axis, 2 * std::numbers::pi * (spin_turns + spin_turns_per_frame * time));
  const double angle = 2 * std::numbers::pi * (orbit_turns + orbit_turns_per_frame * time);
  const Vec3 orbit = Vec3(std::cos(angle), 0, std::sin(angle)) * orbit_radius_m;
  return turn * Mat4().setTranslation(origin + velocity * time + orbit);
}

bool Motion::is_identity() const {
  return origin == Vec3(0) && velocity == Vec3(0) && orbit_radius_m == 0 && spin_turns == 0 &&
         spin_turns_per_frame == 0;
}

Vec3 albedo_at(const Material& material, const Vec3& p, const Vec3& normal) {
  const TexturePoint at = texture_point(p, normal);
  const double u = at.u / material.scale_m, v = at.v / material.scale_m;
  switch (material.pattern) {
    case Pattern::plain:
      return material.albedo;
    case Pattern::checker:
      return (cell(u) + cell(v)) % 2 == 0 ? material.albedo : material.second;
    case Pattern::tiles:
      return piece(material, u, v, 0.03, 0.03);
    case Pattern::bricks:
      return piece(material, u + (cell(2 * v) % 2 == 0 ? 0.0 : 0.5), 2 * v, 0.05, 0.1);
    case Pattern::stripes:
      return cell(u) % 2 == 0 ? material.albedo : material.second;
    case Pattern::octants:
      return (p.x > 0) ^ (p.y > 0) ^ (p.z > 0) ? material.albedo : material.second;
    case Pattern::mottled:
      return mix(material.albedo, material.second, smooth_noise(u, v));
  }
  return material.albedo;
}

Vec3 Light::sky(const Vec3& direction) const {
  return mix(horizon, zenith, std::sqrt(std::max(0.0, direction.normalized().y)));
}

Vec3 Light::ambient(const Vec3& normal) const {
  const Vec3 above = mix(horizon, zenith, 0.5);
  return mix(ground, above, 0.5 + 0.5 * normal.y);
}

Camera camera_at(const Scene& scene, double time, int width, int height) {
  const CameraPath& path = scene.camera;
  Camera camera = camera_from_fov(path.horizontal_fov_deg, 1, 0, 0, width, height);
  camera.orthographic = path.orthographic_width_m > 0;
  if (camera.orthographic) camera.fx = camera.fy = width / path.orthographic_width_m;
  const Vec3 eye = path.eye.object_to_world(time).translation(),
             target = path.target.object_to_world(time).translation();
  const Vec3 forward = (target - eye).normalized();
  const Vec3 right = forward.cross(Vec3(0, 1, 0)).normalized(), up = right.cross(forward);
  const Mat4 camera_to_world(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, forward.x, forward.y, forward.z, 0,  //
                             eye.x, eye.y, eye.z, 1);
  camera.world_to_camera = inverse(camera_to_world);
  return camera;
}

}  // namespace aftershade::tests
