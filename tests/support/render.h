#pragma once
#include "core/image/frame.h"
#include "tests/support/placed_scene.h"

namespace aftershade::tests {

struct RenderSettings {
  int width = 240, height = 135;
  int colour_samples = 4;  ///< a pixel, on a regular grid of ceil(sqrt(samples)) squared
};

inline const RoleSet kSceneRoles{Role::depth, Role::normal, Role::velocity_prev, Role::velocity_next, Role::ambient};

/// The scene at `time` as a canonical Frame (DESIGN 2), numbered by the time rounded.
/// Depth, depth2 (when asked for; PlacedScene::trace_behind), normals and velocity are those of the surface point at
/// the pixel centre, unfiltered; on the background depth is +inf, the normal 0, the velocity that of a point infinitely
/// far (camera rotation). A velocity that leads behind the camera is NaN. The beauty ("", R G B A) and ambient are box
/// filtered over the pixel: Lambert with one sun, whose shadow is exact, plus ambient light without any occlusion. The
/// background is the sky's radiance with alpha 0.
Frame render(const Scene& scene, double time, const RenderSettings& settings, RoleSet roles = kSceneRoles,
             bool with_layers = true);

/// The planes R, G, B, A and, when asked, the ambient part's three.
struct Shaded {
  std::vector<Plane> rgba, ambient;
};
Shaded shade(const PlacedScene& placed, const RenderSettings& settings);

/// Primary rays of an image; the direction's t is planar depth.
class RayFan {
 public:
  RayFan(const Camera& camera);
  Ray operator()(double x_px, double y_px) const;

 private:
  Camera camera_;
  Mat4 camera_to_world_;
};

/// A step along the normal that keeps a ray from meeting the surface it leaves.
inline constexpr double kSurfaceOffset_m = 1e-6;

}  // namespace aftershade::tests
