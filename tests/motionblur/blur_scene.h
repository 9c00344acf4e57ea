#pragma once
#include <functional>
#include <vector>

#include "core/math/sampling.h"
#include "core/motionblur/scalable_blur.h"

namespace aftershade::tests {

/// What the blur reads, filled pixel by pixel; coordinates of functions count from the window's corner.
struct BlurScene {
  Window window;
  Plane depth;
  motionblur::HalfVelocity velocity;
  std::vector<Plane> channels;
};

struct BlurPixel {
  float depth, vx, vy;
  std::vector<float> colour;
};

inline BlurScene make_blur_scene(Window window, const std::function<BlurPixel(int, int)>& pixel) {
  const int width = window.width(), height = window.height();
  BlurScene scene{window, Plane(width, height), {Plane(width, height), Plane(width, height)}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const BlurPixel p = pixel(x, y);
      while (scene.channels.size() < p.colour.size()) scene.channels.emplace_back(width, height);
      scene.depth(x, y) = p.depth;
      scene.velocity.x(x, y) = p.vx;
      scene.velocity.y(x, y) = p.vy;
      for (size_t c = 0; c < p.colour.size(); ++c) scene.channels[c](x, y) = p.colour[c];
    }
  return scene;
}

/// Uniform in [low, high): a pure function of its counters.
inline float noise(int x, int y, uint32_t index, float low, float high) {
  return low + (high - low) * unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 0, index));
}

/// Patches of different depth and velocity, with noise in both: every case of the comparison occurs.
inline BlurPixel patchy_pixel(int x, int y, float fastest) {
  const int px = x / 7, py = y / 5;
  const float share = noise(px, py, 1, 0, 1) < 0.3F ? 0.05F : noise(px, py, 2, 0.3F, 0.9F);
  const float vx = fastest * share * noise(px, py, 3, -0.7F, 0.7F) + noise(x, y, 4, -0.3F, 0.3F);
  const float vy = fastest * share * noise(px, py, 5, -0.7F, 0.7F) + noise(x, y, 6, -0.3F, 0.3F);
  const float depth = noise(px, py, 7, 2, 2.3F) + noise(x, y, 8, 0, 0.05F);
  return {
      depth, vx, vy, {noise(x, y, 9, 0, 1), noise(x, y, 10, 0, 4), noise(x, y, 11, 0, 0.1F), noise(x, y, 12, 0, 1)}};
}

/// Radius in pixels as given, whatever the image's height.
inline motionblur::ScalableBlurParams unscaled(float radius_px) {
  motionblur::ScalableBlurParams params;
  params.max_radius_px = radius_px;
  params.reference_height_px = 1;
  return params;
}

/// The blurred channels; the scene is left alone.
inline std::vector<Plane> blurred(const motionblur::ScalableBlurParams& params, const BlurScene& scene) {
  std::vector<Plane> out;
  std::vector<Plane*> pointers;
  for (const Plane& plane : scene.channels) out.push_back(copy_of(plane));
  for (Plane& plane : out) pointers.push_back(&plane);
  const motionblur::GatherInput input{scene.depth, &scene.velocity, scene.window,
                                      static_cast<int>(params.reference_height_px)};
  motionblur::scalable_motion_blur(params, input, pointers);
  return out;
}

}  // namespace aftershade::tests
