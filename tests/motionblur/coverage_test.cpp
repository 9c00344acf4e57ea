#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "tests/motionblur/blur_scene.h"

namespace aftershade::tests {
namespace {

/// Two layers in one dimension (algorithms 3.5). The foreground is everything left of column 0, or a bar around it.
struct Layers {
  const char* name;
  float foreground_px, background_px;  ///< half velocities
  int bar_px;                          ///< 0: an edge
  int reach_px;                        ///< errors are taken over columns -reach to reach - 1
};

struct CoverageError {
  double mean, largest;
};

struct Expected {
  Layers layers;
  CoverageError error;
};

constexpr int kHalf = 120;
const Layers kEdge{"A", 20, 0, 0, 30}, kBar{"B", 20, 0, 4, 30}, kStill{"C", 0, 20, 0, 30},
    kOpposed{"D", 10, -20, 0, 40}, kOvertaking{"E", 20, 15, 0, 40};

bool is_foreground(const Layers& layers, double x) {
  return layers.bar_px == 0 ? x < 0 : x >= -0.5 * layers.bar_px && x < 0.5 * layers.bar_px;
}

/// Share of the exposure during which the foreground covers the centre of column x.
double true_coverage(const Layers& layers, int x) {
  constexpr int kTimes = 4000;
  int covered = 0;
  for (int i = 0; i < kTimes; ++i)
    covered += is_foreground(layers, x + 0.5 - layers.foreground_px * ((i + 0.5) / (0.5 * kTimes) - 1));
  return covered / static_cast<double>(kTimes);
}

/// Foreground coverage of columns -kHalf to kHalf - 1, the mean over the sixteen jitters.
std::vector<double> blurred_coverage(const motionblur::ScalableBlurParams& params, const Layers& layers) {
  std::vector<double> mean(2 * kHalf);
  for (int phase = 0; phase < 4; ++phase) {
    const BlurScene scene = make_blur_scene({phase, 0, phase + 2 * kHalf - 1, 3}, [&](int x, int) {
      const bool front = is_foreground(layers, x - kHalf + 0.5);
      return BlurPixel{
          front ? 1.0F : 10.0F, front ? layers.foreground_px : layers.background_px, 0, {front ? 1.0F : 0.0F}};
    });
    const std::vector<Plane> out = blurred(params, scene);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 2 * kHalf; ++x) mean[static_cast<size_t>(x)] += out[0](x, y) / 16.0;
  }
  return mean;
}

CoverageError coverage_error(const motionblur::ScalableBlurParams& params, const Layers& layers) {
  const std::vector<double> coverage = blurred_coverage(params, layers);
  CoverageError error{0, 0};
  for (int x = -layers.reach_px; x < layers.reach_px; ++x) {
    const double off = std::abs(coverage[static_cast<size_t>(x + kHalf)] - true_coverage(layers, x));
    error.mean += off / (2 * layers.reach_px);
    error.largest = std::max(error.largest, off);
  }
  return error;
}

void expect_errors(const motionblur::ScalableBlurParams& params, std::span<const Expected> cases, double tolerance) {
  for (const Expected& expected : cases) {
    const CoverageError got = coverage_error(params, expected.layers);
    testing::Test::RecordProperty(std::string(expected.layers.name) + "_mean", std::to_string(got.mean));
    testing::Test::RecordProperty(std::string(expected.layers.name) + "_largest", std::to_string(got.largest));
    EXPECT_NEAR(got.mean, expected.error.mean, tolerance) << expected.layers.name;
    EXPECT_NEAR(got.largest, expected.error.largest, tolerance) << expected.layers.name;
  }
}

// The column "VV 9 taps" of algorithms 3.5 comes out with the third case weighted 2, as in the paper, and with errors
// taken over +-30 columns (A to C) and +-40 (D, E).
TEST(ScalableBlurCoverage, IsTheTablesWithTheThirdCaseWeightedTwo) {
  motionblur::ScalableBlurParams params = unscaled(40);
  params.both_moving_weight = 2;
  const Expected cases[] = {{kEdge, {0.079, 0.345}},
                            {kBar, {0.058, 0.179}},
                            {kStill, {0, 0}},
                            {kOpposed, {0.013, 0.190}},
                            {kOvertaking, {0.035, 0.119}}};
  expect_errors(params, cases, 0.0015);
}

// The slides' weight is 1 (algorithms 14 no. 21): a moving edge keeps less of itself, which is nearer to the truth.
TEST(ScalableBlurCoverage, OfTheSlidesWeights) {
  const Expected cases[] = {{kEdge, {0.072, 0.288}},
                            {kBar, {0.058, 0.179}},
                            {kStill, {0, 0}},
                            {kOpposed, {0.016, 0.216}},
                            {kOvertaking, {0.040, 0.125}}};
  expect_errors(unscaled(40), cases, 0.001);
}

TEST(ScalableBlurCoverage, OfAStillForegroundIsExact) {
  const CoverageError error = coverage_error(unscaled(40), kStill);
  EXPECT_LT(error.largest, 1e-6);
}

// A single layer in uniform motion: light is moved, not made. The lights' spacing and the jitter's period have no
// common factor, so that after four spacings every light has met every jitter and the picture repeats.
TEST(ScalableBlurEnergy, OfOneMovingLayerStays) {
  constexpr int kColumns = 31, kRows = 17, kMargin = 24;
  const Window window{0, 0, 4 * kColumns + 2 * kMargin, 4 * kRows + 2 * kMargin};
  const BlurScene scene = make_blur_scene(window, [](int x, int y) {
    return BlurPixel{3, 13.3F, -7.1F, {x % kColumns == 5 && y % kRows == 3 ? 10.0F : 0.01F}};
  });
  const std::vector<Plane> out = blurred(unscaled(20), scene);
  double before = 0, after = 0, brightest = 0;
  for (int y = kMargin; y < kMargin + 4 * kRows; ++y)
    for (int x = kMargin; x < kMargin + 4 * kColumns; ++x) {
      before += scene.channels[0](x, y);
      after += out[0](x, y);
      brightest = std::max(brightest, double{out[0](x, y)});
    }
  EXPECT_LT(brightest, 3) << "the lights are spread";
  EXPECT_NEAR(after / before, 1, 1e-6);
}

}  // namespace
}  // namespace aftershade::tests
