#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/camera/camera.h"
#include "tests/support/shapes.h"

/// What a synthetic scene is made of. World space: metres, right-handed, +Y up. Time counts in frames.
namespace aftershade::tests {

/// A rigid motion, linear and orbital: turned about an axis through the object's origin, then carried along.
struct Motion {
  Vec3 origin{0, 0, 0};       ///< at time 0
  Vec3 velocity{0, 0, 0};     ///< metres per frame
  double orbit_radius_m = 0;  ///< circle in the xz plane about the moving origin
  double orbit_turns = 0;     ///< at time 0
  double orbit_turns_per_frame = 0;
  Vec3 spin_axis{0, 1, 0};  ///< unit
  double spin_turns = 0;    ///< at time 0, right-handed
  double spin_turns_per_frame = 0;

  Mat4 object_to_world(double time) const;
  bool is_identity() const;
};

/// How albedo varies over an object, in object space, so that it moves with it.
enum class Pattern {
  plain,    ///< first albedo
  checker,  ///< squares of scale_m
  tiles,    ///< squares of scale_m in the first albedo, each a little different, with joints in the second
  bricks,   ///< 2:1 bricks of width scale_m in running bond, joints in the second albedo
  stripes,  ///< bands of scale_m across the first texture axis
  octants,  ///< the eight octants about the origin, alternately (spheres)
  mottled,  ///< a mix of both that changes smoothly over scale_m
};
struct Material {
  Vec3 albedo{0.5, 0.5, 0.5}, second{0.5, 0.5, 0.5};  ///< diffuse, linear Rec.709
  Pattern pattern = Pattern::plain;
  double scale_m = 1;
};
/// Albedo at an object-space point whose object-space normal tells which side of the object is meant.
Vec3 albedo_at(const Material& material, const Vec3& p, const Vec3& normal);

struct Object {
  Shape shape;
  Material material;
  Motion motion{};
};

struct CameraPath {
  Motion eye, target;  ///< the camera stands at one's origin and looks at the other's, upright
  double horizontal_fov_deg = 50;
  double orthographic_width_m = 0;  ///< above 0: an orthographic camera that sees this width
};

/// Sun (a direction) and sky (ambient light that knows no occlusion: what a compositor's AO is applied to).
struct Light {
  Vec3 to_sun{0.5, 0.7, 0.5};                                ///< made unit where used
  Vec3 sun{1.35, 1.24, 1.05};                                ///< irradiance across the sun's direction / pi
  Vec3 zenith{0.36, 0.48, 0.70}, horizon{0.62, 0.64, 0.66};  ///< sky radiance
  Vec3 ground{0.22, 0.19, 0.15};                             ///< radiance from below

  Vec3 sky(const Vec3& direction) const;   ///< radiance of the background
  Vec3 ambient(const Vec3& normal) const;  ///< mean radiance from the normal's side
};

struct Scene {
  std::string name, description;
  std::vector<Object> objects;
  CameraPath camera;
  Light light;
};

/// The camera of an image of this size: display window (0, 0) to (width - 1, height - 1), square pixels.
Camera camera_at(const Scene& scene, double time, int width, int height);

}  // namespace aftershade::tests
