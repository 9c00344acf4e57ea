#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <utility>

#include "tests/motionblur/blur_scene.h"

namespace aftershade::tests {
namespace {

constexpr int kTile = 9, kSize = 7 * kTile;

/// A way to look at the scene: where pixel (x, y) of the view lies in the scene, and a scene velocity seen in the view.
struct View {
  const char* name;
  std::pair<int, int> (*pixel)(int, int);
  std::pair<float, float> (*velocity)(float, float);
};

const View kPlain{"plain", [](int x, int y) { return std::pair(x, y); },
                  [](float x, float y) { return std::pair(x, y); }};
const View kViews[] = {
    {"mirrored", [](int x, int y) { return std::pair(kSize - 1 - x, y); },
     [](float x, float y) { return std::pair(-x, y); }},
    {"a quarter turn", [](int x, int y) { return std::pair(y, kSize - 1 - x); },
     [](float x, float y) { return std::pair(-y, x); }},
    {"time reversed", [](int x, int y) { return std::pair(x, y); }, [](float x, float y) { return std::pair(-x, -y); }},
};

/// The first blurred channel of the view, averaged over all sixteen jitters of a pixel: the window is placed at
/// different multiples of the tile, which is 1 modulo the jitter's period.
std::vector<double> mean_over_jitter(const motionblur::ScalableBlurParams& params, const View& view) {
  std::vector<double> mean(kSize * kSize);
  for (int phase = 0; phase < 16; ++phase) {
    const int left = kTile * (phase % 4), top = kTile * (phase / 4);
    const BlurScene scene = make_blur_scene({left, top, left + kSize - 1, top + kSize - 1}, [&](int x, int y) {
      const auto [sx, sy] = view.pixel(x, y);
      BlurPixel pixel = patchy_pixel(sx, sy, kTile);
      std::tie(pixel.vx, pixel.vy) = view.velocity(pixel.vx, pixel.vy);
      return pixel;
    });
    const std::vector<Plane> out = blurred(params, scene);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const auto [sx, sy] = view.pixel(x, y);
        mean[static_cast<size_t>(sy * kSize + sx)] += out[0](x, y) / 16.0;
      }
  }
  return mean;
}

void expect_no_preferred_direction(const motionblur::ScalableBlurParams& params, const char* what) {
  const std::vector<double> plain = mean_over_jitter(params, kPlain);
  for (const View& view : kViews) {
    const std::vector<double> seen = mean_over_jitter(params, view);
    for (size_t i = 0; i < plain.size(); ++i)
      ASSERT_NEAR(seen[i], plain[i], 1e-5) << what << ", " << view.name << " at " << i % kSize << ", " << i / kSize;
  }
}

TEST(ScalableBlurSymmetry, NoDirectionIsPreferred) { expect_no_preferred_direction(unscaled(kTile), "default"); }

TEST(ScalableBlurSymmetry, NeitherByAnyDilationNorByThreeDirections) {
  motionblur::ScalableBlurParams params = unscaled(kTile);
  params.directions = motionblur::Directions::three;
  expect_no_preferred_direction(params, "three directions");
  params.dilation = motionblur::Dilation::directional;
  expect_no_preferred_direction(params, "directional");
  params.dilation = motionblur::Dilation::line;
  expect_no_preferred_direction(params, "line");
}

}  // namespace
}  // namespace aftershade::tests
