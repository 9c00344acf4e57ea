#include "core/metrics/temporal_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/sampling.h"
#include "tests/metrics/metric_planes.h"

namespace aftershade::metrics {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// Everything was (dx, dy) pixels away.
struct Shift {
  Plane x, y;
  Shift(int width, int height, float dx, float dy) : x(width, height), y(width, height) {
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        x(i, j) = static_cast<float>(i) + 0.5F + dx;
        y(i, j) = static_cast<float>(j) + 0.5F + dy;
      }
  }
  Motion motion(ConstPlaneView valid = {}) const { return {x, y, valid}; }
};

TEST(Warped, ReadsWhereThePixelsWereAndKnowsWhatItCannotKnow) {
  const Plane before = plane_of(4, {1, 2, 4, 8, 10, 20, 40, 80});
  const Plane whole = warped(before, Shift(4, 2, 1, 0).motion());
  EXPECT_EQ(whole(0, 0), 2);
  EXPECT_EQ(whole(2, 1), 80);
  EXPECT_TRUE(std::isnan(whole(3, 0))) << "from outside";
  const Plane half = warped(before, Shift(4, 2, 0.25F, 0).motion());
  EXPECT_FLOAT_EQ(half(1, 0), 0.75F * 2 + 0.25F * 4);
  EXPECT_TRUE(std::isnan(half(3, 1)));
  const Plane between_rows = warped(before, Shift(4, 2, 0, 0.5F).motion());
  EXPECT_FLOAT_EQ(between_rows(2, 0), 22);
  EXPECT_TRUE(std::isnan(between_rows(2, 1)));
}

TEST(Warped, LeavesOutWhatIsInvalidOrUnknown) {
  const Plane before = plane_of(3, {1, kNan, 3}), valid = plane_of(3, {1, 1, 0});
  Shift still(3, 1, 0, 0);
  still.x(0, 0) = 0.5F;
  const Plane out = warped(before, still.motion(valid));
  EXPECT_EQ(out(0, 0), 1) << "a neighbour of no weight does not matter";
  EXPECT_TRUE(std::isnan(out(1, 0)));
  EXPECT_TRUE(std::isnan(out(2, 0)));
  still.x(0, 0) = kNan;
  EXPECT_TRUE(std::isnan(warped(before, still.motion())(0, 0)));
}

TEST(SameSurface, TakesEveryPixelThatWarpingReads) {
  const Plane depth = plane_of(4, {2, 2, 3, kInf});
  const Plane expected = plane_of(4, {2.1F, 2.1F, 3, 3});
  const Plane still = same_surface(Shift(4, 1, 0, 0).motion(), expected, depth, 0.1);
  for (int x = 0; x < 3; ++x) EXPECT_EQ(still(x, 0), 1) << x;
  EXPECT_EQ(still(3, 0), 0) << "background";
  const Plane shifted = same_surface(Shift(4, 1, 0.5F, 0).motion(), expected, depth, 0.1);
  EXPECT_EQ(shifted(0, 0), 1);
  EXPECT_EQ(shifted(1, 0), 0) << "half of it lies on another surface";
  EXPECT_EQ(same_surface(Shift(4, 1, 0, 0).motion(), expected, depth, 0.04)(0, 0), 0) << "2 against 2.1 is 4.8 %";
}

TEST(WarpingError, IsTheRootOfTheMeanSquareAlongTheMotion) {
  const Plane before = plane_of(4, {0.5F, 1, 0.75F, 0.25F}), now = plane_of(4, {1, 0.5F, 0.25F, 9});
  // One pixel to the right: changes 0, -0.25, 0; the last came from outside.
  EXPECT_DOUBLE_EQ(warping_error(now, before, Shift(4, 1, 1, 0).motion()), std::sqrt(0.0625 / 3));
  EXPECT_DOUBLE_EQ(warping_error(now, before, Shift(4, 1, 1, 0).motion(), plane_of(4, {0, 1, 0, 1})), 0.25);
  EXPECT_TRUE(std::isnan(warping_error(now, before, Shift(4, 1, 9, 0).motion())));
  EXPECT_TRUE(std::isnan(warping_error(now, Plane(3, 1), Shift(4, 1, 0, 0).motion())));
}

