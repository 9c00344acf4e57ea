#include <cmath>

#include "core/io/conversions.h"
#include "core/parallel/rows.h"

namespace aftershade::io {

void convert_normals(std::vector<Plane>& normals, const Encoding& encoding, const std::optional<Camera>& camera,
                     Window window) {
  const bool from_world = encoding.normal_space == NormalSpace::world && camera && camera->world_to_camera;
  const Mat4 turn = from_world ? *camera->world_to_camera : Mat4();
  const auto value = [&](size_t plane, int x, int y) {
    return (normals[plane](x, y) - encoding.neutral) * encoding.scale[plane];
  };
  for_rows(normals[0].height(), [&](int y) {
    for (int x = 0; x < normals[0].width(); ++x) {
      Vec3 n = transform_direction(Vec3(value(0, x, y), value(1, x, y), value(2, x, y)), turn);
      const double length = n.length();
      // Averaged normals of a silhouette may be short; those shorter than this are background.
      n = length >= 0.1 && std::isfinite(length) ? n / length : Vec3(0);
      const bool has_rays = camera && !camera->orthographic;
      const Vec3 ray = has_rays ? camera->unproject(window.min_x + x + 0.5, window.min_y + y + 0.5, 1) : Vec3(0, 0, 1);
      if (n.dot(ray) > 0) n = -n;
      normals[0](x, y) = static_cast<float>(n.x);
      normals[1](x, y) = static_cast<float>(n.y);
      normals[2](x, y) = static_cast<float>(n.z);
    }
  });
}

}  // namespace aftershade::io
