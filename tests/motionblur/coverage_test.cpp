#include "tests/motionblur/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace aftershade::tests {
namespace {

BlurFunction blur_with(const motionblur::ScalableBlurParams& params) {
  return [=](const BlurScene& scene) { return blurred(params, scene); };
}

// The column "VV 9 taps" of algorithms 3.5 comes out with the third case weighted 2, as in the paper, and with errors
// taken over +-30 columns (A to C) and +-40 (D, E).
TEST(ScalableBlurCoverage, IsTheTablesWithTheThirdCaseWeightedTwo) {
  motionblur::ScalableBlurParams params = unscaled(40);
  params.both_moving_weight = 2;
  const ExpectedCoverage cases[] = {{kEdge, {0.079, 0.345}},
                                    {kBar, {0.058, 0.179}},
                                    {kStill, {0, 0}},
                                    {kOpposed, {0.013, 0.190}},
                                    {kOvertaking, {0.035, 0.119}}};
  expect_coverage(blur_with(params), cases, 0.0015);
}

// The slides' weight is 1 (algorithms 14 no. 21): a moving edge keeps less of itself, which is nearer to the truth.
TEST(ScalableBlurCoverage, OfTheSlidesWeights) {
  const ExpectedCoverage cases[] = {{kEdge, {0.072, 0.288}},
                                    {kBar, {0.058, 0.179}},
                                    {kStill, {0, 0}},
                                    {kOpposed, {0.016, 0.216}},
                                    {kOvertaking, {0.040, 0.125}}};
  expect_coverage(blur_with(unscaled(40)), cases, 0.001);
}

TEST(ScalableBlurCoverage, OfAStillForegroundIsExact) {
  const CoverageError error = coverage_error(blur_with(unscaled(40)), kStill);
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
