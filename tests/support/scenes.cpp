#include "tests/support/scenes.h"

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/math/sampling.h"

namespace aftershade::tests {

namespace {
Motion at(const Vec3& origin, const Vec3& velocity = Vec3(0)) {
  Motion motion;
  motion.origin = origin;
  motion.velocity = velocity;
  return motion;
}

const Material kStone{{0.55, 0.52, 0.47}, {0.30, 0.28, 0.25}, Pattern::tiles, 0.4};
const Material kChalk{{0.68, 0.66, 0.62}};
const Material kClay{{0.48, 0.20, 0.12}, {0.45, 0.42, 0.38}, Pattern::bricks, 0.3};

Scene corner() {
  Scene scene{"corner", "a floor (y = 0) with a perpendicular wall (z = 0), seen at 45 degrees", {}, {}, {}};
  scene.objects = {{Ground{}, kChalk}, {Box{{50, 50, 1}}, kChalk, at({0, 0, -1})}};
  scene.camera = {at({0, 2.5, 2.5}), at({0, 0, 0})};
  return scene;
}

Scene columns() {
  Scene scene{"columns", "a field of square and round columns, passed by a moving camera", {}, {}, {}};
  scene.objects = {{Ground{}, kStone}};
  for (int j = 0; j < 6; ++j)
    for (int i = -4; i <= 4; ++i) {
      const Vec3 foot(1.6 * i + 0.8 * (j % 2), 0, -1.8 * j);
      scene.objects.push_back({Box{{0.35, 0.08, 0.35}}, kChalk, at(foot + Vec3(0, 0.08, 0))});
      const Motion shaft = at(foot + Vec3(0, 1.56, 0));
      if ((i + j) % 2 == 0)
        scene.objects.push_back({Box{{0.22, 1.4, 0.22}}, kClay, shaft});
      else
        scene.objects.push_back({Cylinder{0.24, 1.4}, kChalk, shaft});
    }
  scene.camera = {at({-1.2, 1.7, 4.5}, {0.16, 0, -0.1}), at({-0.4, 1.0, -3}, {0.1, 0, -0.1}), 60};
  return scene;
}

Scene grass() {
  Scene scene{"grass", "thin blades on uneven soil; the camera moves sideways (flicker)", {}, {}, {}};
  scene.objects = {{Ground{}, {{0.16, 0.12, 0.07}, {0.10, 0.13, 0.05}, Pattern::mottled, 0.2}}};
  add_lawn(scene.objects, {-3.5, 3.5, -5, 1, 6000});
  scene.objects.push_back({Sphere{0.3}, kChalk, at({-0.5, 0.3, -0.6})});
  scene.camera = {at({-0.4, 0.8, 2.4}, {0.04, 0, 0}), at({-0.1, 0.15, -0.8}, {0.03, 0, 0})};
  return scene;
}

Scene trail() {
  Scene scene{"trail", "a box slides over a static floor close to a static camera (trailing)", {}, {}, {}};
  scene.objects = {{Ground{}, {{0.5, 0.5, 0.5}, {0.35, 0.35, 0.35}, Pattern::checker, 0.25}},
                   {Box{{0.25, 0.3, 0.25}}, kClay, at({-0.9, 0.3, 0.1}, {0.18, 0, 0})},
                   {Sphere{0.2}, kChalk, at({0.5, 0.2, -0.7})}};
  scene.camera = {at({0, 1.8, 2.2}), at({0, 0, 0})};
  return scene;
}

Scene crossing() {
  Scene scene{"crossing", "fast objects cross before a textured wall, a static pole among them (blur)", {}, {}, {}};
  const Vec3 middle(0, 1.5, 0);
  const auto crossing_at = [&](const Vec3& where, const Vec3& velocity) {
    return at(where - velocity * 4.5, velocity);
  };
  Motion wheel = at(middle + Vec3(-1.4, 0.7, -2));
  wheel.orbit_radius_m = 0.9;
  wheel.orbit_turns_per_frame = 0.06;
  Motion spinning_card = crossing_at(middle + Vec3(1.2, 0.2, 0.8), {0, -0.22, 0});
  spinning_card.spin_turns_per_frame = 0.02;
  scene.objects = {
      {Box{{12, 12, 0.2}}, kClay, at({0, 0, -4})},
      {Sphere{0.55},
       {{0.7, 0.15, 0.1}, {0.8, 0.75, 0.65}, Pattern::octants},
       crossing_at(middle + Vec3(0, -0.7, 0), {0.4, 0, 0})},
      {Box{{0.6, 0.35, 0.35}},
       {{0.1, 0.25, 0.6}, {0.6, 0.6, 0.2}, Pattern::stripes, 0.3},
       crossing_at(middle + Vec3(0, 0.6, -1), {-0.5, 0, 0})},
      {Sphere{0.35}, kChalk, wheel},
      {CutOutCard{0.6, 0.8, 0.16}, {{0.15, 0.35, 0.08}, {0.3, 0.45, 0.1}, Pattern::mottled, 0.2}, spinning_card},
      {Cylinder{0.08, 6}, kChalk, at(middle + Vec3(-0.5, 0, 1))}};
  scene.camera = {at({0, 1.5, 6}), at({0, 1.5, 0})};
  return scene;
}
}  // namespace

void add_lawn(std::vector<Object>& objects, const Lawn& lawn) {
  const auto random = [&](int blade, uint32_t index) {
    return static_cast<double>(unit_float(hash_counters(static_cast<uint32_t>(blade), lawn.seed, 0, index)));
  };
  for (int blade = 0; blade < lawn.count; ++blade) {
    const Vec3 root(lawn.x0 + (lawn.x1 - lawn.x0) * random(blade, 1), 0,
                    lawn.z0 + (lawn.z1 - lawn.z0) * random(blade, 2));
    const double height = lawn.height_m * (0.5 + 0.7 * random(blade, 3)),
                 turn = 2 * std::numbers::pi * random(blade, 4);
    const Vec3 across(0.5 * lawn.width_m * std::cos(turn), 0, 0.5 * lawn.width_m * std::sin(turn));
    const double lean_turn = 2 * std::numbers::pi * random(blade, 5), lean = height * (0.15 + 0.5 * random(blade, 6));
    const auto spine = [&](double t) {
      return root +
             Vec3(lean * t * t * std::cos(lean_turn), height * t * (1 - 0.2 * t), lean * t * t * std::sin(lean_turn));
    };
    const Vec3 tone = Vec3(0.10, 0.22, 0.04) * (1 - random(blade, 7)) + Vec3(0.30, 0.40, 0.09) * random(blade, 7);
    const Material green{tone, tone};
    Vec3 left = spine(0) - across, right = spine(0) + across;
    for (double t : {0.4, 0.75}) {
      const Vec3 next_left = spine(t) - across * (1 - t * t), next_right = spine(t) + across * (1 - t * t);
      objects.push_back({Triangle{left, right, next_right}, green});
      objects.push_back({Triangle{left, next_right, next_left}, green});
      left = next_left;
      right = next_right;
    }
    objects.push_back({Triangle{left, right, spine(1)}, green});
  }
}

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all = [] {
    std::vector<Scene> list;
    for (Scene (*make)() : {corner, columns, grass, trail, crossing, garden_scene}) list.push_back(make());
    return list;
  }();
  return all;
}

const Scene& find_scene(std::string_view name) {
  std::vector<std::string> names;
  for (const Scene& scene : scenes()) {
    if (scene.name == name) return scene;
    names.push_back(scene.name);
  }
  throw Error(ErrorCode::usage, cat("there is no scene \"", name, "\""), cat("the scenes are ", join(names, ", ")));
}

}  // namespace aftershade::tests
