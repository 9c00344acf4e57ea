#include "core/temporal/reprojection.h"

#include <numbers>

#include "tests/temporal/temporal_helpers.h"

namespace aftershade::tests {
namespace {

using temporal::reproject;
using temporal::Reprojected;
using temporal::ReprojectionInput;
using temporal::ReprojectionSource;

constexpr int kWidth = 61, kHeight = 37;
const Window kWindow = window_of(kWidth, kHeight, 100, -7);

/// A camera turned by `yaw` around Y at `eye`, in plain trigonometry: the independent projection of these tests.
struct PlainCamera {
  Vec3 eye;
  double yaw, focal_px, cx, cy;

  Vec3 to_camera(Vec3 p) const {
    const Vec3 d = p - eye;
    return {std::cos(yaw) * d.x - std::sin(yaw) * d.z, d.y, std::sin(yaw) * d.x + std::cos(yaw) * d.z};
  }
  Vec3 direction(double x, double y) const {
    const double u = (x - cx) / focal_px, v = -(y - cy) / focal_px;
    return {std::cos(yaw) * u + std::sin(yaw), v, -std::sin(yaw) * u + std::cos(yaw)};
  }
  Vec3 image(Vec3 p) const {
    const Vec3 c = to_camera(p);
    return {cx + focal_px * c.x / c.z, cy - focal_px * c.y / c.z, c.z};
  }
  Camera canonical() const {
    Camera camera;
    camera.fx = camera.fy = focal_px;
    camera.cx = cx;
    camera.cy = cy;
    const double c = std::cos(yaw), s = std::sin(yaw);
    const Mat4 turn(c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, 0, 0, 1);
    camera.world_to_camera = Mat4().setTranslation(-eye) * turn;
    return camera;
  }
};

const PlainCamera kBefore{{-0.31, 1.72, -0.4}, 0.06, 68, 131.25, 10.5};
const PlainCamera kNow{{0.12, 1.6, 0.1}, 0.10, 70, 130.5, 11.5};

/// The plane  y = 0.2 z - 2, which fills the picture.
double plane_depth(const PlainCamera& camera, double x, double y) {
  const Vec3 d = camera.direction(x, y);
  return (0.2 * camera.eye.z - 2 - camera.eye.y) / (d.y - 0.2 * d.z);  // the direction's camera-space z is 1
}

Plane plane_depths() {
  return plane_of(kWidth, kHeight, [](int x, int y) {
    const double z = plane_depth(kNow, kWindow.min_x + x + 0.5, kWindow.min_y + y + 0.5);
    return z > 0 ? static_cast<float>(z) : kInf;
  });
}

ReprojectionInput moving_camera(ConstPlaneView depth) {
  return {depth, kWindow, CameraReprojection::create(kNow.canonical(), kBefore.canonical()), {}, {}};
}

TEST(Reprojection, AHoleInCarriedVectorsHasNoPast) {
  const Plane depth = plane_depths(), unknown(kWidth, kHeight, std::numeric_limits<float>::quiet_NaN());
  ReprojectionInput input = moving_camera(depth);
  const float by_camera = reproject(input, ReprojectionSource::automatic, 0.5F).x(30, 30);
  input.mv_prev_x = input.mv_prev_y = unknown;
  EXPECT_EQ(reproject(input, ReprojectionSource::automatic, 0.5F).x(30, 30), by_camera) << "a file's unknown vector";
  input.holes_are_invalid = true;
  EXPECT_TRUE(std::isnan(reproject(input, ReprojectionSource::automatic, 0.5F).x(30, 30)));
  EXPECT_EQ(reproject(input, ReprojectionSource::camera, 0.5F).x(30, 30), by_camera) << "vectors do not count";
}

TEST(Reprojection, MovingCameraAgreesWithAnIndependentProjection) {
  const Plane depth = plane_depths();
  const Reprojected got = reproject(moving_camera(depth), ReprojectionSource::automatic, 0.5F);
  double worst_px = 0, worst_depth = 0;
  int surface = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!std::isfinite(depth(x, y))) continue;
      const double px = kWindow.min_x + x + 0.5, py = kWindow.min_y + y + 0.5;
      const Vec3 want = kBefore.image(kNow.eye + kNow.direction(px, py) * plane_depth(kNow, px, py));
      if (want.z <= 0) continue;
      worst_px = std::fmax(worst_px, std::hypot(got.x(x, y) - want.x, got.y(x, y) - want.y));
      worst_depth = std::fmax(worst_depth, std::abs(got.depth(x, y) / want.z - 1));
      ++surface;
    }
  RecordProperty("worst_px", std::to_string(worst_px));
  EXPECT_GT(surface, kWidth * kHeight / 2);
  EXPECT_LT(worst_px, 1e-4);
  EXPECT_LT(worst_depth, 1e-6);
}

TEST(Reprojection, StillCameraGivesEveryPixelsOwnCentreExactly) {
  const Plane depth = plane_depths();
  const ReprojectionInput input{depth, kWindow, CameraReprojection::create(kNow.canonical(), kNow.canonical()), {}, {}};
  const Reprojected got = reproject(input, ReprojectionSource::automatic, 0.5F), want = standing_still(depth, kWindow);
  EXPECT_EQ(different_pixels(got.x, want.x), 0);
  EXPECT_EQ(different_pixels(got.y, want.y), 0);
  EXPECT_EQ(different_pixels(got.depth, want.depth), 0);
}

