#include "core/camera/camera.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace aftershade {

Vec3 Camera::unproject(double x, double y, double z) const {
  const double scale = orthographic ? 1.0 : z;
  return {(x - cx) / fx * scale, -(y - cy) / fy * scale, z};
}

Vec3 Camera::project(Vec3 p) const {
  if (orthographic) return {cx + fx * p.x, cy - fy * p.y, p.z};
  if (!(p.z > 0)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, p.z};
  }
  return {cx + fx * p.x / p.z, cy - fy * p.y / p.z, p.z};
}

Camera camera_from_fov(double horizontal_fov_deg, double pixel_aspect, int min_x, int min_y, int width, int height) {
  Camera camera;
  camera.fx = 0.5 * width / std::tan(horizontal_fov_deg * std::numbers::pi / 360);
  camera.fy = camera.fx * pixel_aspect;
  camera.cx = min_x + 0.5 * width;
  camera.cy = min_y + 0.5 * height;
  return camera;
}

std::optional<CameraReprojection> CameraReprojection::create(const Camera& now, const Camera& before) {
  if (!now.world_to_camera || !before.world_to_camera) return std::nullopt;
  const auto camera_to_world = inverse(*now.world_to_camera);
  if (!camera_to_world) return std::nullopt;
  CameraReprojection out;
  out.now_ = now;
  out.before_ = before;
  out.delta_ = *camera_to_world * *before.world_to_camera;
  return out;
}

Projection local_projection(const Camera& camera, int min_x, int min_y) {
  return {static_cast<float>(camera.fx), static_cast<float>(camera.fy), static_cast<float>(camera.cx - min_x),
          static_cast<float>(camera.cy - min_y), camera.orthographic};
}

}  // namespace aftershade
