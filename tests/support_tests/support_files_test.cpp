#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/io/camera_attributes.h"
#include "core/io/exr_reader.h"
#include "core/metrics/image_metrics.h"
#include "tests/support/scene_files.h"
#include "tests/support/scenes.h"

namespace aftershade::tests {
namespace {

constexpr RenderSettings kSize{64, 36, 1};

class SceneFile : public testing::Test {
 protected:
  SceneFile()
      : frame_(render(find_scene("columns"), 3, kSize)),
        path_(testing::TempDir() + "aftershade_scene_" + std::to_string(getpid()) + ".0003.exr") {}
  ~SceneFile() override { std::filesystem::remove(path_); }

  static Plane read(const io::ExrReader& file, const std::string& channel) {
    Plane plane(kSize.width, kSize.height);
    const std::vector<io::ExrReader::Request> requests{{channel, plane}};
    file.read(0, requests, {0, 0, kSize.width - 1, kSize.height - 1});
    return plane;
  }

  Frame frame_;
  std::string path_;
};

TEST_F(SceneFile, HoldsTheFrameInTheGenericConventions) {
  write_scene_file(frame_, path_);
  const io::ExrReader file(path_);
  EXPECT_EQ(file.info().display_window, frame_.display);
  EXPECT_LT(metrics::rmse(read(file, "G"), frame_.layers[0].planes[1]), 1e-3);
  EXPECT_LT(metrics::rmse(read(file, "diffuse_indirect.B"), frame_.planes(Role::ambient)[2]), 1e-3);
  EXPECT_EQ(metrics::rmse(read(file, "forward.u"), frame_.planes(Role::velocity_next)[0]), 0);
  const Plane z = read(file, "Z"), up = read(file, "N.Y"), v = read(file, "backward.v");
  int floor = 0, sky = 0;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const float depth = frame_.depth()(x, y);
      EXPECT_EQ(z(x, y), std::isfinite(depth) ? depth : 1e10F);
      EXPECT_EQ(v(x, y), -frame_.planes(Role::velocity_prev)[1](x, y));
      sky += std::isfinite(depth) ? 0 : 1;
      floor += std::abs(up(x, y) - 1) < 1e-3F ? 1 : 0;
    }
  EXPECT_GT(floor, 100) << "world-space normals: the floor's is +Y";
  EXPECT_GT(sky, 100);
  for (const char* name : {"R", "A", "N.X"})
    EXPECT_EQ(file.info().parts[0].find(name)->type, io::PixelType::half) << name;
  for (const char* name : {"Z", "forward.v"})
    EXPECT_EQ(file.info().parts[0].find(name)->type, io::PixelType::single) << name;
}

TEST_F(SceneFile, HasASecondDepthWhereTheFrameHas) {
  write_scene_file(frame_, path_);
  EXPECT_FALSE(io::ExrReader(path_).info().parts[0].find("depth2.Z"));
  RoleSet roles = kSceneRoles;
  roles.insert(Role::depth2);
  const Frame both = render(find_scene("columns"), 3, kSize, roles);
  write_scene_file(both, path_);
  const Plane stored = read(io::ExrReader(path_), "depth2.Z");
  int behind = 0;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const float second = both.planes(Role::depth2)[0](x, y);
      EXPECT_EQ(stored(x, y), std::isfinite(second) ? second : 1e10F);
      behind += std::isfinite(second) ? 1 : 0;
    }
  EXPECT_GT(behind, 100);
}

TEST_F(SceneFile, MatricesFollowOpenExr) {
  write_scene_file(frame_, path_);
  const io::ExrReader file(path_);
  const Mat4 to_camera = file.matrix(0, "worldToCamera").value(), to_ndc = file.matrix(0, "worldToNDC").value();
  EXPECT_NEAR(determinant3(to_camera), -1, 1e-5) << "+Z forward in a right-handed world";
  const Vec3 point(0.4, 1.1, -2.0);
  const Vec3 seen = frame_.camera->project(transform_point(point, *frame_.camera->world_to_camera));
  const auto column = [&](int c) {
    return point.x * to_ndc[0][c] + point.y * to_ndc[1][c] + point.z * to_ndc[2][c] + to_ndc[3][c];
  };
  EXPECT_NEAR(column(0) / column(3) * kSize.width, seen.x, 1e-3);
  EXPECT_NEAR(column(1) / column(3) * kSize.height, seen.y, 1e-3);
}

TEST_F(SceneFile, CameraIsReadBack) {
  write_scene_file(frame_, path_);
  const auto camera = io::camera_from_header(io::ExrReader(path_), 0, {}, 1);
  ASSERT_TRUE(camera);
  EXPECT_NEAR(camera->fx, frame_.camera->fx, 1e-3);
  EXPECT_NEAR(camera->fy, frame_.camera->fy, 1e-3);
  EXPECT_NEAR(camera->cx, frame_.camera->cx, 1e-3);
  for (int i = 0; i < 16; ++i)
    EXPECT_NEAR((*camera->world_to_camera)[i / 4][i % 4], (*frame_.camera->world_to_camera)[i / 4][i % 4], 1e-5);
}

TEST_F(SceneFile, TruthFilesHoldTheirChannels) {
  const Plane ao(kSize.width, kSize.height, 0.75F);
  write_ao_file(frame_, ao, path_);
  EXPECT_EQ(metrics::rmse(read(io::ExrReader(path_), "AO"), ao), 0);
  write_color_file(frame_, frame_.layers[0].planes, path_);
  EXPECT_LT(metrics::rmse(read(io::ExrReader(path_), "R"), frame_.layers[0].planes[0]), 1e-3);
}

TEST(RenderNoise, HasTheRmsThatIsAskedFor) {
  const RenderSettings settings{160, 90, 1};
  Scene scene = find_scene("corner");
  const Frame clean = render(scene, 2, settings);
  Frame noisy = render(scene, 2, settings), again = render(scene, 2, settings);
  add_render_noise(noisy, 0.02);
  add_render_noise(again, 0.02);
  const auto shown = [](const Plane& plane) {
    Plane out(plane.width(), plane.height());
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) out(x, y) = std::pow(plane(x, y), 1 / 2.2F);
    return out;
  };
  for (size_t c = 0; c < 3; ++c) {
    const Plane before = shown(clean.layers[0].planes[c]), after = shown(noisy.layers[0].planes[c]);
    EXPECT_NEAR(metrics::rmse(after, before), 0.02, 0.001);
    EXPECT_NEAR(metrics::mean_error(after, before), 0, 0.001);
    EXPECT_EQ(metrics::rmse(noisy.layers[0].planes[c], again.layers[0].planes[c]), 0);
  }
  EXPECT_EQ(metrics::rmse(noisy.layers[0].planes[3], clean.layers[0].planes[3]), 0) << "alpha has no noise";
}

}  // namespace
}  // namespace aftershade::tests
