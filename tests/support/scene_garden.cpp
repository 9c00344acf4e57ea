#include "tests/support/scenes.h"

/// The sample of the quickstart: everything the effects are for in one picture.
namespace aftershade::tests {

namespace {
const Material kTiles{{0.44, 0.37, 0.29}, {0.24, 0.21, 0.18}, Pattern::tiles, 0.36};
const Material kBricks{{0.42, 0.19, 0.12}, {0.44, 0.40, 0.35}, Pattern::bricks, 0.34};
const Material kLimestone{{0.60, 0.56, 0.49}};
const Material kWood{{0.36, 0.22, 0.12}, {0.30, 0.18, 0.10}, Pattern::stripes, 0.05};
const Material kTerracotta{{0.60, 0.27, 0.15}};
const Material kLeaves{{0.08, 0.22, 0.05}, {0.22, 0.38, 0.08}, Pattern::mottled, 0.08};
const Material kBall{{0.75, 0.08, 0.05}, {0.85, 0.80, 0.72}, Pattern::octants};
const Material kPaint{{0.08, 0.28, 0.50}};
const Material kSoil{{0.13, 0.10, 0.06}, {0.09, 0.13, 0.04}, Pattern::mottled, 0.15};
constexpr double kTerraceTop_m = 0.08;

class Builder {
 public:
  explicit Builder(std::vector<Object>& objects) : objects_(objects) {}

  void put(const Shape& shape, const Material& material, const Vec3& where, double turns = 0) {
    Motion motion;
    motion.origin = where;
    motion.spin_turns = turns;
    objects_.push_back({shape, material, motion});
  }
  /// Rolls or slides so that it passes `where` at the middle of frames 1 to 8.
  void put_moving(const Shape& shape, const Material& material, const Vec3& where, const Vec3& velocity,
                  double turns_per_frame = 0) {
    Motion motion;
    motion.origin = where - velocity * 4.5;
    motion.velocity = velocity;
    motion.spin_axis = {0, 0, 1};
    motion.spin_turns_per_frame = turns_per_frame;
    objects_.push_back({shape, material, motion});
  }

  void walls() {
    put(Box{{6, 0.95, 0.15}}, kBricks, {0, 0.95, -2.6});
    put(Box{{6.1, 0.05, 0.22}}, kLimestone, {0, 1.95, -2.6});
    put(Box{{0.15, 0.5, 1.8}}, kBricks, {3.35, 0.5, -0.8});
    put(Box{{0.22, 0.05, 1.85}}, kLimestone, {3.35, 1.05, -0.8});
  }
  void column(double x, double z) {
    put(Box{{0.24, 0.1, 0.24}}, kLimestone, {x, kTerraceTop_m + 0.1, z});
    put(Cylinder{0.15, 0.85}, kLimestone, {x, kTerraceTop_m + 1.05, z});
    put(Box{{0.22, 0.06, 0.22}}, kLimestone, {x, kTerraceTop_m + 1.96, z});
  }
  void pergola() {
    for (double x : {-2.0, -0.1, 1.8}) column(x, -1.1);
    put(Box{{2.5, 0.09, 0.12}}, kWood, {-0.1, kTerraceTop_m + 2.11, -1.1});
    for (int i = 0; i < 9; ++i) put(Box{{0.05, 0.06, 0.95}}, kWood, {-2.5 + 0.6 * i, kTerraceTop_m + 2.26, -1.65});
  }
  void bench(const Vec3& where) {
    for (int plank = 0; plank < 4; ++plank)
      put(Box{{0.7, 0.02, 0.045}}, kWood, where + Vec3(0, 0.42, 0.11 * plank - 0.165));
    for (double x : {-0.55, 0.55}) put(Box{{0.05, 0.2, 0.2}}, kLimestone, where + Vec3(x, 0.2, 0));
  }
  void pot(const Vec3& where, double size_m) {
    put(Cylinder{0.5 * size_m, 0.45 * size_m}, kTerracotta, where + Vec3(0, 0.45 * size_m, 0));
    put(Cylinder{0.58 * size_m, 0.07 * size_m}, kTerracotta, where + Vec3(0, 0.92 * size_m, 0));
    for (double turns : {0.02, 0.19, 0.35})
      put(CutOutCard{0.95 * size_m, 0.85 * size_m, 0.22 * size_m}, kLeaves, where + Vec3(0, 1.7 * size_m, 0), turns);
  }
  void cart(const Vec3& where, const Vec3& velocity) {
    constexpr double kWheel_m = 0.11;
    const double turns = -velocity.x / (2 * 3.14159265358979 * kWheel_m);
    put_moving(Box{{0.34, 0.1, 0.2}}, kPaint, where + Vec3(0, 0.26, 0), velocity);
    put_moving(Box{{0.14, 0.09, 0.16}}, kLimestone, where + Vec3(0.08, 0.45, 0), velocity);
    for (double x : {-0.22, 0.22})
      for (double z : {-0.2, 0.2}) put_moving(Sphere{kWheel_m}, kBall, where + Vec3(x, kWheel_m, z), velocity, turns);
  }

 private:
  std::vector<Object>& objects_;
};
}  // namespace

Scene garden_scene() {
  Scene scene{
      "garden", "a walled garden: tiles, pergola, grass, a rolling ball and a cart, camera trucking", {}, {}, {}};
  Builder garden(scene.objects);
  scene.objects.push_back({Ground{}, kSoil});
  garden.put(Box{{2.9, kTerraceTop_m / 2, 1.75}}, kTiles, {0.1, kTerraceTop_m / 2, -0.05});
  garden.walls();
  garden.pergola();
  garden.bench({0.85, kTerraceTop_m, -1.45});
  garden.pot({-1.05, kTerraceTop_m, -0.75}, 0.32);
  garden.pot({2.6, kTerraceTop_m, -0.35}, 0.4);
  garden.pot({2.45, kTerraceTop_m, 0.55}, 0.24);
  garden.put(Box{{0.2, 0.22, 0.2}}, kLimestone, {-2.3, kTerraceTop_m + 0.22, 0.45}, 0.06);
  garden.put(Sphere{0.24}, kLimestone, {-2.3, kTerraceTop_m + 0.68, 0.45});
  constexpr double kBallRadius_m = 0.23, kBallSpeed_m = 0.26;
  garden.put_moving(Sphere{kBallRadius_m}, kBall, {-0.1, kTerraceTop_m + kBallRadius_m, 0.75}, {kBallSpeed_m, 0, 0},
                    -kBallSpeed_m / (2 * 3.14159265358979 * kBallRadius_m));
  garden.cart({1.2, kTerraceTop_m, -0.3}, {-0.15, 0, 0});
  add_lawn(scene.objects, {-3.4, 3.6, 1.76, 3.0, 4400, 0.24, 0.012, 1});
  add_lawn(scene.objects, {-3.6, 3.2, -2.4, -1.85, 1200, 0.32, 0.014, 2});
  add_lawn(scene.objects, {-4.4, -2.85, -1.8, 1.7, 1800, 0.28, 0.013, 3});
  scene.light.to_sun = {-0.5, 0.72, 0.42};
  scene.camera.eye.origin = {-0.75, 1.75, 5.6};
  scene.camera.eye.velocity = {0.06, 0, 0};
  scene.camera.target.origin = {-0.1, 0.84, 0};
  scene.camera.target.velocity = {0.035, 0, 0};
  scene.camera.horizontal_fov_deg = 52;
  return scene;
}

}  // namespace aftershade::tests
