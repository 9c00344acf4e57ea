#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/image/frame.h"
#include "core/motionblur/motion.h"
#include "core/parallel/rows.h"
#include "tests/support/render.h"

/// Disocclusion: the pixels where, during the shutter, a surface becomes visible that the frame itself does not show.
/// A blur of one frame alone must guess there. Masks are 1 there, 0 elsewhere; the shutter is centred on the frame.
namespace aftershade::tests {

/// A scene at the frame's time, asked whether it shows the surfaces that other times show.
class ShownInFrame {
 public:
  ShownInFrame(const Scene& scene, double time, int width, int height)
      : placed_(scene, time), camera_(camera_at(scene, time, width, height)), rays_(camera_), size_{width, height} {
    for (const Object& object : scene.objects) to_world_.push_back(object.motion.object_to_world(time));
  }

  /// Is the point of an object that was hit at another time to be seen in the frame?
  bool shows(const Hit& hit) const {
    const Vec3 position = transform_point(hit.object_position, to_world_[hit.object]);
    const Vec3 image = camera_.project(transform_point(position, *camera_.world_to_camera));
    if (!inside(image)) return false;
    const auto here = placed_.trace(rays_(image.x, image.y));
    return here && here->object == hit.object && std::abs(here->t - image.z) <= kSameDepth * image.z;
  }
  /// Is the background in this direction to be seen?
  bool shows_background(const Vec3& direction) const {
    const Vec3 image = camera_.project(transform_direction(direction, *camera_.world_to_camera));
    return camera_.orthographic || (inside(image) && !placed_.trace_distance(rays_(image.x, image.y)));
  }

 private:
  static constexpr double kSameDepth = 1e-4;  ///< relative; objects are not thinner
  bool inside(const Vec3& image) const {
    return image.x >= 0 && image.y >= 0 && image.x < size_[0] && image.y < size_[1];
  }

  PlacedScene placed_;
  Camera camera_;
  RayFan rays_;
  int size_[2];
  std::vector<Mat4> to_world_;
};

/// Exact at the pixel centres and at the middles of `samples` equal parts of the shutter.
inline Plane disocclusion_truth(const Scene& scene, double time, double shutter_frames, int samples, int width,
                                int height) {
  const ShownInFrame frame(scene, time, width, height);
  Plane mask(width, height);
  for (int i = 0; i < samples; ++i) {
    const double when = time + shutter_frames * ((i + 0.5) / samples - 0.5);
    const PlacedScene placed(scene, when);
    const RayFan rays(camera_at(scene, when, width, height));
    for_rows(height, [&](int y) {
      for (int x = 0; x < width; ++x) {
        if (mask(x, y) > 0) continue;
        const Ray ray = rays(x + 0.5, y + 0.5);
        const auto hit = placed.trace(ray);
        mask(x, y) = (hit ? frame.shows(*hit) : frame.shows_background(ray.direction)) ? 0.0F : 1.0F;
      }
    });
  }
  return mask;
}

/// Of the pixels that a mask marks.
inline double share_of(ConstPlaneView mask) {
  double sum = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) sum += static_cast<double>(mask(x, y));
  return sum / (mask.width * mask.height);
}

/// Marks the pixels within reach of a surface point that lies at (x, y).
inline void cover(PlaneView covered, double x, double y) {
  constexpr double kReach_px = 0.6;  // 0.5 tiles an even image; the rest closes cracks where it stretches, up to 1.2
  const int x0 = std::max(0, static_cast<int>(std::ceil(x - 0.5 - kReach_px)));
  const int x1 = std::min(covered.width - 1, static_cast<int>(std::floor(x - 0.5 + kReach_px)));
  const int y0 = std::max(0, static_cast<int>(std::ceil(y - 0.5 - kReach_px)));
  const int y1 = std::min(covered.height - 1, static_cast<int>(std::floor(y - 0.5 + kReach_px)));
  for (int j = y0; j <= y1; ++j)
    for (int i = x0; i <= x1; ++i) covered(i, j) = 1;
}

/// What a file can tell of it: the pixels that at one of the middles of `samples` equal parts of the shutter none of
/// the frame's own surfaces reaches, each moved along the parabola of its two vectors. Strips narrower than a fifth of
/// a pixel are missed, and so is what appears before other surfaces. A vector that is not finite counts as 0. Needs
/// velocity_prev and velocity_next.
inline Plane disocclusion_of(const Frame& frame, double shutter_frames, int samples) {
  const auto& prev = frame.planes(Role::velocity_prev);
  const auto& next = frame.planes(Role::velocity_next);
  const int width = prev.at(0).width(), height = prev[0].height();
  const auto place = [&](size_t axis, int x, int y, float t) {
    const float d = motionblur::displacement(motionblur::Path::curved, prev[axis](x, y), next.at(axis)(x, y), t);
    return (axis == 0 ? x : y) + 0.5 + (std::isfinite(d) ? static_cast<double>(d) : 0.0);
  };
  Plane mask(width, height);
  for (int i = 0; i < samples; ++i) {
    const auto t = static_cast<float>(shutter_frames * ((i + 0.5) / samples - 0.5));
    Plane covered(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) cover(covered, place(0, x, y, t), place(1, x, y, t));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) mask(x, y) = std::max(mask(x, y), 1 - covered(x, y));
  }
  return mask;
}

}  // namespace aftershade::tests
