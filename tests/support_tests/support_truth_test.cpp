#include <gtest/gtest.h>

#include <cmath>

#include "core/metrics/image_metrics.h"
#include "tests/support/scenes.h"
#include "tests/support/truth_cache.h"

namespace aftershade::tests {
namespace {

struct CornerRow {
  double distance, uniform_squared, cosine_squared, cosine_hard;  // occlusion
};
/// algorithms 12.1, the reference columns.
constexpr CornerRow kCorner[] = {{.05, .451, .439, .469}, {.10, .405, .383, .437}, {.20, .320, .284, .374},
                                 {.35, .211, .168, .282}, {.50, .125, .087, .195}, {.70, .045, .024, .094}};

class CornerTruth : public testing::TestWithParam<double> {};  // the radius in metres

TEST_P(CornerTruth, AgreesWithTheAnalyticAnchors) {
  const PlacedScene corner(find_scene("corner"), 1);
  const double radius = GetParam();
  const auto occlusion = [&](double d, Weighting weighting, Falloff falloff) {
    return 1 - ambient_occlusion_at(corner, {0.3, 0, d * radius}, {0, 1, 0}, {radius, weighting, falloff, 1 << 16}, 5);
  };
  for (const CornerRow& row : kCorner) {
    const double d = row.distance;
    EXPECT_NEAR(occlusion(d, Weighting::uniform, Falloff::hard), (1 - d) / 2, 0.001) << d;
    EXPECT_NEAR(occlusion(d, Weighting::uniform, Falloff::squared), row.uniform_squared, 0.002) << d;
    EXPECT_NEAR(occlusion(d, Weighting::cosine, Falloff::squared), row.cosine_squared, 0.002) << d;
    EXPECT_NEAR(occlusion(d, Weighting::cosine, Falloff::hard), row.cosine_hard, 0.002) << d;
  }
}
INSTANTIATE_TEST_SUITE_P(Radii, CornerTruth, testing::Values(0.5, 1.0, 2.0));

TEST(CornerTruth, LinearFalloffLiesBelowSquaredAndHard) {
  const PlacedScene corner(find_scene("corner"), 1);
  const auto occlusion = [&](Falloff falloff) {
    return 1 - ambient_occlusion_at(corner, {0, 0, 0.2}, {0, 1, 0}, {1, Weighting::uniform, falloff, 1 << 14}, 5);
  };
  // In a direction of slope s to the wall the distance is d/s; integrated over s in (d, 1): (1 - d + d ln d) / 2.
  EXPECT_NEAR(occlusion(Falloff::linear), (1 - 0.2 + 0.2 * std::log(0.2)) / 2, 0.002);
  EXPECT_LT(occlusion(Falloff::squared), occlusion(Falloff::hard));
}

TEST(AoTruthImage, FollowsTheDistanceToTheWall) {
  const int width = 120, height = 68;
  const Plane ao = cached_ao_truth("corner", 1, width, height, {1, Weighting::uniform, Falloff::hard, 256});
  const Frame frame = render(find_scene("corner"), 1, {width, height, 1}, {Role::depth}, false);
  const Mat4 to_world = inverse(*frame.camera->world_to_camera).value();
  Plane expected(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec3 p = transform_point(frame.camera->unproject(x + 0.5, y + 0.5, double{frame.depth()(x, y)}), to_world);
      expected(x, y) = static_cast<float>(1 - std::max(0.0, 1 - std::max(p.y, p.z)) / 2);  // 0 is the other surface
    }
  EXPECT_LT(metrics::rmse(ao, expected), 0.01);
  EXPECT_NEAR(metrics::mean_error(ao, expected), 0, 0.001);
}

TEST(AoChange, IsNothingWhereOnlyTheCameraMoves) {
  for (const char* scene : {"columns", "grass"}) {
    const Plane change = ambient_occlusion_change(find_scene(scene), 3, 40, 24, {});
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 40; ++x) ASSERT_EQ(change(x, y), 0) << scene << " " << x << " " << y;
  }
}

TEST(AoChange, BrightensBehindAMovingObjectAndDarkensBeforeIt) {
  const int width = 80, height = 45;
  const AoTruth truth{1, Weighting::cosine, Falloff::hard, 256};
  const Scene& scene = find_scene("trail");  // its box moves along x, 0.18 m a frame
  const PlacedScene placed(scene, 3);
  const RayFan rays(camera_at(scene, 3, width, height));
  const double box_x = scene.objects[1].motion.object_to_world(3)[3][0];
  const Plane change = cached_ao_change("trail", 3, width, height, truth);
  int behind = 0, ahead = 0, untouched = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto hit = placed.trace(rays(x + 0.5, y + 0.5));
      ASSERT_TRUE(hit);
      const Vec3 p = hit->position;
      const double dx = p.x - box_x, dz = std::abs(p.z - 0.1);
      if (hit->object == 0 && dz < 0.15 && dx < -0.25 && dx > -0.45) behind += change(x, y) > 0.05F ? 1 : -1000;
      if (hit->object == 0 && dz < 0.15 && dx > 0.25 && dx < 0.45) ahead += change(x, y) < -0.05F ? 1 : -1000;
      const bool far = hit->object == 0 && (dx < -1.5 || dx > 1.5 || dz > 1.5);
      if (far || (hit->object == 1 && p.y > 0.599)) untouched += change(x, y) == 0 ? 1 : -1000;
    }
  EXPECT_GT(behind, 3);
  EXPECT_GT(ahead, 3);
  EXPECT_GT(untouched, 100);
}

