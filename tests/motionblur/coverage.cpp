#include "tests/motionblur/coverage.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace aftershade::tests {

namespace {

bool is_foreground(const Layers& layers, double x) {
  return layers.bar_px == 0 ? x < 0 : x >= -0.5 * layers.bar_px && x < 0.5 * layers.bar_px;
}

}  // namespace

double true_coverage(const Layers& layers, int x) {
  constexpr int kTimes = 4000;
  int covered = 0;
  for (int i = 0; i < kTimes; ++i)
    covered += is_foreground(layers, x + 0.5 - layers.foreground_px * ((i + 0.5) / (0.5 * kTimes) - 1));
  return covered / static_cast<double>(kTimes);
}

BlurScene coverage_scene(const Layers& layers, Window window) {
  return make_blur_scene(window, [&](int x, int) {
    const bool front = is_foreground(layers, x - kCoverageHalf + 0.5);
    return BlurPixel{
        front ? 1.0F : 10.0F, front ? layers.foreground_px : layers.background_px, 0, {front ? 1.0F : 0.0F}};
  });
}

std::vector<double> blurred_coverage(const BlurFunction& blur, const Layers& layers, JitterMean jitter) {
  std::vector<double> mean(2 * kCoverageHalf);
  for (int phase = 0; phase < jitter.columns; ++phase) {
    const Window window{phase, -jitter.margin, phase + 2 * kCoverageHalf - 1, jitter.rows + jitter.margin - 1};
    const std::vector<Plane> out = blur(coverage_scene(layers, window));
    for (int y = 0; y < jitter.rows; ++y)
      for (int x = 0; x < 2 * kCoverageHalf; ++x)
        mean[static_cast<size_t>(x)] += double{out[0](x, y + jitter.margin)} / (jitter.columns * jitter.rows);
  }
  return mean;
}

CoverageError coverage_error(const BlurFunction& blur, const Layers& layers, JitterMean jitter) {
  const std::vector<double> coverage = blurred_coverage(blur, layers, jitter);
  CoverageError error{0, 0};
  for (int x = -layers.reach_px; x < layers.reach_px; ++x) {
    const double off = std::abs(coverage[static_cast<size_t>(x + kCoverageHalf)] - true_coverage(layers, x));
    error.mean += off / (2 * layers.reach_px);
    error.largest = std::max(error.largest, off);
  }
  return error;
}

void expect_coverage(const BlurFunction& blur, std::span<const ExpectedCoverage> cases, double tolerance,
                     JitterMean jitter) {
  for (const ExpectedCoverage& expected : cases) {
    const CoverageError got = coverage_error(blur, expected.layers, jitter);
    testing::Test::RecordProperty(std::string(expected.layers.name) + "_mean", std::to_string(got.mean));
    testing::Test::RecordProperty(std::string(expected.layers.name) + "_largest", std::to_string(got.largest));
    EXPECT_NEAR(got.mean, expected.error.mean, tolerance) << expected.layers.name;
    EXPECT_NEAR(got.largest, expected.error.largest, tolerance) << expected.layers.name;
  }
}

}  // namespace aftershade::tests
