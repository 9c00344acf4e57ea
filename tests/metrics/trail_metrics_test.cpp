#include "core/metrics/trail_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/metrics/metric_planes.h"

namespace aftershade::metrics {
namespace {

TEST(Footprints, TellHowLongAgoTheyWereLeftAndEntered) {
  // A footprint two pixels wide, one pixel to the right a frame, then standing still for one.
  const Plane first = plane_of(5, {1, 1, 0, 0, 0}), second = plane_of(5, {0, 1, 1, 0, 0}),
              third = plane_of(5, {0, 0, 1, 1, 0}), fourth = plane_of(5, {0, 0, 1, 1, 0});
  const ConstPlaneView all[] = {first, second, third, fourth};
  const Plane left = frames_since_left(all), entered = frames_since_entered(all);
  const float want_left[] = {3, 2, 0, 0, 0}, want_entered[] = {0, 0, 3, 2, 0};
  for (int x = 0; x < 5; ++x) {
    EXPECT_EQ(left(x, 0), want_left[x]) << x;
    EXPECT_EQ(entered(x, 0), want_entered[x]) << x;
  }
  EXPECT_EQ(frames_since_left(std::span(all).first(1))(0, 0), 0) << "no past";
  EXPECT_TRUE(frames_since_left({}).empty());
}

TEST(ErrorByAge, SortsErrorsOfAllFramesByAge) {
  const Plane truth(4, 1, 0.5F), age = plane_of(4, {1, 2, 1, 0});
  const Plane one = plane_of(4, {0.25F, 0.5F, 0.75F, 9}), other = plane_of(4, {0.5F, 0.25F, 0.25F, 9});
  const ConstPlaneView images[] = {one, other}, truths[] = {truth, truth}, ages[] = {age, age};
  const std::vector<AgeError> errors = error_by_age(images, truths, ages, 3);
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_EQ(errors[0].count, 4);  // -0.25, 0.25, 0, -0.25
  EXPECT_DOUBLE_EQ(errors[0].mean, -0.0625);
  EXPECT_DOUBLE_EQ(errors[0].absolute, 0.1875);
  EXPECT_DOUBLE_EQ(errors[0].visible, 0.75);
  EXPECT_DOUBLE_EQ(errors[1].mean, -0.125);  // 0, -0.25
  EXPECT_EQ(errors[2].count, 0);
  EXPECT_TRUE(std::isnan(errors[2].mean));
  const AgeError total = total_error(errors);
  EXPECT_EQ(total.count, 6);
  EXPECT_DOUBLE_EQ(total.mean, -0.5 / 6);
  EXPECT_DOUBLE_EQ(total.absolute, 1.0 / 6);
  EXPECT_DOUBLE_EQ(total.visible, 4.0 / 6);
}

TEST(HalfLife, OfAnExponentialIsExact) {
  std::vector<double> errors;
  for (int k = 0; k < 12; ++k) errors.push_back(-0.2 * std::pow(8.0 / 9, k));
  EXPECT_NEAR(half_life_frames(errors), std::log(0.5) / std::log(8.0 / 9), 1e-12);
  EXPECT_DOUBLE_EQ(half_life_frames(std::vector<double>{0.5, 0}), 1) << "gone in one frame";
  EXPECT_EQ(half_life_frames(std::vector<double>{0.5, 0.4, 0.3}), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(half_life_frames(std::vector<double>{0, 0.4})));
}

TEST(StepResponse, IsTheShareOfTheWay) {
  const Plane start = plane_of(3, {0, 1, 5}), end = plane_of(3, {1, 0.5F, 5}), mask = plane_of(3, {1, 0, 0});
  const Plane half = plane_of(3, {0.5F, 0.75F, 9}), uneven = plane_of(3, {1, 1, 5});
  const ConstPlaneView images[] = {start, half, uneven, end};
  const std::vector<double> response = step_response(images, start, end);
  EXPECT_DOUBLE_EQ(response[0], 0);
  EXPECT_DOUBLE_EQ(response[1], 0.5);
  EXPECT_DOUBLE_EQ(response[2], 1 / 1.25);  // steps 1 and -0.5: only the first was made
  EXPECT_DOUBLE_EQ(response[3], 1);
  EXPECT_DOUBLE_EQ(step_response(images, start, end, mask)[2], 1);
  EXPECT_TRUE(std::isnan(step_response(images, start, start)[0])) << "no step";
}

TEST(FramesToReach, CountsFromOneAndWantsItToStay) {
  EXPECT_EQ(frames_to_reach(std::vector<double>{0.5, 0.89, 0.9, 0.95}), 3);
  EXPECT_EQ(frames_to_reach(std::vector<double>{0.95, 0.7, 0.9}), 3) << "an overshoot is no arrival";
  EXPECT_EQ(frames_to_reach(std::vector<double>{1, 1}), 1);
  EXPECT_EQ(frames_to_reach(std::vector<double>{0.2, 0.3}), 0);
  EXPECT_EQ(frames_to_reach(std::vector<double>{0.2, 0.6}, 0.5), 2);
}

TEST(FramesToReach, OfAMeanOfNineFollowsTheFormula) {
  // Blending 1/9 of each new frame: 1 - (8/9)^k >= 0.9 from k = 20 on.
  std::vector<double> response;
  for (int k = 1; k <= 40; ++k) response.push_back(1 - std::pow(8.0 / 9, k));
  EXPECT_EQ(frames_to_reach(response), 20);
}

}  // namespace
}  // namespace aftershade::metrics
