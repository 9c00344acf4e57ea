#include "core/io/conversions.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "core/base/error.h"
#include "core/simd/targets.h"

namespace aftershade::io {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Plane row(const std::vector<float>& values) {
  Plane plane(static_cast<int>(values.size()), 1);
  for (size_t i = 0; i < values.size(); ++i) plane(static_cast<int>(i), 0) = values[i];
  return plane;
}
std::vector<Plane> rows(const std::vector<std::vector<float>>& planes) {
  std::vector<Plane> out;
  for (const auto& values : planes) out.push_back(row(values));
  return out;
}

std::vector<float> depth(const std::vector<float>& stored, const Encoding& encoding, DepthContext context = {}) {
  Plane plane = row(stored);
  context.window = {0, 0, plane.width() - 1, 0};
  convert_depth(plane, encoding, context);
  return {plane.row(0), plane.row(0) + plane.width()};
}

TEST(ConvertDepth, PlanarBackgroundAndUnit) {
  DepthContext context;
  context.metres_per_unit = 0.01;
  EXPECT_EQ(depth({200, 1e8F, 1e10F, kInf, kNan, 0, -3, 50}, {}, context),
            (std::vector<float>{2, kInf, kInf, kInf, kInf, kInf, kInf, 0.5F}));
  EXPECT_EQ(depth({65000, 64999}, {.background_above = 65000}), (std::vector<float>{kInf, 64999}));
}

TEST(ConvertDepth, NegativeMedianIsTurnedRound) {
  EXPECT_EQ(depth({-2, -3, -4, 0, -kInf, -1e10F, 1}, {}), (std::vector<float>{2, 3, 4, kInf, kInf, kInf, kInf}));
}

TEST(ConvertDepth, ScaleNeutralAndZero) {
  EXPECT_EQ(depth({0, 0.5F, 1}, {.zero_is_background = true, .scale = {100, 1, 1}, .neutral = -1}),
            (std::vector<float>{kInf, 150, 200}));
  EXPECT_EQ(depth({0, 0.5F, 1}, {.scale = {100, 1, 1}, .neutral = -1}), (std::vector<float>{100, 150, 200}));
}

TEST(ConvertDepth, RayDistance) {
  DepthContext context;
  context.camera = camera_from_fov(90, 1, 0, 0, 3, 1);  // fx = 1.5
  const auto z = depth({5, 5, 5}, {.depth_kind = DepthKind::ray}, context);
  EXPECT_NEAR(z[0], 5 / std::hypot(1, 1 / 1.5), 1e-6);
  EXPECT_EQ(z[1], 5);
  EXPECT_EQ(z[2], z[0]);
  EXPECT_THROW(depth({5}, {.depth_kind = DepthKind::ray}), Error);
}

TEST(ConvertDepth, DeviceKindsInvertTheProjection) {
  DepthContext context;
  context.near_plane = 0.1;
  context.far_plane = 1000;
  std::vector<float> stored, reversed;
  for (const double z : {0.1, 1.0, 10.0}) {
    const double n = 0.1, f = 1000, d = f / (f - n) * (1 - n / z);  // the API's definition
    stored.push_back(static_cast<float>(d));
    reversed.push_back(static_cast<float>(1 - d));
  }
  stored.push_back(1), reversed.push_back(0);
  const auto z = depth(stored, {.depth_kind = DepthKind::device}, context),
             r = depth(reversed, {.depth_kind = DepthKind::device_reversed}, context);
  for (const auto& got : {z, r}) {
    EXPECT_NEAR(got[0], 0.1, 1e-6);
    EXPECT_NEAR(got[1], 1, 1e-5);
    EXPECT_NEAR(got[2], 10, 1e-3);
    EXPECT_EQ(got[3], kInf) << "the far plane is background";
  }
  try {
    depth({0.5F}, {.depth_kind = DepthKind::device});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(error.hint().find("--near"), std::string::npos);
  }
  context.far_plane = 0.05;
  EXPECT_THROW(depth({0.5F}, {.depth_kind = DepthKind::device}, context), Error);
}

TEST(ConvertDepth, Inverse) {
  EXPECT_EQ(depth({0.5F, 0, 2, kNan, -1}, {.depth_kind = DepthKind::inverse}),
            (std::vector<float>{2, kInf, 0.5F, kInf, kInf}));
}

TEST(ConvertDepth, TheSecondLiesBeyondTheFirstOrNowhere) {
  Plane second = row({3, 2, 1.5F, kInf, 5, kInf, 4});
  drop_not_beyond(second, row({2, 2, 2, 2, kInf, kInf, 3.5F}));
  EXPECT_EQ((std::vector<float>{second.row(0), second.row(0) + 7}),
            (std::vector<float>{3, kInf, kInf, kInf, kInf, kInf, 4}));
}

TEST(ConvertNormals, WorldNormalsTurnIntoTheCameraAndFaceIt) {
  Camera camera = camera_from_fov(90, 1, 0, 0, 2, 1);
  Mat4 view;  // the camera looks along the world X axis backwards
  view = Mat4(0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 5, 1);
  camera.world_to_camera = view;
  auto n = rows({{2, -1, 0.05F, kNan}, {0, 0, 0, 1}, {0, 0, 0, 1}});
  convert_normals(n, {}, camera, {0, 0, 3, 0});
  EXPECT_EQ(n[2](0, 0), -1) << "towards the camera";
  EXPECT_EQ(n[2](1, 0), -1) << "a back face is turned";
  for (const Plane& plane : n) {
    EXPECT_EQ(plane(2, 0), 0) << "too short";
    EXPECT_EQ(plane(3, 0), 0) << "no number";
  }
}

TEST(ConvertNormals, FacingIsByTheRayOfThePixel) {
  const Camera camera = camera_from_fov(120, 1, 0, 0, 2, 1);
  auto n = rows({{0.9F, 0.9F}, {0, 0}, {0.1F, 0.1F}});
  convert_normals(n, {.normal_space = NormalSpace::camera}, camera, {0, 0, 1, 0});
  EXPECT_GT(n[0](0, 0), 0) << "seen from the left half it faces the camera";
  EXPECT_LT(n[0](1, 0), 0) << "on the right half it does not";
  EXPECT_NEAR(n[0](0, 0) * n[0](0, 0) + n[2](0, 0) * n[2](0, 0), 1, 1e-6);
}

TEST(ConvertNormals, EncodedInZeroToOne) {
  auto n = rows({{0.5F}, {0.5F}, {1}});
  convert_normals(n, {.normal_space = NormalSpace::camera, .scale = {2, 2, -2}, .neutral = 0.5}, std::nullopt,
                  {0, 0, 0, 0});
  EXPECT_EQ(n[2](0, 0), -1);
}

/// The definition, pixel by pixel.
Vec3 expected_normal(Vec3 stored, const Encoding& e, const Camera& camera, double x, double y) {
  for (int c = 0; c < 3; ++c) stored[c] = (stored[c] - e.neutral) * e.scale[static_cast<size_t>(c)];
  Vec3 n = transform_direction(stored, *camera.world_to_camera);
  const double length = n.length();
  n = length >= 0.1 && std::isfinite(length) ? n / length : Vec3(0);
  const Vec3 ray = camera.orthographic ? Vec3(0, 0, 1) : camera.unproject(x + 0.5, y + 0.5, 1);
  return n.dot(ray) > 0 ? -n : n;
}

TEST(ConvertNormals, IsItsDefinitionBitForBitOnEverySimdTarget) {
  const Encoding encoding{.scale = {2, 1.5, -2}, .neutral = 0.25};
  const Window window{-7, 11, 29, 15};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> values(-1, 1);
  std::vector<Plane> stored;
  for (int c = 0; c < 3; ++c) stored.emplace_back(37, 5);
  for (Plane& plane : stored)
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 37; ++x)
        plane(x, y) = random() % 40 == 0   ? kNan
                      : random() % 40 == 0 ? kInf
                      : random() % 9 == 0  ? 0.25F
                                           : values(random);
  for (const bool orthographic : {false, true})
    for (const std::string& target : lanes::targets()) {
      lanes::force_target(target);
      Camera camera = camera_from_fov(75, 1, -7, 11, 37, 5);
      camera.world_to_camera = Mat4(0.36, 0.48, -0.8, 0, -0.8, 0.6, 0, 0, 0.48, 0.64, 0.6, 0, 1, 2, 3, 1);
      camera.orthographic = orthographic;
      std::vector<Plane> n;
      for (const Plane& plane : stored) n.push_back(copy_of(plane));
      convert_normals(n, encoding, camera, window);
      for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 37; ++x) {
          const Vec3 expected = expected_normal({stored[0](x, y), stored[1](x, y), stored[2](x, y)}, encoding, camera,
                                                window.min_x + x, window.min_y + y);
          for (int c = 0; c < 3; ++c)
            ASSERT_EQ(std::bit_cast<uint32_t>(n[static_cast<size_t>(c)](x, y)),
                      std::bit_cast<uint32_t>(static_cast<float>(expected[c])))
                << target << " " << x << " " << y;
        }
    }
  lanes::force_target(lanes::targets().front());
}

