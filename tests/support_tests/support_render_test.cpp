#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"
#include "tests/support/truth.h"

namespace aftershade::tests {
namespace {

constexpr RenderSettings kSmall{240, 135, 1};

class EveryScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene,
                         testing::Values("corner", "columns", "grass", "trail", "crossing", "garden"),
                         [](const auto& param) { return param.param; });

TEST_P(EveryScene, StaticGeometryMovesAsTheCamerasSay) {
  const Scene& scene = find_scene(GetParam());
  const Frame frame = render(scene, 4, kSmall, kSceneRoles, false);
  const PlacedScene placed(scene, 4);
  const RayFan rays(*frame.camera);
  const auto to_next = CameraReprojection::create(*frame.camera, camera_at(scene, 5, 240, 135)).value();
  const auto to_before = CameraReprojection::create(*frame.camera, camera_at(scene, 3, 240, 135)).value();
  const auto expect_vector = [&](const CameraReprojection& reproject, Role role, int x, int y) {
    const Vec3 there = reproject(x + 0.5, y + 0.5, double{frame.depth()(x, y)});
    const auto& mv = frame.planes(role);
    return std::max(std::abs(there.x - x - 0.5 - double{mv[0](x, y)}),
                    std::abs(there.y - y - 0.5 - double{mv[1](x, y)}));
  };
  int checked = 0;
  double worst = 0;
  for (int y = 0; y < 135; ++y)
    for (int x = 0; x < 240; ++x) {
      const auto hit = placed.trace(rays(x + 0.5, y + 0.5));
      if (!hit) continue;
      const Motion& motion = scene.objects[hit->object].motion;
      if (motion.object_to_world(4) != motion.object_to_world(5)) continue;
      ++checked;
      worst = std::max({worst, expect_vector(to_next, Role::velocity_next, x, y),
                        expect_vector(to_before, Role::velocity_prev, x, y)});
    }
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(checked, 240 * 135 / 3);
}

TEST_P(EveryScene, PlanesAreWhatTheFramePromises) {
  const Frame frame = render(find_scene(GetParam()), 2, kSmall);
  const auto& normal = frame.planes(Role::normal);
  const auto& rgba = frame.layers.at(0).planes;
  const auto& ambient = frame.planes(Role::ambient);
  for (int y = 0; y < 135; ++y)
    for (int x = 0; x < 240; ++x) {
      const bool surface = std::isfinite(frame.depth()(x, y));
      ASSERT_TRUE(surface ? frame.depth()(x, y) > 0.2F : frame.depth()(x, y) > 0);
      ASSERT_EQ(rgba[3](x, y), surface ? 1 : 0);
      const Vec3 n(normal[0](x, y), normal[1](x, y), normal[2](x, y));
      ASSERT_NEAR(n.length(), surface ? 1 : 0, 1e-5);
      ASSERT_LE(n.dot(frame.camera->unproject(x + 0.5, y + 0.5, 1)), 1e-5) << "faces the camera";
      for (size_t c = 0; c < 3; ++c) ASSERT_LE(ambient[c](x, y), rgba[c](x, y)) << "ambient is a part of the colour";
      for (Role role : {Role::velocity_prev, Role::velocity_next})
        for (const Plane& mv : frame.planes(role)) ASSERT_TRUE(std::isfinite(mv(x, y)));
    }
}

TEST_P(EveryScene, DoesNotDependOnTheNumberOfThreads) {
  const RenderSettings settings{64, 36, 4};
  const AoTruth truth{1, Weighting::cosine, Falloff::squared, 16};
  const Scene& scene = find_scene(GetParam());
  set_thread_count(1);
  const Frame one = render(scene, 3, settings);
  const Plane ao_one = ambient_occlusion_truth(scene, 3, 64, 36, truth);
  set_thread_count(2);
  const Frame two = render(scene, 3, settings);
  const Plane ao_two = ambient_occlusion_truth(scene, 3, 64, 36, truth);
  set_thread_count(0);
  for (int y = 0; y < 36; ++y) {
    EXPECT_TRUE(std::equal(ao_one.row(y), ao_one.row(y) + 64, ao_two.row(y)));
    for (const RoleInfo& role : kRoles)
      for (size_t c = 0; c < one.planes(role.role).size(); ++c)
        EXPECT_TRUE(std::equal(one.planes(role.role)[c].row(y), one.planes(role.role)[c].row(y) + 64,
                               two.planes(role.role)[c].row(y)));
    for (size_t c = 0; c < 4; ++c)
      EXPECT_TRUE(std::equal(one.layers[0].planes[c].row(y), one.layers[0].planes[c].row(y) + 64,
                             two.layers[0].planes[c].row(y)));
  }
}

/// A ball straight ahead; `turns` a frame about the vertical.
Scene ball_ahead(const Vec3& velocity, double turns) {
  Scene scene{"ball", "", {}, {}, {}};
  Motion motion;
  motion.velocity = velocity;
  motion.spin_turns_per_frame = turns;
  scene.objects = {{Sphere{0.5}, {}, motion}};
  scene.camera.eye.origin = {0, 0, 5};
  return scene;
}

TEST(Velocity, OfAMovingBallIsItsProjectedMotion) {
  const Frame frame = render(ball_ahead({0.2, 0.1, 0}, 0), 0, {241, 135, 1});
  const double scale = frame.camera->fx / 4.5;  // the ball's front is 4.5 m away
  EXPECT_NEAR(frame.depth()(120, 67), 4.5, 1e-6);
  EXPECT_NEAR(frame.planes(Role::velocity_next)[0](120, 67), 0.2 * scale, 1e-4);
  EXPECT_NEAR(frame.planes(Role::velocity_next)[1](120, 67), -0.1 * scale, 1e-4);
  EXPECT_NEAR(frame.planes(Role::velocity_prev)[0](120, 67), -0.2 * scale, 1e-4);
  EXPECT_NEAR(frame.planes(Role::velocity_prev)[1](120, 67), 0.1 * scale, 1e-4);
}

TEST(Velocity, FollowsThePointOfASpinningBall) {
  const Frame frame = render(ball_ahead({0, 0, 0}, 0.05), 0, {241, 135, 1});
  const double angle = 2 * 3.14159265358979 * 0.05;  // right-handed about +Y: the front moves to +X
  const Vec3 there = frame.camera->project({0.5 * std::sin(angle), 0, 5 - 0.5 * std::cos(angle)});
  EXPECT_NEAR(frame.planes(Role::velocity_next)[0](120, 67), there.x - 120.5, 1e-4);
  EXPECT_NEAR(frame.planes(Role::velocity_prev)[0](120, 67), 120.5 - there.x, 1e-4);
}

TEST(Velocity, OfTheBackgroundIsTheCamerasRotation) {
  Scene scene = ball_ahead({0, 0, 0}, 0);
  scene.camera.eye.velocity = scene.camera.target.velocity = {0.5, 0, 0};
  const Frame trucking = render(scene, 0, kSmall, kSceneRoles, false);
  EXPECT_NEAR(trucking.planes(Role::velocity_next)[0](3, 3), 0, 1e-4);
  scene.camera.eye.velocity = {0, 0, 0};
  const Frame panning = render(scene, 0, kSmall, kSceneRoles, false);
  // Turned to the right by atan(0.5 / 5), the middle of the image moves to the left.
  EXPECT_NEAR(panning.planes(Role::velocity_next)[0](120, 3), -0.1 * panning.camera->fx, 1.5);
}

TEST(SecondDepth, IsWhatShowsBehindTheFirstObject) {
  Scene scene = ball_ahead({0, 0, 0}, 0);  // 4.5 m to 5.5 m away, and the camera looks along -Z
  const auto place = [&](Shape shape, const Vec3& origin) {
    Motion motion;
    motion.origin = origin;
    scene.objects.push_back({shape, {}, motion});
  };
  const auto depths = [&] {
    Frame frame = render(scene, 0, {3, 3, 1}, {Role::depth, Role::depth2}, false);
    return std::pair(double{frame.depth()(1, 1)}, double{frame.planes(Role::depth2).at(0)(1, 1)});
  };
  constexpr double kInf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(depths(), std::pair(4.5, kInf)) << "its own back does not show";
  place(Triangle{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {0, 0, -3});
  EXPECT_EQ(depths().second, 8) << "a thin surface";
  place(Triangle{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {0, 0, 0.1});
  EXPECT_EQ(depths().second, 8) << "inside the ball it does not show";
  place(Box{{1, 1, 0.25}}, {0, 0, -1.75});
  EXPECT_NEAR(depths().second, 6.5, 1e-6) << "a solid";
  place(Box{{1, 1, 0.25}}, {0, 0, -0.5});
  EXPECT_NEAR(depths().second, 6.5, 1e-6) << "one that begins inside the ball is one with it";
  place(Triangle{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}, {0, 0, 2});
  EXPECT_EQ(depths().first, 3) << "a thin surface has no inside";
  EXPECT_NEAR(depths().second, 4.5, 1e-6);
}

TEST(SecondDepth, ShowsNoFloorUnderWhatStandsOnIt) {
  Scene scene = ball_ahead({0, 0, 0}, 0);
  Motion up;
  up.origin = {0, 0.5, 0};
  scene.objects = {{Ground{}, {}, {}}, {Box{{0.5, 0.5, 0.5}}, {}, up}};
  scene.camera.eye.origin = {0, 4, 1};
  const Frame frame = render(scene, 0, {3, 3, 1}, {Role::depth, Role::depth2}, false);
  EXPECT_GT(frame.depth()(1, 1), 2);
  EXPECT_TRUE(std::isinf(frame.planes(Role::depth2).at(0)(1, 1)));
}

TEST_P(EveryScene, TheSecondDepthIsBeyondTheFirst) {
  const Frame frame = render(find_scene(GetParam()), 3, kSmall, {Role::depth, Role::depth2}, false);
  int behind = 0;
  for (int y = 0; y < kSmall.height; ++y)
    for (int x = 0; x < kSmall.width; ++x) {
      const float first = frame.depth()(x, y), second = frame.planes(Role::depth2)[0](x, y);
      ASSERT_TRUE(second > first || (std::isinf(first) && std::isinf(second))) << x << ' ' << y;
      behind += std::isfinite(second) ? 1 : 0;
    }
  EXPECT_GT(behind, 100);
}

TEST(TrailScene, FloorPointsLieWithinTheStableDistance) {
  const Scene& scene = find_scene("trail");
  const PlacedScene placed(scene, 3);
  const RayFan rays(camera_at(scene, 3, 240, 135));
  ASSERT_TRUE(std::holds_alternative<Ground>(scene.objects[0].shape));
  const auto floor_point = [&](int x, int y) {
    const auto hit = placed.trace(rays(x + 0.5, y + 0.5));
    return hit && hit->object == 0 ? std::optional(hit->position) : std::nullopt;
  };
  int checked = 0;
  double widest = 0;
  for (int y = 0; y < 134; ++y)
    for (int x = 0; x < 239; ++x) {
      const auto here = floor_point(x, y), right = floor_point(x + 1, y), below = floor_point(x, y + 1);
      if (!here || !right || !below) continue;
      ++checked;
      widest = std::max({widest, (*here - *right).length(), (*here - *below).length()});
    }
  EXPECT_GT(checked, 20000);
  EXPECT_LT(widest, 0.1);
}

TEST(CrossingScene, IsFast) {
  const Frame frame = render(find_scene("crossing"), 4, kSmall, kSceneRoles, false);
  float left = 0, right = 0;
  for (int y = 0; y < 135; ++y)
    for (int x = 0; x < 240; ++x) {
      left = std::min(left, frame.planes(Role::velocity_next)[0](x, y));
      right = std::max(right, frame.planes(Role::velocity_next)[0](x, y));
    }
  EXPECT_LT(left, -15);
  EXPECT_GT(right, 15);
}

TEST(SceneSource, GivesWhatIsAskedFor) {
  SceneSource source(find_scene("trail"), {32, 18, 1}, 1, 3);
  EXPECT_FALSE(source.load(0, "", kSceneRoles, true));
  EXPECT_FALSE(source.load(4, "", kSceneRoles, true));
  const auto frame = source.load(2, "", {Role::depth}, false);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->number, 2);
  EXPECT_TRUE(frame->has(Role::depth));
  EXPECT_FALSE(frame->has(Role::normal));
  EXPECT_TRUE(frame->layers.empty());
  EXPECT_EQ(source.load(2, "", {}, true)->layers.size(), 1U);
}

TEST(Scenes, UnknownNamesAreRefusedWithAList) {
  try {
    find_scene("gardn");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(error.hint().find("corner, columns, grass, trail, crossing, garden"), std::string::npos);
  }
}

}  // namespace
}  // namespace aftershade::tests
