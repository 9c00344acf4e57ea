#include "core/metrics/past.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/metrics/metric_planes.h"

namespace aftershade::metrics {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// Looks along +Z from (x, 0, 0): a metre at 10 m is 10 px.
Camera camera_at(double x) {
  Camera camera;
  camera.fx = camera.fy = 100;
  camera.cx = 50;
  camera.world_to_camera = Mat4();
  (*camera.world_to_camera)[3][0] = -x;
  return camera;
}
std::optional<CameraReprojection> moved_by(double x) { return CameraReprojection::create(camera_at(x), camera_at(0)); }

TEST(Past, FollowsTheCameraWhereTheVectorAgreesOrIsUnknownAndTheVectorWhereItDoesNot) {
  const Plane depth(4, 1, 10.0F), up(4, 1, 0);
  const Plane right = plane_of(4, {1.3F, kNan, -2, 1});  // the camera's own motion is 1 px
  const Past past = past_of({depth, depth, right, up, moved_by(0.1)});
  for (int x = 0; x < 4; ++x) EXPECT_EQ(past.moving(x, 0), x == 2 ? 1 : 0) << x;
  EXPECT_FLOAT_EQ(past.x(0, 0), 1.5F) << "the camera's is exact";
  EXPECT_FLOAT_EQ(past.x(1, 0), 2.5F);
  EXPECT_FLOAT_EQ(past.x(2, 0), 0.5F);
  EXPECT_EQ(past.valid(0, 0), 1);
  EXPECT_EQ(past.valid(3, 0), 0) << "from outside";
  EXPECT_EQ(past.pixel_x(1, 0), 2);
  EXPECT_EQ(past.pixel_x(3, 0), -1);
}

TEST(Past, WithoutCamerasKnowsTheVectorsAloneAndThatNothingMoves) {
  const Plane depth(3, 1, 10.0F), up(3, 1, 0), right = plane_of(3, {1, kNan, -1});
  const Past past = past_of({depth, depth, right, up, std::nullopt});
  EXPECT_FLOAT_EQ(past.x(0, 0), 1.5F);
  EXPECT_TRUE(std::isnan(past.x(1, 0)));
  for (int x = 0; x < 3; ++x) EXPECT_EQ(past.moving(x, 0), 0);
}

TEST(Past, IsInIndexCoordinatesWhereverTheWindowLies) {
  const Plane depth(4, 1, 10.0F), up(4, 1, 0), right(4, 1, 1);
  const Past here = past_of({depth, depth, right, up, moved_by(0.1)});
  const Past there = past_of({depth, depth, right, up, moved_by(0.1), 7, -3});
  for (int x = 0; x < 4; ++x) EXPECT_NEAR(here.x(x, 0), there.x(x, 0), 1e-5);
}

TEST(Past, OfBackgroundAndOfOtherSurfacesIsInvalid) {
  const Plane now = plane_of(4, {kInf, 10, 10, kNan}), before = plane_of(4, {10, 20, 10, 10});
  const Plane still(4, 1, 0);
  const Past past = past_of({now, before, still, still, std::nullopt});
  for (int x = 0; x < 4; ++x) EXPECT_EQ(past.valid(x, 0), x == 2 ? 1 : 0) << x;
}

TEST(Disoccluded, IsWhatWasHiddenButNotWhatComesIntoThePicture) {
  const Plane depth(5, 1, 10.0F), before = plane_of(5, {10, 5, 5, 10, 10}), up(5, 1, 0);
  const Past still = past_of({depth, before, up, up, std::nullopt});
  const Plane seen = disoccluded(still);
  for (int x = 0; x < 5; ++x) EXPECT_EQ(seen(x, 0), x == 1 || x == 2 ? 1 : 0) << x;
  // Half a pixel to the right: one of the pixels around the place shows the surface at the edges of what was hidden.
  const Past between = past_of({depth, before, Plane(5, 1, 0.5F), up, std::nullopt});
  EXPECT_EQ(between.valid(0, 0), 0);
  EXPECT_EQ(disoccluded(between)(0, 0), 0);
  EXPECT_EQ(disoccluded(between)(1, 0), 1);
  EXPECT_EQ(disoccluded(between)(2, 0), 0);
  EXPECT_EQ(disoccluded(between)(4, 0), 0) << "half of it lies outside; the other half shows it";
  const Past outside = past_of({depth, before, Plane(5, 1, 9), up, std::nullopt});
  for (int x = 0; x < 5; ++x) EXPECT_EQ(disoccluded(outside)(x, 0), 0);
}

TEST(FramesSince, CountAlongTheMotion) {
  const Plane depth(4, 1, 10.0F), up(4, 1, 0), right(4, 1, 1);
  const Past past = past_of({depth, depth, right, up, std::nullopt});
  const Plane first = frames_since(plane_of(4, {0, 0, 1, 0}), {}, past);
  EXPECT_EQ(first(2, 0), 0);
  EXPECT_EQ(first(0, 0), kInf) << "never";
  const Plane second = frames_since(plane_of(4, {0, 0, 0, 0}), first, past);
  EXPECT_EQ(second(1, 0), 1) << "it was at pixel 2";
  EXPECT_EQ(second(0, 0), kInf);
  EXPECT_TRUE(std::isnan(second(3, 0))) << "it was outside";
  EXPECT_EQ(frames_since(plane_of(4, {0, 0, 0, 1}), second, past)(0, 0), 2);
}

TEST(Grown, ReachesAsFarAlongBothAxes) {
  Plane mask(9, 7);
  mask(0, 0) = mask(6, 3) = 1;
  const Plane out = grown(mask, 2);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x) {
      const bool near_corner = x <= 2 && y <= 2, near_other = std::abs(x - 6) <= 2 && std::abs(y - 3) <= 2;
      EXPECT_EQ(out(x, y), near_corner || near_other ? 1 : 0) << x << "," << y;
    }
  EXPECT_EQ(grown(mask, 0)(6, 3), 1);
}

TEST(MovingFootprint, IsAroundSurfacesButNotAroundLinesOfMixedPixels) {
  Past past;
  past.moving = Plane(24, 9);
  for (int y = 0; y < 9; ++y) {
    past.moving(20, y) = 1;  // one pixel wide: 3 of 9
    if (y >= 3 && y < 5) past.moving(5, y) = past.moving(6, y) = 1;
  }
  const Plane out = moving_footprint(past, 2);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 24; ++x) EXPECT_EQ(out(x, y), x >= 3 && x <= 8 && y >= 1 && y <= 6 ? 1 : 0) << x << "," << y;
}

TEST(UnstablePixels, AreThinThingsAndWhatIsNearThem) {
  // A slanted wall, which is linear in 1/z, with an edge (stable on either side), a railing of one pixel and sky.
  Plane depth(60, 9);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 60; ++x) {
      depth(x, y) = 1 / (0.2F - 0.003F * static_cast<float>(x));
      if (x < 10) depth(x, y) = 2;
      if (x == 40) depth(x, y) = 3;
      if (x > 55) depth(x, y) = kInf;
    }
  const Plane out = unstable_pixels(depth, 4);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 60; ++x) EXPECT_EQ(out(x, y), std::abs(x - 40) <= 4 ? 1 : 0) << x << "," << y;
}

}  // namespace
}  // namespace aftershade::metrics