TEST(ConvertVelocity, SignsUnitsAndUnknowns) {
  auto v = rows({{3, 10000, -20000, kNan, 1, kInf}, {4, 0, 0, 1, kNan, 0}});
  convert_velocity(v, {.scale = {1, -1, 1}, .sentinel_above = 10000}, {0, 0, 99, 49});
  EXPECT_EQ(v[0](0, 0), 3);
  EXPECT_EQ(v[1](0, 0), -4);
  for (int x = 1; x < 6; ++x) EXPECT_TRUE(std::isnan(v[0](x, 0)) && std::isnan(v[1](x, 0))) << x;
  auto screen = rows({{0.75F}, {0.25F}});
  convert_velocity(screen, {.scale = {-2, 2, 1}, .neutral = 0.5, .velocity_unit = VelocityUnit::screen},
                   {0, 0, 99, 49});
  EXPECT_EQ(screen[0](0, 0), -50);
  EXPECT_EQ(screen[1](0, 0), -25);
  auto sentinel = rows({{-1}, {0}});
  convert_velocity(sentinel, {.sentinel_above = 1}, {0, 0, 99, 49});
  EXPECT_TRUE(std::isnan(sentinel[0](0, 0)));
}

TEST(ConvertValues, ProductAndMissing) {
  auto v = rows({{2, kNan}, {3, 1}, {4, 1}, {5, 1}, {6, kInf}, {7, 1}});
  convert_values(v, {.multiply = true}, 0);
  ASSERT_EQ(v.size(), 3U);
  EXPECT_EQ(v[0](0, 0), 10);
  EXPECT_EQ(v[2](0, 0), 28);
  EXPECT_EQ(v[0](1, 0), 0);
  EXPECT_EQ(v[1](1, 0), 0);
}

}  // namespace
}  // namespace aftershade::io
