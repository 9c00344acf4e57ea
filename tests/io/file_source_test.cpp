#include "core/io/file_source.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "core/base/error.h"

namespace aftershade::io {
namespace {

namespace fs = std::filesystem;

constexpr float kInf = std::numeric_limits<float>::infinity();

/// One small frame on disk, described by its channels' constant values.
struct Picture {
  Window display{0, 0, 7, 5}, data{0, 0, 7, 5};
  std::vector<std::pair<std::string, float>> channels{{"R", 0.5F}, {"G", 0.25F}, {"B", 0.125F}, {"A", 1}, {"Z", 2}};
  std::vector<std::pair<std::string, Mat4>> matrices{};
};

class FileSourceTest : public ::testing::Test {
 protected:
  FileSourceTest() : folder_(fs::path(::testing::TempDir()) / ("file_source_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~FileSourceTest() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const Picture& picture,
             const std::function<void(const std::string&, Plane&)>& edit = {}) const {
    std::vector<Plane> planes;
    NewFile file{.display_window = picture.display,
                 .data_window = picture.data,
                 .channels = {},
                 .matrices = picture.matrices,
                 .texts = {}};
    for (const auto& [channel, value] : picture.channels) {
      planes.emplace_back(picture.data.width(), picture.data.height(), value);
      if (edit) edit(channel, planes.back());
    }
    for (size_t i = 0; i < planes.size(); ++i)
      file.channels.push_back({picture.channels[i].first, PixelType::single, planes[i]});
    write_new_exr(file, path(name));
  }
  SourceOptions options(const std::string& pattern = "a.####.exr", const char* profile = "generic") const {
    SourceOptions out;
    out.sequence = find_sequence(path(pattern), HashDigits::one).sequence;
    out.profile = load_profile(profile);
    return out;
  }
  static std::string message(const std::function<void()>& work, ErrorCode code) {
    try {
      work();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    return "accepted";
  }
  static void expect_has(const std::string& text, std::initializer_list<const char*> pieces) {
    for (const char* piece : pieces) EXPECT_NE(text.find(piece), std::string::npos) << piece << " in: " << text;
  }
  fs::path folder_;
};

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

TEST_F(FileSourceTest, ASecondDepthIsConvertedAsTheFirst) {
  Picture picture;
  picture.channels.emplace_back("depth2.Z", 3.0F);
  write("a.0001.exr", picture, [](const std::string& channel, Plane& plane) {
    if (channel == "depth2.Z") plane(0, 0) = 1, plane(1, 0) = 1e10F, plane(2, 0) = std::nanf("");
    if (channel == "Z") plane(3, 0) = 1e10F;
  });
  SourceOptions input = options();
  input.metres_per_unit = 0.5;
  const auto second = [&](const SourceOptions& how) {
    Frame frame = *FileSource(how).load(1, "", {Role::depth2}, false);
    EXPECT_TRUE(frame.has(Role::depth)) << "what lies behind is judged by it";
    return std::move(frame.planes(Role::depth2).at(0));
  };
  const Plane planar = second(input);
  for (int x = 0; x < 4; ++x)
    EXPECT_EQ(planar(x, 0), kInf) << "before the first, background, no number, no first: " << x;
  EXPECT_EQ(planar(4, 0), 1.5F);
  input.fov_deg = 90;  // fx = 4
  input.depth_kind = DepthKind::ray;
  EXPECT_NEAR(second(input)(7, 5), 1.5 / std::hypot(1, 3.5 / 4, 2.5 / 4), 1e-6);
  input.depth_kind = DepthKind::inverse;
  EXPECT_EQ(second(input)(0, 0), 0.5F) << "1 is farther than 2 now";
  EXPECT_EQ(second(input)(7, 5), kInf);
  input.depth_kind = DepthKind::device;
  expect_has(message([&] { FileSource other(input); }, ErrorCode::usage), {"depth (", "--near and --far"});
}

TEST_F(FileSourceTest, ASecondDepthMayComeFromAnotherSequence) {
  Picture nuke, behind;
  nuke.channels = {{"depth.Z", 0.5F}};  // inverse
  behind.channels = {{"R", 0.25F}};
  behind.data = {1, 1, 5, 5};
  write("a.0001.exr", nuke);
  write("behind.0001.exr", behind);
  SourceOptions input = options("a.####.exr", "nuke");
  input.siblings.push_back({Role::depth2, find_sequence(path("behind.####.exr"), HashDigits::one).sequence});
  const Frame frame = *FileSource(input).load(1, "", {Role::depth2}, false);
  EXPECT_EQ(frame.depth()(0, 0), 2);
  EXPECT_EQ(frame.planes(Role::depth2)[0](5, 5), 4) << "stored as the first is";
  EXPECT_EQ(frame.planes(Role::depth2)[0](0, 0), kInf) << "outside its window";
}

TEST_F(FileSourceTest, RayDepthThatNobodyAskedForWaitsForALens) {
  Picture ray;
  ray.channels.back().first = "hitdist";
  write("a.0001.exr", ray);
  EXPECT_FALSE(FileSource(options()).available("").contains(Role::depth));
  SourceOptions asked = options();
  asked.depth_kind = DepthKind::ray;
  expect_has(message([&] { FileSource source(asked); }, ErrorCode::data), {"--fov"});
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

TEST_F(FileSourceTest, SiblingSequences) {
  Picture no_depth, depth;
  no_depth.channels.pop_back();
  depth.channels = {{"R", 7}, {"G", 7}, {"B", 7}};
  depth.data = {-1, -1, 8, 6};
  write("a.0001.exr", no_depth);
  write("a.0002.exr", no_depth);
  write("depth.0001.exr", depth);
  SourceOptions with_sibling = options();
  with_sibling.siblings.push_back({Role::depth, find_sequence(path("depth.####.exr"), HashDigits::one).sequence});
  FileSource source(with_sibling);
  ASSERT_EQ(source.roles("").size(), 1U);
  expect_has(source.roles("")[0].why, {"--role depth=", "depth.0001.exr"});
  const Frame frame = *source.load(1, "", {Role::depth}, true);
  EXPECT_EQ(frame.window, depth.data) << "the sibling's window counts too";
  EXPECT_EQ(frame.depth()(9, 7), 7);
  EXPECT_EQ(frame.layers[0].planes[0](0, 0), 0) << "no colour outside its own window";
  expect_has(message([&] { source.load(2, "", {Role::depth}, true); }, ErrorCode::no_input),
             {"--role depth has no frame 2", "it has 1"});
  EXPECT_TRUE(source.load(2, "", {}, true)) << "not asked for, not needed";
  depth.display.max_x = 15;
  write("depth.0001.exr", depth);
  expect_has(message([&] { FileSource other(with_sibling); }, ErrorCode::data), {"--role depth", "displayWindow"});
}

TEST_F(FileSourceTest, LayersAreChosenByName) {
  Picture picture;
  for (const char* name : {"spec.R", "spec.G", "spec.B", "mask"}) picture.channels.emplace_back(name, 3.0F);
  write("a.0001.exr", picture);
  SourceOptions chosen = options();
  chosen.ao_layers = {"spec"};
  chosen.blur_layers = {"beauty", "spec", "mask"};
  const Frame frame = *FileSource(chosen).load(1, "", {}, true);
  ASSERT_EQ(frame.layers.size(), 3U);
  EXPECT_EQ(frame.layers[0].name, "spec");
  EXPECT_TRUE(frame.layers[0].receives_ao && frame.layers[0].receives_blur);
  EXPECT_TRUE(frame.layers[1].is_beauty && !frame.layers[1].receives_ao && frame.layers[1].receives_blur);
  EXPECT_EQ(frame.layers[2].channels, std::vector<std::string>{"mask"});
  chosen.blur_layers = {"beauty", "R"};
  expect_has(message([&] { FileSource other(chosen); }, ErrorCode::usage), {"share channels"});
  chosen.blur_layers = {"spek"};
  expect_has(message([&] { FileSource other(chosen); }, ErrorCode::no_input), {"\"spek\"", "did you mean \"spec\"?"});
  Picture grey;
  grey.channels = {{"Y", 1}};
  write("g.0001.exr", grey);
  expect_has(message([&] { FileSource(options("g.####.exr")).load(1, "", {}, true); }, ErrorCode::no_input),
             {"no colour channels", "the file has Y"});
}

TEST_F(FileSourceTest, NamedChannelsAreCheckedAtOnce) {
  Picture picture;
  picture.channels.emplace_back("shadow", 0.5F);
  write("a.0001.exr", picture, [](const std::string& channel, Plane& plane) {
    if (channel == "shadow") plane(2, 2) = kInf;
  });
  SourceOptions input = options();
  input.named_channels = {"shadow"};
  FileSource source(input);
  NanReport counted;
  source.on_nan = [&](int, const NanReport& report) { counted = report; };
  for (const bool layers : {false, true}) {
    const Frame frame = *source.load(1, "", {}, layers);
    EXPECT_EQ(frame.named.at("shadow")(0, 0), 0.5F);
    EXPECT_EQ(frame.named.at("shadow")(2, 2), kInf) << "as the file has it";
    EXPECT_EQ(counted.infinite, (std::map<std::string, int64_t>{{"shadow", 1}}));
  }
  EXPECT_NO_THROW(source.check_layers_and_named(""));
  input.named_channels = {"shadow", "G"};
  expect_has(message([&] { FileSource(input).check_layers_and_named(""); }, ErrorCode::usage),
             {"channel \"G\"", "layer \"beauty\"", "--ao-layers"});
  input.named_channels = {"shado"};
  expect_has(message([&] { FileSource other(input); }, ErrorCode::no_input), {"\"shado\"", "did you mean \"shadow\"?"});
  picture.channels = {{"R", 1}, {"shadow.V", 1}};
  write("b.0001.exr", picture);
  SourceOptions views = options("b.####.exr");
  views.named_channels = {"R", "R"};
  expect_has(message([&] { FileSource other(views); }, ErrorCode::usage), {"the same channel"});
  const Plane plane(8, 6, 1.0F);
  NewFile ids{.display_window = {0, 0, 7, 5}, .data_window = {0, 0, 7, 5}, .channels = {}, .matrices = {}, .texts = {}};
  ids.channels.push_back({"id", PixelType::uint, plane});
  write_new_exr(ids, path("ids.0001.exr"));
  SourceOptions whole = options("ids.####.exr");
  whole.named_channels = {"id"};
  expect_has(message([&] { FileSource other(whole); }, ErrorCode::data), {"channel id (to be filtered)", "uint"});
}

TEST_F(FileSourceTest, WorldNormalsNeedAPosition) {
  Picture picture;
  for (const char* name : {"N.X", "N.Y", "N.Z"}) picture.channels.emplace_back(name, 1.0F);
  write("a.0001.exr", picture);
  FileSource source(options());
  EXPECT_FALSE(source.available("").contains(Role::normal));
  std::vector<std::string> notes;
  source.on_note = [&](int, const std::string& note) { notes.push_back(note); };
  EXPECT_FALSE(source.load(1, "", {Role::normal}, false)->has(Role::normal));
  source.load(1, "", {Role::normal}, false);
  ASSERT_EQ(notes.size(), 2U) << "once a frame; the log counts";
  EXPECT_EQ(notes[0], notes[1]);
  expect_has(notes[0], {"world space"});
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
