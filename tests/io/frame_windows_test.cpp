#include <ImfHeader.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/error.h"
#include "core/io/file_source.h"
#include "tests/io/exr_files.h"

namespace aftershade::io {
namespace {
using tests::Packed;
using tests::PartSpec;
using tests::TempFolder;

constexpr Window kColor{-5, 3, 44, 40}, kDepth{4, -2, 60, 30}, kMask{50, 35, 69, 47};
constexpr Window kAll{-5, -2, 69, 47};

std::vector<PartSpec> color_depth_mask() {
  const auto half = Imf::HALF;
  return {{"mask", kMask, {{"AO", Imf::FLOAT}, {"m", half}}, Imf::PIZ_COMPRESSION},
          {"rgba", kColor, {{"R", half}, {"G", half}, {"B", half}, {"A", half}}, Imf::ZIP_COMPRESSION},
          {"depth", kDepth, {{"Z", Imf::FLOAT}}, Imf::PIZ_COMPRESSION, true}};
}

Plane read_plane(const ExrReader& file, int part, const std::string& channel, Window window) {
  Plane plane(window.width(), window.height(), -1.0F);
  const ExrReader::Request request{channel, plane};
  file.read(part, {&request, 1}, window);
  return plane;
}

bool same_bits(const Plane& a, const Plane& b) {
  if (a.width() != b.width() || a.height() != b.height()) return false;
  for (int y = 0; y < a.height(); ++y)
    if (std::memcmp(a.row(y), b.row(y), sizeof(float) * static_cast<size_t>(a.width())) != 0) return false;
  return true;
}

class FrameWindows : public testing::Test {
 protected:
  void make(const std::vector<PartSpec>& parts) { tests::make_exr(folder / "a.0001.exr", parts); }
  SourceOptions options() const {
    SourceOptions out;
    out.sequence = find_sequence(folder / "a.####.exr", HashDigits::one).sequence;
    out.profile = load_profile("generic");
    return out;
  }
  Frame load(const SourceOptions& input, bool with_layers = true) const {
    return *FileSource(input).load(1, "", {Role::depth}, with_layers);
  }
  /// Writes the frames over a copy of frame 1.
  void write(const std::vector<Frame>& frames, const WriteOptions& how = {}, const ReadLimits& limits = {}) const {
    const SourceOptions input = options();
    FileSink(input.sequence,
             {.write = how, .limits = limits, .path = [&](int) { return folder / "out.exr"; }, .on_note = {}})
        .write(1, frames);
  }
  std::vector<Frame> one(Frame frame) const {
    std::vector<Frame> out;
    out.push_back(std::move(frame));
    return out;
  }
  static void fill(Frame& frame, float value) {
    for (Layer& layer : frame.layers)
      for (Plane& plane : layer.planes) plane = Plane(frame.window.width(), frame.window.height(), value);
  }
  TempFolder folder;
};

TEST_F(FrameWindows, DoNotDependOnWhatIsLoaded) {
  make(color_depth_mask());
  SourceOptions input = options();
  input.blur_layers = {"beauty", "mask.m"};
  FileSource source(input);
  const Frame full = *source.load(1, "", {Role::depth}, true), bare = *source.load(1, "", {Role::depth}, false);
  EXPECT_EQ(full.window, kAll);
  EXPECT_EQ(bare.window, kAll);
  EXPECT_TRUE(same_bits(full.depth(), bare.depth()));
  EXPECT_EQ(source.load(1, "", {}, true)->window, kAll);
  EXPECT_EQ(source.load(1, "", {}, false)->window, kAll);
}

TEST_F(FrameWindows, LayersAndFramesKnowTheirParts) {
  make(color_depth_mask());
  SourceOptions input = options();
  input.ao_layers = input.blur_layers = {"mask.m"};
  const Frame full = load(input), bare = load(input, false);
  ASSERT_EQ(full.layers.size(), 1U);
  EXPECT_EQ(full.layers[0].part, 0);
  EXPECT_EQ(full.layers[0].data_window, kMask);
  EXPECT_FALSE(full.layers[0].changed);
  EXPECT_EQ(full.part, 1) << "the beauty's, though another layer was chosen";
  EXPECT_EQ(bare.part, 1);
  make({color_depth_mask()[0], color_depth_mask()[2]});
  EXPECT_EQ(load(options(), false).part, 0) << "no beauty";
}

TEST_F(FrameWindows, SiblingsCountWhereTheyHaveTheFrame) {
  const auto parts = color_depth_mask();
  PartSpec z = parts[2];
  z.name.clear();
  make({parts[1]});
  tests::make_exr(folder / "a.0002.exr", {parts[1]});
  tests::make_exr(folder / "z.0001.exr", {z});
  SourceOptions input = options();
  input.siblings.push_back({Role::depth, find_sequence(folder / "z.####.exr", HashDigits::one).sequence});
  FileSource source(input);
  EXPECT_EQ(source.load(1, "", {}, true)->window, united(kColor, kDepth));
  EXPECT_EQ(source.load(1, "", {Role::depth}, false)->window, united(kColor, kDepth));
  EXPECT_EQ(source.load(2, "", {}, true)->window, kColor);
}

TEST_F(FrameWindows, TheUnionIsLimited) {
  auto parts = color_depth_mask();
  parts[2].window = {900000000, 900000000, 900000009, 900000009};
  make(parts);
  try {
    load(options());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::data);
    EXPECT_NE(error.message().find("union of all data windows is 900000015x900000007"), std::string::npos)
        << error.what();
  }
}

TEST_F(FrameWindows, TheSinkWritesChangedLayersWithinTheirPart) {
  make(color_depth_mask());
  Frame frame = load(options());
  fill(frame, 2);
  write(one(std::move(frame)));
  EXPECT_EQ(tests::decode_all(folder / "a.0001.exr"), tests::decode_all(folder / "out.exr")) << "nothing has changed";
  for (const auto policy : {DataWindowPolicy::keep, DataWindowPolicy::grow}) {
    frame = load(options());
    fill(frame, 2);
    frame.layers[0].changed = true;
    write(one(std::move(frame)), {.compression = {}, .data_window = policy});
    const ExrReader file(folder / "out.exr");
    EXPECT_EQ(file.info().parts[1].data_window, kColor) << "the depth's window is none of the colour's business";
    const Plane red = read_plane(file, 1, "R", kColor);
    EXPECT_EQ(red(0, 0), 2);
    EXPECT_EQ(red(49, 37), 2);
    const auto before = tests::take_apart(folder / "a.0001.exr"), after = tests::take_apart(folder / "out.exr");
    EXPECT_EQ(before.chunks[0], after.chunks[0]);
    EXPECT_EQ(before.chunks[2], after.chunks[2]);
  }
}

TEST_F(FrameWindows, ALayerThatGrewMakesItsPartGrow) {
  make(color_depth_mask());
  const Window grown{-5, -2, 50, 45};
  for (const auto policy : {DataWindowPolicy::keep, DataWindowPolicy::grow}) {
    Frame frame = load(options());
    frame.window = {-8, -2, 60, 47};  // smaller and larger than what was loaded
    fill(frame, 2);
    frame.layers[0].changed = true;
    frame.layers[0].data_window = grown;
    frame.added["mask"] = Plane(frame.window.width(), frame.window.height(), 0.5F);
    write(one(std::move(frame)), {.compression = {}, .data_window = policy});
    const Window expected = policy == DataWindowPolicy::grow ? grown : kColor;
    const ExrReader file(folder / "out.exr");
    EXPECT_EQ(file.info().parts[1].data_window, expected);
    EXPECT_EQ(file.info().parts[0].data_window, kMask);
    for (const char* channel : {"R", "mask"}) {
      const Plane plane = read_plane(file, 1, channel, expected);
      EXPECT_EQ(plane(0, 0), channel[0] == 'R' ? 2 : 0.5F);
      EXPECT_EQ(plane(plane.width() - 1, plane.height() - 1), channel[0] == 'R' ? 2 : 0.5F);
    }
  }
}

TEST_F(FrameWindows, AddedChannelsCoverTheirPartAndOverwrite) {
  auto parts = color_depth_mask();
  parts[1].channels["AO"] = Imf::FLOAT;
  make(parts);
  const auto with_added = [&] {
    Frame frame = load(options(), false);
    for (const char* name : {"AO", "aftershade.N"})
      frame.added[name] = Plane(frame.window.width(), frame.window.height(), 0.3F);
    return one(std::move(frame));
  };
  write(with_added(), {.compression = {}, .data_window = DataWindowPolicy::grow});
  const ExrReader file(folder / "out.exr");
  EXPECT_EQ(file.info().parts[1].data_window, kColor);
  EXPECT_EQ(file.info().parts[1].find("AO")->type, PixelType::single) << "as it was";
  EXPECT_EQ(file.info().parts[1].find("aftershade.N")->type, PixelType::half);
  EXPECT_EQ(read_plane(file, 1, "AO", kColor)(49, 37), 0.3F);
  EXPECT_EQ(read_plane(file, 1, "aftershade.N", kColor)(0, 0), static_cast<float>(half(0.3F)));
  EXPECT_EQ(tests::decode_all(folder / "a.0001.exr")[0], tests::decode_all(folder / "out.exr")[0]);
  write(with_added(), {.compression = {}, .data_window = {}, .only_new_channels = true});
  const ExrReader alone(folder / "out.exr");
  ASSERT_EQ(alone.info().parts.size(), 1U);
  EXPECT_EQ(alone.info().parts[0].channels.size(), 2U);
  EXPECT_EQ(alone.info().parts[0].data_window, kColor);
  EXPECT_EQ(read_plane(alone, 0, "AO", kColor)(0, 0), static_cast<float>(half(0.3F)));
}

TEST_F(FrameWindows, NamedChannelsStayInTheirPart) {
  make(color_depth_mask());
  SourceOptions input = options();
  input.named_channels = {"mask.m", "AO"};
  FileSource source(input);
  const Frame loaded = *source.load(1, "", {}, false);
  EXPECT_EQ(loaded.window, kAll) << "their part counts";
  ASSERT_EQ(loaded.named.size(), 2U);
  EXPECT_TRUE(std::isnan(loaded.named.at("AO")(0, 0))) << "nothing in the file";
  const auto changed = [&](float value) {
    Frame frame = *source.load(1, "", {}, false);
    for (const char* name : {"mask.m", "AO", "new"})
      frame.added[name] = Plane(frame.window.width(), frame.window.height(), value);
    return one(std::move(frame));
  };
  for (const auto policy : {DataWindowPolicy::keep, DataWindowPolicy::grow}) {
    write(changed(0.3F), {.compression = {}, .data_window = policy});
    const ExrReader file(folder / "out.exr");
    EXPECT_EQ(file.info().parts[0].data_window, kMask);
    ASSERT_EQ(file.info().parts[0].channels.size(), 2U) << "nothing was added there";
    EXPECT_EQ(file.info().parts[0].find("m")->type, PixelType::half) << "as it was";
    EXPECT_EQ(file.info().parts[0].find("AO")->type, PixelType::single);
    EXPECT_EQ(read_plane(file, 0, "m", kMask)(19, 12), static_cast<float>(half(0.3F)));
    EXPECT_EQ(read_plane(file, 0, "AO", kMask)(0, 0), 0.3F);
    EXPECT_TRUE(file.info().parts[1].find("new"));
    EXPECT_FALSE(file.info().parts[1].find("AO"));
    EXPECT_EQ(tests::decode_all(folder / "a.0001.exr")[2], tests::decode_all(folder / "out.exr")[2]);
  }
  write(changed(0.3F), {.compression = {}, .data_window = {}, .only_new_channels = true});
  const ExrReader alone(folder / "out.exr");
  ASSERT_EQ(alone.info().parts[0].channels.size(), 1U) << "they are not new";
  EXPECT_EQ(alone.info().parts[0].channels[0].name, "new");
}

TEST_F(FrameWindows, UnchangedPixelsOfANamedChannelKeepTheirBits) {
  make(color_depth_mask());
  SourceOptions input = options();
  input.named_channels = {"m", "Z"};
  Frame frame = *FileSource(input).load(1, "", {}, false);
  for (const auto& [name, plane] : frame.named) frame.added[name] = copy_of(plane);
  write(one(std::move(frame)));
  EXPECT_EQ(tests::decode_all(folder / "a.0001.exr"), tests::decode_all(folder / "out.exr"));
}

TEST_F(FrameWindows, AChannelOfSeveralViewsIsWrittenOnce) {
  auto parts = color_depth_mask();
  parts[0].more = [](Imf::Header& header) { header.setView("left"); };
  parts[2].more = [](Imf::Header& header) { header.setView("right"); };
  make(parts);
  SourceOptions input = options();
  input.named_channels = {"A"};
  std::vector<Frame> frames;
  FileSource source(input);
  for (const auto& [view, value] : {std::pair{"left", 0.25F}, {"right", 0.75F}}) {
    frames.push_back(*source.load(1, view, {}, false));
    frames.back().added["A"] = Plane(frames.back().window.width(), frames.back().window.height(), value);
  }
  write(frames);
  EXPECT_EQ(read_plane(ExrReader(folder / "out.exr"), 1, "A", kColor)(0, 0), 0.25F) << "the first view's";
}

TEST_F(FrameWindows, ViewsThatShareAPartHaveTheirOwnAddedChannels) {
  auto parts = color_depth_mask();
  parts[0].more = [](Imf::Header& header) { header.setView("left"); };
  parts[2].more = [](Imf::Header& header) { header.setView("right"); };
  make(parts);
  std::vector<Frame> frames;
  FileSource source(options());
  for (const char* view : {"left", "right"}) {
    frames.push_back(*source.load(1, view, {}, true));
    EXPECT_EQ(frames.back().part, 1);
    frames.back().added["AO"] = Plane(frames.back().window.width(), frames.back().window.height(), 0.5F);
  }
  write(frames);
  const ExrReader file(folder / "out.exr");
  EXPECT_TRUE(file.info().parts[1].find("AO"));
  EXPECT_TRUE(file.info().parts[1].find("right.AO"));
  tests::decode_all(folder / "out.exr");
}

TEST_F(FrameWindows, TheSinkHasTheSourcesLimits) {
  make(color_depth_mask());
  ReadLimits narrow;
  narrow.max_width = 49;
  EXPECT_THROW(write(one(load(options())), {}, narrow), Error);
  Frame frame = load(options());
  frame.window = {-5, 3, 80, 40};
  fill(frame, 2);
  frame.layers[0].changed = true;
  frame.layers[0].data_window = frame.window;
  narrow.max_width = 64;
  const WriteOptions grow{.compression = {}, .data_window = DataWindowPolicy::grow};
  try {
    write(one(std::move(frame)), grow, narrow);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(error.message().find("new dataWindow of part rgba"), std::string::npos) << error.what();
    EXPECT_NE(error.message().find("86x38"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace aftershade::io