TEST(AoChange, FollowsThePointsOfAMovingObject) {
  // A box that carries its own shelf along over a floor that ends nowhere: nothing changes at any point of the two.
  Scene scene = find_scene("trail");
  Object shelf = scene.objects[1];
  shelf.shape = Box{{0.1, 0.02, 0.1}};
  shelf.motion.origin = shelf.motion.origin + Vec3(0, 0.5, 0.2);
  scene.objects = {scene.objects[0], scene.objects[1], shelf};
  const int width = 80, height = 45;
  const Plane change = ambient_occlusion_change(scene, 3, width, height, {});
  const PlacedScene placed(scene, 3);
  const RayFan rays(camera_at(scene, 3, width, height));
  int points = 0, occluded = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto hit = placed.trace(rays(x + 0.5, y + 0.5));
      if (!hit || hit->object == 0) continue;
      ++points;
      EXPECT_NEAR(change(x, y), 0, 2.0 / 256) << "a ray or two on an edge, by rounding " << x << " " << y;
      occluded += ambient_occlusion_at(placed, hit->position, hit->normal, {}, 1) < 0.9 ? 1 : 0;
    }
  EXPECT_GT(points, 100);
  EXPECT_GT(occluded, 50);
}

TEST(AoTruthImage, IsOpenOnTheBackgroundAndClosedSomewhere) {
  const Plane ao = cached_ao_truth("columns", 4, 120, 68, {});
  const Frame frame = render(find_scene("columns"), 4, {120, 68, 1}, {Role::depth}, false);
  float least = 1;
  int background = 0;
  for (int y = 0; y < 68; ++y)
    for (int x = 0; x < 120; ++x) {
      least = std::min(least, ao(x, y));
      if (std::isfinite(frame.depth()(x, y))) continue;
      ++background;
      EXPECT_EQ(ao(x, y), 1);
    }
  EXPECT_GT(background, 100);
  EXPECT_LT(least, 0.6F);
}

TEST(BlurTruth, OfAStaticSceneIsTheUnblurredRender) {
  const RenderSettings settings{96, 54, 4};
  const auto blurred = cached_blur_truth("corner", 3, 0.5, 8, settings);
  const Frame sharp = render(find_scene("corner"), 3, settings);
  for (size_t c = 0; c < 4; ++c) EXPECT_LT(metrics::rmse(blurred[c], sharp.layers[0].planes[c]), 1e-6) << c;
}

/// An unshaded ball on black that crosses the middle of the image at time 4.
Scene lone_ball(double speed) {
  Scene scene{"ball", "", {}, {}, {}};
  Motion motion;
  motion.velocity = {speed, 0, 0};
  motion.origin = {-4 * speed, 0, 0};
  scene.objects = {{Sphere{0.3}, {}, motion}};
  scene.camera.eye.origin = {0, 0, 4};
  scene.light.sun = scene.light.zenith = scene.light.horizon = scene.light.ground = Vec3(0);
  scene.light.sun = {1, 1, 1};
  scene.light.to_sun = {0, 1, 0};
  return scene;
}

TEST(BlurTruth, KeepsEnergyAndIsCentred) {
  const RenderSettings settings{128, 72, 9};
  const Scene ball = lone_ball(0.5);
  const Frame sharp = render(ball, 4, settings);
  const auto blurred = motion_blur_truth(ball, 4, 1, 64, settings);
  double energy[2]{}, moment[2]{};
  int covered[2]{};
  for (int i = 0; i < 2; ++i) {
    const Plane& alpha = i == 0 ? sharp.layers[0].planes[3] : blurred[3];
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 128; ++x) {
        energy[i] += double{alpha(x, y)};
        moment[i] += double{alpha(x, y)} * (x + 0.5 - 64);
        covered[i] += alpha(x, y) > 0.001F ? 1 : 0;
      }
  }
  EXPECT_NEAR(energy[1] / energy[0], 1, 0.01);  // a sphere's image grows by about a per cent towards the edge
  EXPECT_NEAR(moment[1] / energy[1], moment[0] / energy[0], 0.05);
  // The shutter covers 0.5 m at 4 m: 17 px more of a disc 20 px wide.
  EXPECT_GT(covered[1], covered[0] * 3 / 2);
}

TEST(TruthCache, GivesBackWhatWasMadeAndMakesItOnce) {
  int made = 0;
  const std::string key = "test entry of the cache";
  std::remove(cache_path(key).c_str());
  const auto make = [&] {
    ++made;
    std::vector<Plane> planes;
    planes.emplace_back(5, 3, 0.25F);
    planes.emplace_back(5, 3, 0.75F);
    planes[1](4, 2) = -1;
    return planes;
  };
  const auto first = cached_planes(key, make), second = cached_planes(key, make);
  EXPECT_EQ(made, 1);
  ASSERT_EQ(second.size(), 2U);
  EXPECT_EQ(second[0](4, 2), 0.25F);
  EXPECT_EQ(second[1](4, 2), -1);
  EXPECT_NE(cache_path(key), cache_path(key + " "));
  EXPECT_THROW(cached_ao_truth("corner", 1, 241, 135, {}), std::logic_error);
}

}  // namespace
}  // namespace aftershade::tests