TEST(Flicker, DoesNotCountWhatTheTruthDoesToo) {
  const Plane now = plane_of(3, {1, 0.5F, 0.5F}), before = plane_of(3, {0.5F, 0.5F, 1});
  const Plane f = flicker_above_truth(now, before, plane_of(3, {0.5F, 0.25F, 0}), Shift(3, 1, 0, 0).motion());
  EXPECT_EQ(f(0, 0), 0) << "rises as the truth rises";
  EXPECT_EQ(f(1, 0), 0.25F) << "stays where the truth rises";
  EXPECT_EQ(f(2, 0), 0.5F) << "falls where the truth stays";
  EXPECT_TRUE(std::isnan(flicker_above_truth(now, before, Plane(2, 1), Shift(3, 1, 0, 0).motion())(0, 0)));
}

TEST(Flicker, ComparesWithTheSamePointsBetweenPixels) {
  const Plane before = plane_of(3, {0, 0.5F, 0.75F}), now = plane_of(3, {0.25F, 0.25F, 1});
  // A quarter of a pixel to the right: 0.125 and 0.5625 there before; changes 0.125 and -0.3125.
  const Plane f = flicker_above_truth(now, before, plane_of(3, {0.125F, 0.0625F, 0}), Shift(3, 1, 0.25F, 0).motion());
  EXPECT_EQ(f(0, 0), 0);
  EXPECT_EQ(f(1, 0), 0.375F);
  EXPECT_TRUE(std::isnan(f(2, 0))) << "from outside";
}

TEST(Flicker, IsNoneOfAConstantWhereNothingMovesButTheCamera) {
  const Plane grey(9, 5, 0.5F), unchanged(9, 5);
  const Plane f = flicker_above_truth(grey, grey, unchanged, Shift(9, 5, 0.25F, -0.625F).motion());
  for (int y = 1; y < 5; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(f(x, y), 0) << x << " " << y;
}

TEST(Distribution, HasNearestRankPercentiles) {
  Plane values(100, 2);
  for (int i = 0; i < 200; ++i) values(i % 100, i / 100) = static_cast<float>((i * 77) % 200 + 1);  // 1 to 200
  const ConstPlaneView one[] = {values};
  const Distribution d = distribution(one);
  EXPECT_DOUBLE_EQ(d.mean, 100.5);
  EXPECT_EQ(d.p95, 190);
  EXPECT_EQ(d.p99, 198);
  EXPECT_EQ(d.count, 200);
}

TEST(Distribution, PutsFramesTogetherAndAppliesTheirMasks) {
  const Plane a = plane_of(3, {1, 2, kNan}), b = plane_of(3, {5, 100, 7}), mask_b = plane_of(3, {1, 0, 1});
  const ConstPlaneView values[] = {a, b}, masks[] = {{}, mask_b};
  const Distribution d = distribution(values, masks);
  EXPECT_EQ(d.count, 4);
  EXPECT_DOUBLE_EQ(d.mean, 15.0 / 4);
  EXPECT_EQ(d.p99, 7);
  EXPECT_TRUE(std::isnan(distribution({}).mean));
  EXPECT_EQ(distribution({}).count, 0);
}

TEST(TrajectoryNoise, IsThatOfTheValuesOnTheTrajectory) {
  // A texture moves one pixel to the right a frame, and its brightness goes 0, 2, 0, 2.
  std::vector<Plane> frames;
  const Shift motion(8, 1, -1, 0);
  for (int t = 0; t < 4; ++t) {
    Plane frame(8, 1);
    for (int x = 0; x < 8; ++x) frame(x, 0) = static_cast<float>(10 * (x - t) + (t % 2) * 2);
    frames.push_back(std::move(frame));
  }
  const std::vector<ConstPlaneView> views(frames.begin(), frames.end());
  const std::vector<Motion> motions(4, motion.motion());
  const TrajectoryNoise noise = trajectory_noise(views, motions, 4);
  for (int x = 3; x < 8; ++x) {
    EXPECT_FLOAT_EQ(noise.deviation(x, 0), 1);
    EXPECT_FLOAT_EQ(noise.high_pass(x, 0), 4);
  }
  EXPECT_TRUE(std::isnan(noise.deviation(2, 0))) << "known for three frames only";
  EXPECT_TRUE(std::isnan(trajectory_noise(views, motions, 5).high_pass(7, 0)));
}

TEST(TrajectoryNoise, FollowsPartsOfPixelsAndEndsWhereTheSurfaceWasHidden) {
  // 0.25 px a frame over a ramp that moves along: no change at all. One pixel was hidden two frames ago.
  std::vector<Plane> frames;
  const Shift motion(9, 1, -0.25F, 0);
  for (int t = 0; t < 5; ++t) {
    Plane frame(9, 1);
    for (int x = 0; x < 9; ++x) frame(x, 0) = static_cast<float>(x) - 0.25F * static_cast<float>(t);
    frames.push_back(std::move(frame));
  }
  const std::vector<ConstPlaneView> views(frames.begin(), frames.end());
  std::vector<Motion> motions(5, motion.motion());
  Plane valid(9, 1, 1);
  valid(4, 0) = 0;
  motions[3].valid = valid;
  const TrajectoryNoise noise = trajectory_noise(views, motions, 3);
  EXPECT_NEAR(noise.deviation(8, 0), 0, 1e-6);
  EXPECT_NEAR(noise.high_pass(8, 0), 0, 1e-6);
  EXPECT_TRUE(std::isnan(noise.deviation(4, 0)));
}

TEST(GradientRatio, IsOneForTheTruthAndHalfForHalfItsContrast) {
  Plane truth(9, 7), half(9, 7), mask(9, 7);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x) {
      truth(x, y) = static_cast<float>(mix_bits(static_cast<uint32_t>(x + 9 * y)) % 100) / 100;
      half(x, y) = x < 5 ? 0.5F * truth(x, y) + 0.25F : 0;
      mask(x, y) = x < 4 ? 1 : 0;
    }
  EXPECT_DOUBLE_EQ(gradient_ratio(truth, truth), 1);
  EXPECT_NEAR(gradient_ratio(half, truth, mask), 0.5, 1e-6);
  // A step of 1 over two pixels: central differences 0.5 0.5; blurred to a ramp of 1/3: 1/6 1/3 1/3 1/6.
  Plane step(8, 3), ramp(8, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 8; ++x) {
      step(x, y) = x < 4 ? 0 : 1;
      ramp(x, y) = x < 3 ? 0 : std::min(1.0F, static_cast<float>(x - 2) / 3);
    }
  EXPECT_NEAR(gradient_ratio(ramp, step), std::sqrt((2.0 / 36 + 2.0 / 9) / 0.5), 1e-6);
  EXPECT_TRUE(std::isnan(gradient_ratio(step, Plane(8, 3, 1))));
}