TEST(Reprojection, TheVectorDecidesOnlyWhereTheCameraDisagrees) {
  const Plane depth = plane_depths();
  ReprojectionInput input = moving_camera(depth);
  const Reprojected camera = reproject(input, ReprojectionSource::automatic, 0.5F);
  // Columns in turn: agrees within 0.49 px, disagrees by 0.51 px, moves 9 px, unknown.
  const float offset[] = {0.49F, 0.51F, 9.0F, kNaN};
  const auto vector = [&](const Plane& before, bool along_x) {
    return plane_of(kWidth, kHeight, [&, along_x](int x, int y) {
      const float here =
          along_x ? static_cast<float>(kWindow.min_x + x) + 0.5F : static_cast<float>(kWindow.min_y + y) + 0.5F;
      return before(x, y) - here + (along_x ? offset[x % 4] : 0.0F);
    });
  };
  const Plane mv_x = vector(camera.x, true), mv_y = vector(camera.y, false);
  input.mv_prev_x = mv_x;
  input.mv_prev_y = mv_y;
  const Reprojected got = reproject(input, ReprojectionSource::automatic, 0.5F);
  for (int y = 20; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool vector_used = x % 4 == 1 || x % 4 == 2;
      ASSERT_NEAR(got.x(x, y) - camera.x(x, y), vector_used ? offset[x % 4] : 0.0F, vector_used ? 1e-4 : 0);
      ASSERT_EQ(got.depth(x, y), camera.depth(x, y));
    }
  const Reprojected literal = reproject(input, ReprojectionSource::camera, 0.5F);
  EXPECT_EQ(different_pixels(literal.x, camera.x) + different_pixels(literal.y, camera.y), 0);
}

TEST(Reprojection, WithoutCameraOnlyVectorsAreKnown) {
  const Plane depth = plane_of(4, 1, [](int x, int) { return x == 3 ? kInf : 5.0F; });
  const Plane mv_x = plane_of(4, 1, [](int x, int) { return x == 1 ? kNaN : 2.25F; });
  const Plane mv_y = plane_of(4, 1, [](int x, int) { return x == 2 ? kInf : -1.5F; });
  const ReprojectionInput input{depth, window_of(4, 1, 10, 20), std::nullopt, mv_x, mv_y};
  const Reprojected got = reproject(input, ReprojectionSource::automatic, 0.5F);
  EXPECT_EQ(got.x(0, 0), 12.75F);
  EXPECT_EQ(got.y(0, 0), 19.0F);
  EXPECT_EQ(got.depth(0, 0), 5.0F);
  for (int x = 1; x < 4; ++x)
    EXPECT_TRUE(std::isnan(got.x(x, 0)) && std::isnan(got.y(x, 0)) && std::isnan(got.depth(x, 0)));
  const Reprojected literal = reproject(input, ReprojectionSource::camera, 0.5F);
  EXPECT_TRUE(std::isnan(literal.x(0, 0)));
}

TEST(Reprojection, BackgroundBadDepthAndPointsBehindTheCameraAreUnknown) {
  Plane depth(6, 1, 3.0F);
  depth(0, 0) = kInf;
  depth(1, 0) = kNaN;
  depth(2, 0) = 0;
  depth(3, 0) = -2;
  PlainCamera turned = kNow;
  turned.yaw += std::numbers::pi;
  for (const PlainCamera& before : {kNow, turned}) {
    const Plane zero(6, 1);
    const ReprojectionInput input{depth, window_of(6, 1, 130, 11),
                                  CameraReprojection::create(kNow.canonical(), before.canonical()), zero, zero};
    const Reprojected got = reproject(input, ReprojectionSource::camera, 0.5F);
    for (int x = 0; x < 6; ++x) EXPECT_EQ(std::isnan(got.x(x, 0)), x < 4 || before.yaw != kNow.yaw) << x;
    for (int x = 0; x < 6; ++x) EXPECT_EQ(std::isnan(got.x(x, 0)), std::isnan(got.depth(x, 0))) << x;
  }
}

TEST(Reprojection, OrthographicCamera) {
  Camera now = kNow.canonical(), before = kNow.canonical();
  now.orthographic = before.orthographic = true;
  now.fx = now.fy = before.fx = before.fy = 8;  // pixels per metre
  now.world_to_camera = Mat4();
  before.world_to_camera = Mat4().setTranslation(Vec3(-0.5, 0.25, 2));
  const Plane depth(3, 2, 4.0F);
  const Reprojected got = reproject({depth, window_of(3, 2), CameraReprojection::create(now, before), {}, {}},
                                    ReprojectionSource::automatic, 0.5F);
  EXPECT_FLOAT_EQ(got.x(1, 1), 1.5F - 4);
  EXPECT_FLOAT_EQ(got.y(1, 1), 1.5F - 2);
  EXPECT_FLOAT_EQ(got.depth(1, 1), 6);
}

TEST(Reprojection, DoesNotDependOnThreads) {
  const Plane depth = plane_depths();
  const Reprojected many = reproject(moving_camera(depth), ReprojectionSource::automatic, 0.5F);
  const ThreadLimit one(1);
  const Reprojected single = reproject(moving_camera(depth), ReprojectionSource::automatic, 0.5F);
  EXPECT_EQ(different_pixels(many.x, single.x) + different_pixels(many.y, single.y) +
                different_pixels(many.depth, single.depth),
            0);
}

}  // namespace
}  // namespace aftershade::tests
