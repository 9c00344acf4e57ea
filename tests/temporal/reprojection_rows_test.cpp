#include <cmath>

#include "core/temporal/reprojection.h"
#include "tests/temporal/temporal_helpers.h"

/// Reprojection row by row: as exact as the cameras' double precision, and no more work than is asked for.
namespace aftershade::tests {
namespace {

using temporal::Reprojection;
using temporal::ReprojectionInput;
using temporal::ReprojectionSource;

Camera camera_of(double focal_px, double yaw, Vec3 eye, bool orthographic = false) {
  Camera camera;
  camera.fx = focal_px;
  camera.fy = focal_px * 1.01;
  camera.cx = 1920.3;
  camera.cy = 1079.2;
  camera.orthographic = orthographic;
  const double c = std::cos(yaw), s = std::sin(yaw);
  camera.world_to_camera = Mat4().setTranslation(-eye) * Mat4(c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, 0, 0, 1);
  return camera;
}

struct Worst {
  double px = 0, depth = 0;
};

/// Against CameraReprojection, on every 60th row of a picture of 3840 x 2160.
Worst worst_difference(const Camera& now, const Camera& before) {
  const int width = 3840, height = 2160;
  const Plane depth = plane_of(width, height, [](int x, int y) { return 0.5F + 200 * std::pow(noise(x, y), 3.0F); });
  const auto cameras = CameraReprojection::create(now, before);
  const Reprojection rows({depth, window_of(width, height), cameras, {}, {}}, ReprojectionSource::automatic, 0.5F);
  Plane past(width, 3);
  Worst worst;
  for (int y = 0; y < height; y += 60) {
    rows.row(y, nullptr, past.row(0), past.row(1), past.row(2));
    for (int x = 0; x < width; ++x) {
      const Vec3 want = (*cameras)(x + 0.5, y + 0.5, double{depth(x, y)});
      if (!(want.z > 0)) continue;
      worst.px = std::fmax(worst.px, std::hypot(past(x, 0) - want.x, past(x, 1) - want.y));
      worst.depth = std::fmax(worst.depth, std::abs(past(x, 2) / want.z - 1));
    }
  }
  return worst;
}

TEST(ReprojectionRows, AreAsGoodAsDoublePrecisionAt4K) {
  const double radians = std::acos(-1.0) / 180;
  const Camera now = camera_of(3300, 0.3, {105.2, 1.7, -33});
  const auto expect = [&](const char* what, const Camera& a, const Camera& b, double px) {
    const Worst worst = worst_difference(a, b);
    RecordProperty(what, std::to_string(worst.px));
    EXPECT_LT(worst.px, px) << what;
    EXPECT_LT(worst.depth, 2e-6) << what;
  };
  expect("walk", now, camera_of(3300, 0.3 + 0.2 * radians, {105.15, 1.7, -33.04}), 5e-4);
  expect("whip_pan_and_zoom", now, camera_of(3100, 0.3 + 8 * radians, {104.9, 1.9, -33.5}), 2e-3);
  const Camera plan = camera_of(40, 0.3, {105.2, 1.7, -33}, true);
  expect("orthographic", plan, camera_of(41, 0.31, {105.1, 1.8, -33.2}, true), 2e-3);
  expect("perspective_to_orthographic", now, plan, 2e-3);
  expect("orthographic_to_perspective", plan, now, 0.5);  // hundreds of thousands of pixels outside the picture
}

TEST(ReprojectionRows, AStillCameraMovesNothingByAnyBit) {
  for (const bool orthographic : {false, true}) {
    const Camera camera = camera_of(orthographic ? 40 : 3333.3, 0.7, {1051.2, 17, -333}, orthographic);
    const Window window = window_of(300, 40, -17, 1061);
    const Plane depth = plane_of(300, 40, [](int x, int y) { return 0.1F + 900 * noise(x, y); });
    const auto got = reproject({depth, window, CameraReprojection::create(camera, camera), {}, {}},
                               ReprojectionSource::camera, 0.5F);
    const auto want = standing_still(depth, window);
    EXPECT_EQ(different_pixels(got.x, want.x) + different_pixels(got.y, want.y), 0);
    EXPECT_EQ(different_pixels(got.depth, want.depth), 0);
  }
}

TEST(ReprojectionRows, DoNotDependOnTheWindowOrTheUnitOfLength) {
  const Plane depth = plane_of(64, 48, [](int x, int y) { return 1 + 9 * noise(x, y); });
  const Plane far = plane_of(64, 48, [&](int x, int y) { return 256 * depth(x, y); });
  Plane part(50, 30);
  copy_at(depth, part, -9, -7);
  const auto past = [](ConstPlaneView z, Window window, double unit) {
    const Camera now = camera_of(900, 0.3, Vec3(1, 2, 3) * unit), before = camera_of(900, 0.31, Vec3(1.1, 2, 3) * unit);
    return reproject({z, window, CameraReprojection::create(now, before), {}, {}}, ReprojectionSource::camera, 0.5F);
  };
  const auto whole = past(depth, window_of(64, 48, 1900, 1000), 1), cut = past(part, window_of(50, 30, 1909, 1007), 1);
  const auto scaled = past(far, window_of(64, 48, 1900, 1000), 256);
  EXPECT_EQ(different_pixels(whole.x, scaled.x) + different_pixels(whole.y, scaled.y), 0);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 50; ++x) {
      ASSERT_EQ(cut.x(x, y), whole.x(x + 9, y + 7));
      ASSERT_EQ(cut.y(x, y), whole.y(x + 9, y + 7));
      ASSERT_EQ(cut.depth(x, y), whole.depth(x + 9, y + 7));
    }
}

TEST(ReprojectionRows, LeaveAloneWhatIsNotNeeded) {
  const Plane depth(40, 1, 5.0F);
  const Camera camera = camera_of(100, 0, {0, 0, 0});
  const Reprojection rows({depth, window_of(40, 1), CameraReprojection::create(camera, camera), {}, {}},
                          ReprojectionSource::camera, 0.5F);
  const Plane not_needed = plane_of(40, 1, [](int x, int) { return x < 17 ? 1.0F : 0.0F; });
  Plane past(40, 3, -1.0F);
  rows.row(0, not_needed.row(0), past.row(0), past.row(1), past.row(2));
  EXPECT_EQ(past(3, 0), -1.0F);
  EXPECT_EQ(past(3, 2), -1.0F);
  EXPECT_EQ(past(39, 0), 39.5F);
  EXPECT_EQ(past(17, 2), 5.0F);
}

TEST(ShareWithoutHistory, OfOneRowInEightIsThatOfThePicture) {
  const int width = 200, height = 160;
  const Camera camera = camera_of(100, 0, {0, 0, 0});
  const Plane depth(width, height, 5.0F);
  const Plane stored = plane_of(width, height, [](int x, int y) { return noise(x, y) < 0.4F ? 9.0F : 5.0F; });
  const auto cameras = CameraReprojection::create(camera, camera);
  for (const int min_y : {0, 3, -5}) {
    const Window window = window_of(width, height, 0, min_y);
    const ReprojectionInput input{depth, window, cameras, {}, {}};
    const Reprojection rows(input, ReprojectionSource::camera, 0.5F);
    const auto planes = reproject(input, ReprojectionSource::camera, 0.5F);
    const double of_rows = share_without_history(depth, window, rows, stored, window);
    EXPECT_NEAR(of_rows, 0.4, 0.02);
    EXPECT_NEAR(share_without_history(depth, planes, stored, window), 0.4, 0.01);
    EXPECT_NE(share_without_history(depth, planes, stored, window), of_rows);
    EXPECT_EQ(share_without_history(depth, window, rows, {}, {}), 0);
    EXPECT_EQ(share_without_history(depth, window, rows, stored, window_of(width, height, 5000, 0)), 1);
  }
}

TEST(ShareWithoutHistory, ALowWindowIsSeenWhole) {
  const Camera camera = camera_of(100, 0, {0, 0, 0});
  const Plane depth(50, 7, 5.0F), stored = plane_of(50, 7, [](int x, int) { return x < 20 ? 9.0F : 5.0F; });
  const Window window = window_of(50, 7, 0, 9);  // holds no multiple of 8
  const Reprojection rows({depth, window, CameraReprojection::create(camera, camera), {}, {}},
                          ReprojectionSource::camera, 0.5F);
  EXPECT_EQ(share_without_history(depth, window, rows, stored, window), 0.4);
}

}  // namespace
}  // namespace aftershade::tests
