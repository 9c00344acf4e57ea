#include <cmath>

#include "tests/io/small_frames.h"

namespace aftershade::io {
namespace {

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

}  // namespace
}  // namespace aftershade::io
