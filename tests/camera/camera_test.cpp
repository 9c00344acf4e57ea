#include "core/camera/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace aftershade {
namespace {

/// A camera at `eye` that has turned by `yaw` about +Y, with a lens that is neither centred nor square.
Camera camera_at(Vec3 eye, double yaw, bool orthographic = false) {
  Camera camera;
  camera.fx = orthographic ? 40 : 900, camera.fy = orthographic ? 44 : 950, camera.cx = 470, camera.cy = 260;
  camera.orthographic = orthographic;
  const Vec3 right(std::cos(yaw), 0, -std::sin(yaw)), up(0, 1, 0), forward(std::sin(yaw), 0, std::cos(yaw));
  Mat4 m;  // columns are the camera's axes in the world
  for (int i = 0; i < 3; ++i) m[i][0] = right[i], m[i][1] = up[i], m[i][2] = forward[i];
  m[3][0] = -right.dot(eye), m[3][1] = -up.dot(eye), m[3][2] = -forward.dot(eye);
  camera.world_to_camera = m;
  return camera;
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Camera, ImageIsRightAndDown) {
  const Camera camera = camera_at({0, 0, 0}, 0);
  expect_near(camera.project({0, 0, 5}), {470, 260, 5}, 1e-12);
  EXPECT_GT(camera.project({1, 0, 5}).x, 470);
  EXPECT_LT(camera.project({0, 1, 5}).y, 260);
  expect_near(camera.unproject(470 + 900, 260 - 950, 2), {2, 2, 2}, 1e-12);
}

TEST(Camera, UnprojectUndoesProject) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const bool orthographic : {false, true})
    for (int i = 0; i < 200; ++i) {
      const Camera camera = camera_at({0, 0, 0}, 0, orthographic);
      const Vec3 point(10 * unit(random), 10 * unit(random), 10.5 + 10 * unit(random));
      const Vec3 image = camera.project(point);
      EXPECT_DOUBLE_EQ(image.z, point.z);
      expect_near(camera.unproject(image.x, image.y, image.z), point, 1e-10);
    }
}

TEST(Camera, PointsBehindHaveNoImage) {
  const Camera camera = camera_at({0, 0, 0}, 0);
  for (const double z : {0.0, -1.0, std::nan("")}) {
    EXPECT_TRUE(std::isnan(camera.project({1, 1, z}).x)) << z;
    EXPECT_TRUE(std::isnan(camera.project({1, 1, z}).y)) << z;
  }
  EXPECT_FALSE(std::isnan(camera_at({0, 0, 0}, 0, true).project({1, 1, -1}).x)) << "an orthographic camera sees behind itself";
}

TEST(CameraFromFov, SpansTheDisplayWindow) {
  for (const double fov : {10.0, 60.0, 120.0}) {
    const Camera camera = camera_from_fov(fov, 1, -100, 50, 1920, 1080);
    const double half = std::tan(fov / 360 * std::numbers::pi);
    expect_near(camera.project({-half, 0, 1}), {-100, 50 + 540, 1}, 1e-9);
    expect_near(camera.project({half, 0, 1}), {1820, 50 + 540, 1}, 1e-9);
    EXPECT_FALSE(camera.world_to_camera);
  }
}

TEST(CameraFromFov, PixelsAreAsWideAsTheirAspect) {
  const Camera camera = camera_from_fov(60, 2, 0, 0, 960, 1080);
  // A square in the world covers half as many pixels across as down when a pixel is twice as wide as high.
  EXPECT_NEAR(camera.fy / camera.fx, 2, 1e-12);
}

TEST(CameraReprojection, IsTheWayThroughTheWorld) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const Camera before = camera_at({unit(random), unit(random), unit(random)}, 0.3 * unit(random));
    const Camera now = camera_at({unit(random), unit(random), unit(random)}, 0.3 * unit(random));
    const Vec3 world(5 * unit(random), 5 * unit(random), 30 + 5 * unit(random));
    const Vec3 seen_now = now.project(transform_point(world, *now.world_to_camera));
    const Vec3 seen_before = before.project(transform_point(world, *before.world_to_camera));
    const auto reprojection = CameraReprojection::create(now, before);
    ASSERT_TRUE(reprojection);
    expect_near((*reprojection)(seen_now.x, seen_now.y, seen_now.z), seen_before, 1e-8);
  }
}

TEST(CameraReprojection, DeltaIsExactFarFromTheOrigin) {
  const Vec3 far(1e5, 0, 2e5);
  const auto reprojection = CameraReprojection::create(camera_at(far, 0.1), camera_at(far, 0.1));
  ASSERT_TRUE(reprojection);
  expect_near((*reprojection)(100.5, 200.5, 8), {100.5, 200.5, 8}, 1e-5);
}

TEST(CameraReprojection, KnownMoves) {
  const Camera still = camera_at({0, 0, 0}, 0);
  const auto same = CameraReprojection::create(still, still);
  expect_near((*same)(12.5, 34.5, 7), {12.5, 34.5, 7}, 1e-9);
  const auto dolly = CameraReprojection::create(camera_at({0, 0, 1}, 0), still);  // one metre forward since
  expect_near((*dolly)(470, 260, 4), {470, 260, 5}, 1e-9);
  const auto truck = CameraReprojection::create(camera_at({1, 0, 0}, 0), still);  // one metre to the right since
  expect_near((*truck)(470, 260, 9), {570, 260, 9}, 1e-9);
  EXPECT_TRUE(std::isnan((*CameraReprojection::create(still, camera_at({0, 0, 5}, 0)))(470, 260, 4).x))
      << "behind the camera before";
}

TEST(CameraReprojection, NeedsTwoGoodPositions) {
  const Camera placed = camera_at({0, 0, 0}, 0), lens_only = camera_from_fov(60, 1, 0, 0, 10, 10);
  EXPECT_FALSE(CameraReprojection::create(lens_only, placed));
  EXPECT_FALSE(CameraReprojection::create(placed, lens_only));
  Camera singular = placed;
  (*singular.world_to_camera)[1][1] = 0;
  EXPECT_FALSE(CameraReprojection::create(singular, placed));
}

TEST(LocalProjection, IsTheLensInIndexSpace) {
  const Camera camera = camera_at({0, 0, 0}, 0);
  const Projection local = local_projection(camera, -10, 20);
  EXPECT_EQ(local.fx, 900);
  EXPECT_EQ(local.fy, 950);
  EXPECT_EQ(local.cx, 480);
  EXPECT_EQ(local.cy, 240);
  EXPECT_FALSE(local.orthographic);
}

}  // namespace
}  // namespace aftershade