TEST(TileSeams, AreTheRatioOfErrorStepsAcrossAndInside) {
  const Plane truth(8, 8, 1);
  Plane image(8, 8);
  // Each tile of 4 has its own offset, 0.5 apart along x and 1 along y; inside, the error alternates by 0.125.
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      image(x, y) =
          0.5F * static_cast<float>(x / 4) + static_cast<float>(y / 4) + 0.125F * static_cast<float>((x + y) % 2);
  // Across x: 0.5 - 0.125 or + 0.125 by turns, mean 0.5; across y likewise, mean 1.
  EXPECT_DOUBLE_EQ(tile_seam_ratio(image, truth, 4), 0.75 / 0.125);
  EXPECT_LT(tile_seam_ratio(image, truth, 4, 2, 1), 1) << "borders elsewhere";
  EXPECT_TRUE(std::isnan(tile_seam_ratio(truth, truth, 4))) << "no error at all";
}

TEST(TileSeams, AreNoneInNoiseAndShowInNoiseOnceTilesDiffer) {
  const Plane truth(256, 192);
  Plane noise(256, 192), tiled(256, 192);
  for (int y = 0; y < 192; ++y)
    for (int x = 0; x < 256; ++x) {
      noise(x, y) = unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
      tiled(x, y) = noise(x, y) + 0.2F * static_cast<float>((x / 16 + y / 16) % 2);
    }
  EXPECT_NEAR(tile_seam_ratio(noise, truth, 16), 1, 0.02);
  EXPECT_NEAR(tile_seam_ratio(noise, truth, 5), 1, 0.02);
  // The mean of |a - b + 0.2| for evenly distributed a and b is 1/3 + 0.04 - 0.008/3.
  EXPECT_NEAR(tile_seam_ratio(tiled, truth, 16), (1.0 / 3 + 0.04 - 0.008 / 3) * 3, 0.02);
  EXPECT_NEAR(tile_seam_ratio(tiled, truth, 16, 8, 8), 1, 0.02) << "seams inside tiles, one step in fifteen";
}

TEST(BorderMask, IsAFrameOfTheGivenWidth) {
  const Plane mask = border_mask(6, 5, 2);
  int inside = 0;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x) inside += mask(x, y) == 0 ? 1 : 0;
  EXPECT_EQ(inside, 2 * 1);
  EXPECT_EQ(mask(2, 2), 0);
  EXPECT_EQ(mask(3, 2), 0);
}

}  // namespace
}  // namespace aftershade::metrics
