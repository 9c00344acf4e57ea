// Columns "McG12 S=15" and "Guertin N=35" of algorithms 3.5. Its rows A to E fix what the papers leave open: distances
// are those of the tap, not of the pixel it falls on; Guertin's taps 1, 3, 5 ... are the ones along w_c, there are N of
// them with none left out in the middle, j is in -1 to 1, and the least speed of the centre's weight is half a pixel.
#include <gtest/gtest.h>

#include "tests/motionblur/coverage.h"
#include "tests/motionblur/literal_blur.h"

namespace aftershade::tests {
namespace {

using motionblur::Guertin2014Params;
using motionblur::Mcguire2012Params;

/// Random shifts need many pixels for a mean; taps across the motion need rows beside them.
constexpr JitterMean kManyPixels{8, 256, 24};

template <class Params>
BlurFunction blur_with(const Params& params) {
  return [=](const BlurScene& scene) { return literally_blurred(params, scene); };
}

TEST(Mcguire2012Coverage, IsTheTables) {
  const ExpectedCoverage cases[] = {{kEdge, {0.096, 0.345}},
                                    {kBar, {0.104, 0.288}},
                                    {kStill, {0, 0}},
                                    {kOpposed, {0.014, 0.187}},
                                    {kOvertaking, {0.040, 0.122}}};
  expect_coverage(blur_with(literal<Mcguire2012Params>(40)), cases, 0.003, kManyPixels);
}

TEST(Guertin2014Coverage, IsTheTables) {
  const ExpectedCoverage cases[] = {{kEdge, {0.091, 0.352}},
                                    {kBar, {0.107, 0.388}},
                                    {kStill, {0, 0}},
                                    {kOpposed, {0.020, 0.195}},
                                    {kOvertaking, {0.048, 0.133}}};
  expect_coverage(blur_with(literal<Guertin2014Params>(40)), cases, 0.003, kManyPixels);
}

// Motion in one direction has no variance but where tiles stand still, so most taps lie along the motion, and each of
// them makes the blur more opaque.
TEST(Guertin2014Coverage, OfTilesVarianceIsFartherFromTheTruth) {
  Guertin2014Params params = literal<Guertin2014Params>(40);
  params.split = motionblur::TapSplit::variance;
  const ExpectedCoverage cases[] = {{kEdge, {0.146, 0.352}},
                                    {kBar, {0.204, 0.528}},
                                    {kStill, {0, 0}},
                                    {kOpposed, {0.020, 0.195}},
                                    {kOvertaking, {0.048, 0.133}}};
  expect_coverage(blur_with(params), cases, 0.003, kManyPixels);
}

}  // namespace
}  // namespace aftershade::tests
