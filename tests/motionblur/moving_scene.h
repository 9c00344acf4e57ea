#pragma once
#include <cstring>
#include <functional>
#include <limits>

#include "core/motionblur/motion.h"
#include "tests/motionblur/blur_scene.h"

/// Scenes for the blurs that follow surfaces along their paths.
namespace aftershade::tests {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();

struct Surface {
  float depth, prev_x, prev_y, next_x, next_y;
};

struct MovingScene {
  Window window;
  motionblur::Motion motion;
  Plane depth;
  std::vector<Plane> channels;
};

/// Coordinates are absolute.
inline MovingScene make_scene(Window window, const std::function<Surface(int, int)>& surface, int channels = 1) {
  const int width = window.width(), height = window.height();
  const auto plane = [&] { return Plane(width, height); };
  MovingScene scene{window, {plane(), plane(), plane(), plane()}, plane(), {}};
  for (int c = 0; c < channels; ++c) scene.channels.push_back(plane());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int ax = x + window.min_x, ay = y + window.min_y;
      const Surface s = surface(ax, ay);
      scene.depth(x, y) = s.depth;
      scene.motion.prev_x(x, y) = s.prev_x;
      scene.motion.prev_y(x, y) = s.prev_y;
      scene.motion.next_x(x, y) = s.next_x;
      scene.motion.next_y(x, y) = s.next_y;
      for (int c = 0; c < channels; ++c)
        scene.channels[static_cast<size_t>(c)](x, y) = noise(ax + 100, ay + 100, static_cast<uint32_t>(c), 0, 1);
    }
  return scene;
}

inline bool same_bits(const Plane& a, const Plane& b) {
  for (int y = 0; y < a.height(); ++y)
    if (std::memcmp(a.row(y), b.row(y), sizeof(float) * static_cast<size_t>(a.width())) != 0) return false;
  return a.width() == b.width() && a.height() == b.height();
}

/// Two boxes that move on curves, before one another and before a moving background.
inline Surface layered(int x, int y) {
  if (x >= 20 && x < 34 && y >= 10 && y < 24) return {1, -21.3F, 8.7F, 25.1F, -3.3F};
  if (x >= 28 && x < 52 && y >= 18 && y < 30) return {2, 30.7F, -2.3F, -34.9F, 4.1F};
  return {4, -6.1F, -3.7F, 6.1F, 3.7F};
}
inline constexpr Window kLayered{0, 0, 71, 43};

}  // namespace aftershade::tests
