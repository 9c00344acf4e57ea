#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "core/io/file_source.h"

/// The two public sequences, as a user would name them.
namespace aftershade::io {
namespace {

std::string data(const std::string& name) {
  const char* folder = std::getenv("AFTERSHADE_DATA");
  return std::string(folder ? folder : AFTERSHADE_SOURCE_DIR "/../shared/data") + "/" + name;
}
bool is_there(const std::string& name) { return std::filesystem::is_directory(data(name)); }

SourceOptions input(const std::string& pattern, std::string* why) {
  SourceOptions options;
  options.sequence = find_sequence(data(pattern), HashDigits::one).sequence;
  Detected detected = detect_profile(ExrReader(options.sequence.entries().front().path));
  options.profile = std::move(detected.profile);
  *why = detected.why;
  return options;
}

/// Distances in pixels between where the camera says a foreground pixel was and where its vector says it was.
std::vector<double> disagreements(const Frame& now, const Frame& before) {
  const auto reprojection = CameraReprojection::create(*now.camera, *before.camera);
  const auto& velocity = now.planes(Role::velocity_prev);
  std::vector<double> out;
  for (int y = 0; y < now.window.height(); ++y)
    for (int x = 0; x < now.window.width(); ++x) {
      if (std::isinf(now.depth()(x, y))) continue;
      const double px = now.window.min_x + x + 0.5, py = now.window.min_y + y + 0.5;
      const Vec3 was = (*reprojection)(px, py, now.depth()(x, y));
      out.push_back(std::hypot(was.x - px - velocity[0](x, y), was.y - py - velocity[1](x, y)));
    }
  return out;
}

TEST(Yard, IsRecognised) {
  if (!is_there("yard")) GTEST_SKIP() << "SKIPPED: no sequence in " << data("yard") << " (set AFTERSHADE_DATA)";
  std::string why;
  FileSource source(input("yard/yard.####.exr", &why));
  EXPECT_EQ(why, "attribute BlenderMultiChannel");
  for (const RoleInfo& role : kRoles)
    EXPECT_EQ(source.available("").contains(role.role), role.role != Role::ao && role.role != Role::depth2)
        << role.name;
  const Frame frame = *source.load(4, "", {Role::depth, Role::normal, Role::velocity_next, Role::ambient}, true);
  EXPECT_EQ(frame.window, (Window{0, 0, 479, 269}));
  EXPECT_EQ(frame.layers.at(0).channels.at(0), "ViewLayer.Combined.R");
  EXPECT_FALSE(frame.camera->orthographic);
  EXPECT_NEAR(frame.camera->fx, frame.camera->fy, 1e-2);
  EXPECT_NEAR(frame.camera->cx, 240, 1e-2);
  EXPECT_NEAR(frame.camera->cy, 135, 1e-2);
  EXPECT_EQ(frame.planes(Role::ambient).size(), 3U);
  int turned = 0, normals = 0;
  for (int y = 0; y < 270; ++y)
    for (int x = 0; x < 480; ++x) {
      const auto& n = frame.planes(Role::normal);
      const Vec3 normal(n[0](x, y), n[1](x, y), n[2](x, y));
      if (normal.length() == 0) continue;
      ++normals;
      EXPECT_NEAR(normal.length(), 1, 1e-5);
      turned += normal.dot(frame.camera->unproject(x + 0.5, y + 0.5, 1)) > 1e-6 ? 1 : 0;
    }
  EXPECT_GT(normals, 50000);
  EXPECT_EQ(turned, 0);
}

TEST(Yard, MatricesAgreeWithBlendersVectors) {
  if (!is_there("yard")) GTEST_SKIP() << "SKIPPED: no sequence in " << data("yard") << " (set AFTERSHADE_DATA)";
  std::string why;
  FileSource source(input("yard/yard.####.exr", &why));
  const RoleSet roles{Role::depth, Role::velocity_prev};
  std::vector<double> all;
  for (int f = 2; f <= 12; ++f) {
    std::vector<double> errors =
        disagreements(*source.load(f, "", roles, false), *source.load(f - 1, "", roles, false));
    std::sort(errors.begin(), errors.end());
    const auto near = std::lower_bound(errors.begin(), errors.end(), 0.01) - errors.begin();
    const double share = static_cast<double>(near) / static_cast<double>(errors.size()),
                 median = errors[errors.size() / 2];
    std::cout << "yard, frame " << f << ": median error " << median << " px, " << 100 * share << " % below 0.01 px\n";
    EXPECT_LT(median, 0.001) << "frame " << f;
    EXPECT_GE(share, 0.7) << "frame " << f;
    RecordProperty("frame_" + std::to_string(f), std::to_string(median) + " px, share " + std::to_string(share));
    all.insert(all.end(), errors.begin(), errors.end());
  }
  EXPECT_GT(all.size(), 11U * 50000U);
}

TEST(Beachball, BothViewsOfEveryFrame) {
  if (!is_there("beachball"))
    GTEST_SKIP() << "SKIPPED: no sequence in " << data("beachball") << " (set AFTERSHADE_DATA)";
  std::string why;
  const SourceOptions options = input("beachball/singlepart.0001.exr", &why);
  EXPECT_EQ(why, "no known producer");
  ASSERT_EQ(options.sequence.frames(), (FrameNumbers{1, 2, 3, 4, 5, 6, 7, 8}));
  FileSource source(options);
  EXPECT_EQ(source.views(), (std::vector<std::string>{"right", "left"}));
  std::vector<Window> windows;
  for (const Sequence::Entry& entry : options.sequence.entries())
    for (const std::string& view : source.views()) {
      const Frame frame = *source.load(entry.frame, view, {Role::depth, Role::velocity_next}, true);
      EXPECT_TRUE(frame.has(Role::depth) && frame.has(Role::velocity_next));
      EXPECT_EQ(frame.layers.at(0).channels.at(0), view == "left" ? "left.R" : "R");
      EXPECT_EQ(frame.window, ExrReader(entry.path).info().parts.at(0).data_window);
      windows.push_back(frame.window);
    }
  EXPECT_NE(windows.front(), windows.back());
  EXPECT_GT(windows.back().max_x, 2047) << "leaves the display window";
}

TEST(Beachball, NewChannelsCarryTheViewWhereItIsNotTheDefault) {
  if (!is_there("beachball"))
    GTEST_SKIP() << "SKIPPED: no sequence in " << data("beachball") << " (set AFTERSHADE_DATA)";
  std::string why;
  const SourceOptions options = input("beachball/singlepart.####.exr", &why);
  FileSource source(options);
  std::vector<Frame> views;
  for (const std::string& view : source.views()) {
    views.push_back(*source.load(8, view, {}, true));
    const Window window = views.back().window;
    views.back().layers[0].planes[0](5, 5) = view == "left" ? 2.0F : 3.0F;
    views.back().layers[0].changed = true;
    for (const char* name : {"AO", "aftershade.mask"})
      views.back().added[name] = Plane(window.width(), window.height(), 0.5F);
  }
  const std::string target = ::testing::TempDir() + "beachball_" + std::to_string(::getpid()) + ".exr";
  FileSink sink(options.sequence, {.write = {}, .limits = {}, .path = [&](int) { return target; }, .on_note = {}});
  sink.write(8, views);
  {
    const ExrReader written(target);
    const PartInfo& part = written.info().parts.at(0);
    for (const char* name : {"AO", "left.AO", "aftershade.right.mask", "aftershade.left.mask"})
      EXPECT_TRUE(part.find(name)) << name;
    const Window window = views[0].window;
    Plane right(window.width(), window.height()), left(window.width(), window.height());
    const std::vector<ExrReader::Request> requests{{"R", right}, {"left.R", left}};
    written.read(0, requests, window);
    EXPECT_EQ(right(5, 5), 3);
    EXPECT_EQ(left(5, 5), 2);
  }
  std::filesystem::remove(target);
}

}  // namespace
}  // namespace aftershade::io
