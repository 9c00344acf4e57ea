#pragma once
#include <optional>

#include "core/math/linear.h"

namespace aftershade {

/// A camera in canonical form (DESIGN 2): row vectors; camera space +X right, +Y up, +Z forward, in metres; image
/// x right and y down in pixels of the display window's coordinate system, pixel (i, j) centred at (i+0.5, j+0.5).
/// Perspective: x = cx + fx X/Z, y = cy - fy Y/Z. Orthographic: x = cx + fx X, y = cy - fy Y.
struct Camera {
  /// World (metres) to camera space. Without it ("depth-only") the camera knows its lens but not where it stands.
  std::optional<Mat4> world_to_camera;
  double fx = 1, fy = 1;  ///< focal length in pixels (perspective) or pixels per metre (orthographic), both positive
  double cx = 0, cy = 0;  ///< principal point in absolute pixel coordinates
  bool orthographic = false;
  std::optional<double> near_m, far_m;  ///< clip planes, for device depth

  /// Camera-space point of pixel position (x, y) at planar depth z.
  Vec3 unproject(double x, double y, double z) const;
  /// Pixel position and depth of a camera-space point: {x, y, Z}. Points with Z <= 0 have no image (NaN) in
  /// perspective.
  Vec3 project(Vec3 p) const;
};

/// A camera without position: square pixels are assumed unless pixel_aspect (width / height of a pixel) says otherwise.
/// `horizontal_fov_deg` in (0, 180); width and height of the display window, whose corner is (min_x, min_y).
Camera camera_from_fov(double horizontal_fov_deg, double pixel_aspect, int min_x, int min_y, int width, int height);

/// Where a static surface seen by `now` at (x, y), depth z, was seen by `before`: {x', y', z'}; nullopt when either
/// camera has no position or its matrix is singular. Evaluated through one matrix, "delta": now -> world -> before.
class CameraReprojection {
 public:
  static std::optional<CameraReprojection> create(const Camera& now, const Camera& before);
  Vec3 operator()(double x, double y, double z) const {
    return before_.project(transform_point(now_.unproject(x, y, z), delta_));
  }
  const Mat4& delta() const { return delta_; }
  const Camera& now() const { return now_; }
  const Camera& before() const { return before_; }

 private:
  Camera now_, before_;
  Mat4 delta_;
};

/// The lens in the index space of a plane, in float, for kernels. Pixel (i, j) is seen along
/// ((i + 0.5 - cx) / fx, -(j + 0.5 - cy) / fy, 1).
struct Projection {
  float fx = 1, fy = 1, cx = 0, cy = 0;
  bool orthographic = false;
};
/// The projection of `camera` for planes whose index (0, 0) is absolute pixel (min_x, min_y).
Projection local_projection(const Camera& camera, int min_x, int min_y);

}  // namespace aftershade
