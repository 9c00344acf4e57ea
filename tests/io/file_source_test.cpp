#include <cmath>
#include <fstream>

#include "tests/io/small_frames.h"

namespace aftershade::io {
namespace {

TEST_F(FileSourceTest, LoadsRolesAndTheBeautyOnTheUnionOfWindows) {
  Picture small;
  small.data = {-2, 1, 4, 9};  // also outside the display
  write("a.0001.exr", small);
  write("a.0003.exr", Picture{});
  FileSource source(options());
  EXPECT_EQ(source.views(), std::vector<std::string>{""});
  EXPECT_TRUE(source.available("").contains(Role::depth));
  EXPECT_FALSE(source.available("").contains(Role::normal));
  EXPECT_FALSE(source.load(2, "", {Role::depth}, true));
  const Frame frame = *source.load(1, "", {Role::depth, Role::normal}, true);
  EXPECT_EQ(frame.window, small.data);
  EXPECT_EQ(frame.display, small.display);
  EXPECT_EQ(frame.depth()(6, 8), 2);
  EXPECT_FALSE(frame.has(Role::normal));
  ASSERT_EQ(frame.layers.size(), 1U);
  const Layer& beauty = frame.layers[0];
  EXPECT_TRUE(beauty.is_beauty && beauty.receives_ao && beauty.receives_blur);
  EXPECT_EQ(beauty.alpha, 3);
  EXPECT_EQ(beauty.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(beauty.planes[1](0, 0), 0.25F);
  EXPECT_EQ(source.load(3, "", {}, true)->window, Picture{}.data);
  EXPECT_FALSE(source.load(1, "", {Role::depth}, false)->camera);
}

TEST_F(FileSourceTest, FovGivesACameraWithoutPosition) {
  write("a.0001.exr", Picture{});
  SourceOptions with_fov = options();
  with_fov.fov_deg = 90;
  with_fov.near_plane = 0.5;
  with_fov.metres_per_unit = 0.1;
  const Frame frame = *FileSource(with_fov).load(1, "", {Role::depth}, false);
  ASSERT_TRUE(frame.camera);
  EXPECT_NEAR(frame.camera->fx, 4, 1e-9);
  EXPECT_FALSE(frame.camera->world_to_camera);
  EXPECT_NEAR(*frame.camera->near_m, 0.05, 1e-12);
  EXPECT_NEAR(frame.depth()(0, 0), 0.2F, 1e-7F);
}

TEST_F(FileSourceTest, ChangesWithinASequenceAreRefused) {
  Picture wide, poor;
  wide.display.max_x = 8;
  poor.channels.pop_back();
  write("a.0001.exr", Picture{});
  write("a.0002.exr", wide);
  write("a.0003.exr", poor);
  FileSource source(options());
  expect_has(message([&] { source.load(2, "", {Role::depth}, true); }, ErrorCode::data),
             {"frame 2 (", "a.0002.exr", "displayWindow is (0, 0)-(8, 5)", "(0, 0)-(7, 5)", "a.0001.exr"});
  expect_has(message([&] { source.load(3, "", {Role::depth}, true); }, ErrorCode::data),
             {"frame 3 (", "channel Z (depth) is missing", "a.0001.exr"});
}

TEST_F(FileSourceTest, TheFirstFrameCanBeAnother) {
  Picture wide;
  wide.display.max_x = 8;
  write("a.0002.exr", Picture{});
  write("a.0003.exr", wide);
  write("a.0004.exr", wide);
  std::ofstream(path("a.0001.exr")) << "damaged";
  write("depth.0003.exr", wide);
  std::ofstream(path("depth.0001.exr")) << "damaged";
  EXPECT_THROW(FileSource{options()}, Error);
  SourceOptions later = options();
  later.first_frame = 3;
  later.siblings.push_back({Role::depth, find_sequence(path("depth.####.exr"), HashDigits::one).sequence});
  FileSource source(later);
  EXPECT_EQ(source.info().display_window, wide.display);
  EXPECT_TRUE(source.load(3, "", {Role::depth}, true));
  EXPECT_TRUE(source.load(4, "", {}, true));
  expect_has(message([&] { source.load(2, "", {}, false); }, ErrorCode::data),
             {"frame 2 (", "displayWindow is (0, 0)-(7, 5)", "(0, 0)-(8, 5)", "a.0003.exr"});
  EXPECT_THROW(source.load(1, "", {}, false), Error);
  later.first_frame = 7;
  expect_has(message([&] { FileSource other(later); }, ErrorCode::no_input), {"no frame 7"});
}

TEST_F(FileSourceTest, DepthThatCannotBecomePlanarIsRefusedAtOnce) {
  write("a.0001.exr", Picture{});
  SourceOptions device = options();
  for (const DepthKind kind : {DepthKind::device, DepthKind::device_reversed}) {
    device.depth_kind = kind;
    expect_has(message([&] { FileSource other(device); }, ErrorCode::usage), {"depth (", "Z", "--near and --far"});
  }
  device.near_plane = 0.5;
  EXPECT_THROW(FileSource{device}, Error);
  device.far_plane = 100;
  EXPECT_TRUE(FileSource(device).load(1, "", {Role::depth}, false)->has(Role::depth));
  SourceOptions ray = options();
  ray.depth_kind = DepthKind::ray;
  expect_has(message([&] { FileSource other(ray); }, ErrorCode::data), {"depth (", "Z", "--fov or --camera"});
  ray.fov_deg = 60;
  EXPECT_TRUE(FileSource(ray).load(1, "", {Role::depth}, false)->has(Role::depth));
}

TEST_F(FileSourceTest, DamagedFramesAreNamedTwiceAtMost) {
  write("a.0001.exr", Picture{});
  std::ifstream in(path("a.0001.exr"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  for (size_t i = bytes.find("channels"); i < bytes.size(); ++i) {
    std::string noisy = bytes;
    noisy[i] = static_cast<char>(noisy[i] ^ 0x55);
    fs::remove(path("a.0002.exr"));
    std::ofstream(path("a.0002.exr"), std::ios::binary) << noisy;
    FileSource source(options());
    try {
      source.load(2, "", {Role::depth}, true);
    } catch (const Error& error) {
      const std::string text = error.what();
      size_t names = 0;
      for (size_t at = text.find("a.0002.exr"); at != std::string::npos; at = text.find("a.0002.exr", at + 1)) ++names;
      EXPECT_TRUE(names == 1 || names == 2) << text;
      EXPECT_EQ(text.find("\""), std::string::npos) << text;
    }
  }
}

TEST_F(FileSourceTest, AChannelThatComesOrGoesIsNamed) {
  Picture more;
  more.channels.emplace_back("extra.R", 1.0F);
  write("a.0001.exr", Picture{});
  write("a.0002.exr", more);
  FileSource source(options());
  expect_has(message([&] { source.load(2, "", {Role::depth}, true); }, ErrorCode::data),
             {"frame 2 (", "channels differ", "here only extra.R (float)", "a.0001.exr"});
}

TEST_F(FileSourceTest, WrongTypesAreNamed) {
  const Plane plane(8, 6, 1.0F);
  NewFile ids{.display_window = {0, 0, 7, 5}, .data_window = {0, 0, 7, 5}, .channels = {}, .matrices = {}, .texts = {}};
  for (const char* name : {"R", "G", "B"}) ids.channels.push_back({name, PixelType::uint, plane});
  write_new_exr(ids, path("ids.0001.exr"));
  expect_has(message([&] { FileSource source(options("ids.####.exr")); }, ErrorCode::data),
             {"ids.0001.exr", "channel R (colour)", "uint"});
  NewFile depth = ids;
  for (NewChannel& channel : depth.channels) channel.type = PixelType::half;
  depth.channels.push_back({"Z", PixelType::uint, plane});
  write_new_exr(depth, path("depth.0001.exr"));
  expect_has(message([&] { FileSource source(options("depth.####.exr")); }, ErrorCode::data),
             {"depth.0001.exr", "channel Z (depth)", "uint"});
  NewFile text = ids;
  for (NewChannel& channel : text.channels) channel.type = PixelType::half;
  text.texts = {{"worldToCamera", "1 0 0 0"}};
  write_new_exr(text, path("text.0001.exr"));
  expect_has(message([&] { FileSource(options("text.####.exr")).load(1, "", {}, true); }, ErrorCode::data),
             {"text.0001.exr", "worldToCamera is not a matrix"});
}

TEST_F(FileSourceTest, MissingMatricesAndSingularMatrices) {
  Mat4 view, ndc;
  view[2][2] = -1;
  ndc[0][0] = 1, ndc[1][1] = -1, ndc[2][2] = 1, ndc[2][0] = ndc[2][1] = -0.5, ndc[2][3] = -1, ndc[3][3] = 0;
  Picture with_camera, broken;
  with_camera.matrices = {{"worldToCamera", view}, {"worldToNDC", ndc}};
  Mat4 zero = view;
  zero[0][0] = 0;
  broken.matrices = {{"worldToCamera", zero}, {"worldToNDC", ndc}};
  write("a.0001.exr", with_camera);
  write("a.0002.exr", Picture{});
  write("a.0003.exr", broken);
  FileSource source(options());
  EXPECT_NEAR(source.load(1, "", {}, true)->camera->fx, 8, 1e-6);
  expect_has(message([&] { source.load(2, "", {}, true); }, ErrorCode::data),
             {"frame 2", "camera matrices are missing", "a.0001.exr"});
  expect_has(message([&] { source.load(3, "", {}, true); }, ErrorCode::data), {"frame 3", "worldToCamera", "singular"});
}

TEST_F(FileSourceTest, NumbersThatAreNoneAreCountedOrRefused) {
  write("a.0001.exr", Picture{}, [](const std::string& channel, Plane& plane) {
    if (channel == "R") plane(1, 1) = std::nanf("");
    if (channel == "G") plane(2, 1) = plane(3, 1) = kInf;
    if (channel == "Z") plane(0, 0) = kInf, plane(1, 0) = std::nanf("");
  });
  FileSource source(options());
  int calls = 0;
  source.on_nan = [&](int frame, const NanReport& report) {
    ++calls;
    EXPECT_EQ(frame, 1);
    EXPECT_EQ(report.nan, (std::map<std::string, int64_t>{{"R", 1}, {"Z", 1}}));
    EXPECT_EQ(report.infinite, (std::map<std::string, int64_t>{{"G", 2}})) << "an infinite depth is background";
  };
  const Frame frame = *source.load(1, "", {Role::depth}, true);
  EXPECT_EQ(calls, 1);
  EXPECT_TRUE(std::isnan(frame.layers[0].planes[0](1, 1))) << "colours stay as they are";
  EXPECT_EQ(frame.depth()(1, 0), kInf);
  SourceOptions strict = options();
  strict.nan_is_error = true;
  expect_has(message([&] { FileSource(strict).load(1, "", {}, true); }, ErrorCode::data),
             {"frame 1 (", "a.0001.exr", "1 NaN", "channel R"});
}

TEST_F(FileSourceTest, SinkWritesChangedLayersAndNewChannels) {
  write("a.0001.exr", Picture{});
  const SourceOptions input = options();
  FileSource source(input);
  std::vector<Frame> views;
  views.push_back(*source.load(1, "", {Role::depth}, true));
  views[0].layers[0].planes[0](3, 2) = 9;
  views[0].layers[0].changed = true;
  views[0].added["AO"] = Plane(8, 6, 0.5F);
  FileSink sink(input.sequence, {.write = {},
                                 .limits = {},
                                 .path = [&](int n) { return path("out." + std::to_string(n) + ".exr"); },
                                 .on_note = {}});
  sink.write(1, views);
  Plane red(8, 6), ao(8, 6), z(8, 6);
  const ExrReader written(path("out.1.exr"));
  const std::vector<ExrReader::Request> requests{{"R", red}, {"AO", ao}, {"Z", z}};
  written.read(0, requests, {0, 0, 7, 5});
  EXPECT_EQ(red(3, 2), 9);
  EXPECT_EQ(red(0, 0), 0.5F);
  EXPECT_EQ(ao(7, 5), 0.5F);
  EXPECT_EQ(z(0, 0), 2);
  expect_has(message([&] { sink.write(7, views); }, ErrorCode::internal), {"frame 7"});
}

TEST_F(FileSourceTest, UnknownViewIsNamed) {
  write("a.0001.exr", Picture{});
  FileSource source(options());
  expect_has(message([&] { source.load(1, "left", {}, true); }, ErrorCode::usage), {"\"left\""});
}

}  // namespace
}  // namespace aftershade::io
