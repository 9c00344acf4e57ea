#include "core/io/exr_writer.h"

#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfPreviewImageAttribute.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/error.h"
#include "tests/io/exr_files.h"

namespace aftershade::io {
namespace {
using tests::Attribute;
using tests::FileParts;
using tests::Packed;
using tests::PartSpec;
using tests::TempFolder;

const Window kWindow{-5, 3, 44, 40};
const WriteOptions kGrow{std::nullopt, DataWindowPolicy::grow, false}, kOnlyNew{std::nullopt, {}, true};
constexpr const char* kLongChannel = "a layer with a very long name indeed.Red";
constexpr const char* kLongAttribute = "an attribute with a name of more than 31 characters";

PartSpec mixed(const std::string& name, Imf::Compression compression, bool tiled) {
  return {name, kWindow, {{"h", Imf::HALF}, {"f", Imf::FLOAT}, {"u", Imf::UINT}}, compression, tiled};
}

Plane read_plane(const ExrReader& file, int part, const std::string& channel, Window window) {
  Plane plane(window.width(), window.height());
  const ExrReader::Request request{channel, plane};
  file.read(part, {&request, 1}, window);
  return plane;
}

/// The attributes that differ: "-name" is gone, "+name" is new, "!name" has another type or value.
std::vector<std::string> differences(const std::vector<Attribute>& before, const std::vector<Attribute>& after) {
  std::vector<std::string> out;
  for (const Attribute& a : before) {
    const auto same = std::ranges::find(after, a.name, &Attribute::name);
    if (same == after.end()) {
      out.push_back("-" + a.name);
    } else if (*same != a) {
      out.push_back("!" + a.name);
    }
  }
  for (const Attribute& a : after)
    if (std::ranges::count(before, a.name, &Attribute::name) == 0) out.push_back("+" + a.name);
  std::ranges::sort(out);
  return out;
}
using Names = std::vector<std::string>;

size_t index_of(Window window, int x, int y) {
  return static_cast<size_t>(y - window.min_y) * static_cast<size_t>(window.width()) +
         static_cast<size_t>(x - window.min_x);
}
template <class Bits>
Bits bits_at(const std::vector<char>& pixels, Window window, int x, int y) {
  Bits bits;
  std::memcpy(&bits, pixels.data() + index_of(window, x, y) * sizeof bits, sizeof bits);
  return bits;
}

class ExrWriter : public testing::Test {
 protected:
  TempFolder folder;
  const std::string in = folder / "in.exr", out = folder / "out.exr";
  Names write(const std::vector<ChannelWrite>& writes, const WriteOptions& options = {}) {
    return write_exr(ExrReader(in), writes, out, options);
  }
};

TEST_F(ExrWriter, CopiesUnchangedFilesByteForByte) {
  for (int compression = 0; compression < 10; ++compression)
    for (const bool tiled : {false, true})
      for (const bool multi_part : {false, true}) {
        PartSpec a = mixed(multi_part ? "a" : "", static_cast<Imf::Compression>(compression), tiled);
        PartSpec b = mixed("b", Imf::ZIPS_COMPRESSION, !tiled);
        b.window = {7, -20, 30, 5};
        tests::make_exr(in, multi_part ? std::vector{a, b} : std::vector{a});
        EXPECT_EQ(write({}), Names{});
        const FileParts before = tests::take_apart(in), after = tests::take_apart(out);
        EXPECT_EQ(before.version, after.version);
        EXPECT_EQ(before.headers, after.headers);
        EXPECT_EQ(before.chunks, after.chunks);
        EXPECT_EQ(tests::decode_all(in), tests::decode_all(out));
      }
}

// One channel is changed in a window: all other pixels keep their bits, in all types, and in the lossy methods too.
TEST_F(ExrWriter, ChangesNothingButTheWrites) {
  const Window written{0, 10, 12, 20};
  const Plane value(written.width(), written.height(), 0.25F);
  for (int compression = 0; compression < 10; ++compression)
    for (const bool tiled : {false, true}) {
      tests::make_exr(in, {mixed("", static_cast<Imf::Compression>(compression), tiled)});
      const Names notes = write({{0, "h", value, written}});
      const bool lossy = compression >= Imf::B44_COMPRESSION;
      ASSERT_EQ(notes.size(), lossy ? 1U : 0U);
      Packed expected = tests::decode_all(in)[0];
      for (int y = written.min_y; y <= written.max_y; ++y)
        for (int x = written.min_x; x <= written.max_x; ++x) {
          const uint16_t bits = half(0.25F).bits();
          std::memcpy(expected["h"].data() + 2 * index_of(kWindow, x, y), &bits, 2);
        }
      EXPECT_EQ(tests::decode_all(out)[0], expected) << compression << tiled;
      EXPECT_EQ(differences(tests::take_apart(in).headers[0], tests::take_apart(out).headers[0]),
                lossy ? Names{"!compression"} : Names{});
      EXPECT_EQ(ExrReader(out).info().parts[0].compression, lossy ? "zip" : ExrReader(in).info().parts[0].compression);
    }
}

// Floats that come back as they were decoded: NaN payloads, denormals and uints beyond a float's 24 bits survive.
TEST_F(ExrWriter, KeepsTheBitsOfValuesThatDidNotChange) {
  tests::make_exr(in, {mixed("", Imf::ZIP_COMPRESSION, false)});
  const ExrReader file(in);
  std::vector<Plane> planes;
  std::vector<ChannelWrite> writes;
  for (const char* channel : {"h", "f", "u"}) planes.push_back(read_plane(file, 0, channel, kWindow));
  for (size_t i = 0; i < 3; ++i) writes.push_back({0, std::string(1, "hfu"[i]), planes[i], kWindow});
  write(writes);
  EXPECT_EQ(tests::decode_all(in), tests::decode_all(out));
}

TEST_F(ExrWriter, ConvertsToHalfAndUint) {
  tests::make_exr(in, {mixed("", Imf::ZIP_COMPRESSION, false)});
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::nanf("");
  const float values[] = {1e9F, -1e9F, infinity, -infinity, nan, 65519.0F, 1.7F, -3.0F, 5e9F};
  Plane plane(9, 1);
  std::copy(std::begin(values), std::end(values), plane.row(0));
  const Window window{0, 3, 8, 3};
  write({{0, "h", plane, window}, {0, "u", plane, window}, {0, "f", plane, window}});
  const Packed pixels = tests::decode_all(out)[0];
  const float halves[] = {65504, -65504, infinity, -infinity, nan, 65504, half(1.7F), -3, 65504};
  const uint32_t uints[] = {1000000000, 0, 4294967295, 0, 0, 65519, 2, 0, 4294967295};
  for (int x = 0; x < 9; ++x) {
    const half h(half::FromBits, bits_at<uint16_t>(pixels.at("h"), kWindow, x, 3));
    EXPECT_TRUE(std::isnan(halves[x]) ? h.isNan() : h == halves[x]) << x;
    EXPECT_EQ(bits_at<uint32_t>(pixels.at("u"), kWindow, x, 3), uints[x]) << x;
    EXPECT_EQ(bits_at<uint32_t>(pixels.at("f"), kWindow, x, 3), std::bit_cast<uint32_t>(values[x])) << x;
  }
}

std::vector<PartSpec> three_parts() {
  PartSpec a = mixed("a", Imf::PIZ_COMPRESSION, false), b = mixed("beauty", Imf::DWAA_COMPRESSION, false),
           c = mixed("c", Imf::ZIP_COMPRESSION, true);
  b.window = {-30, 0, 80, 60};
  c.window = {100, 100, 117, 131};
  b.more = [](Imf::Header& header) { header.setView("left"); };
  return {a, b, c};
}

TEST_F(ExrWriter, EncodesOnlyTheChangedPartOfSeveral) {
  tests::make_exr(in, three_parts());
  const Window window = three_parts()[1].window;
  const Plane value(window.width(), window.height(), 2.0F);
  const Names notes = write({{1, "h", value, window}, {1, kLongChannel, value, window, true}});
  EXPECT_EQ(notes, Names{"part beauty: compression dwaa is lossy, written as zip"});
  const FileParts before = tests::take_apart(in), after = tests::take_apart(out);
  EXPECT_EQ(before.version | 0x400, after.version);
  for (const size_t same : {0U, 2U}) {
    EXPECT_EQ(before.headers[same], after.headers[same]);
    EXPECT_EQ(before.chunks[same], after.chunks[same]);
  }
  EXPECT_EQ(differences(before.headers[1], after.headers[1]), (Names{"!channels", "!chunkCount", "!compression"}));
  std::vector<Packed> expected = tests::decode_all(in), got = tests::decode_all(out);
  EXPECT_EQ(got[1].at(kLongChannel), got[1].at("h"));
  EXPECT_EQ(bits_at<uint16_t>(got[1].at("h"), window, 80, 60), half(2.0F).bits());
  EXPECT_EQ(got[1].at("f"), expected[1].at("f"));
  EXPECT_EQ(got[1].at("u"), expected[1].at("u"));
  EXPECT_EQ(ExrReader(out).info().parts[1].find(kLongChannel)->type, PixelType::half);
}

/// Of a type that nobody else knows, with a name of more than 31 characters.
class UnknownAttribute final : public Imf::Attribute {
 public:
  const char* typeName() const override { return "a type that nobody else knows, with a long name"; }
  Attribute* copy() const override { return new UnknownAttribute; }
  void writeValueTo(Imf::OStream& stream, int) const override { stream.write("\0\1\2 odd \xff", 9); }
  void readValueFrom(Imf::IStream&, int, int) override {}
  void copyValueFrom(const Attribute&) override {}
};

TEST_F(ExrWriter, KeepsEveryAttributeExactly) {
  for (const bool tiled : {false, true}) {
    PartSpec spec = mixed("", Imf::ZIPS_COMPRESSION, tiled);
    spec.channels[kLongChannel] = Imf::HALF;
    spec.line_order = Imf::DECREASING_Y;
    spec.more = [](Imf::Header& header) {
      header.insert(kLongAttribute, Imf::StringAttribute("value"));
      header.insert("zero", Imf::StringAttribute(""));
      header.insert("nan", Imf::FloatAttribute(std::nanf("7")));
      header.insert("odd", UnknownAttribute());
      header.pixelAspectRatio() = 1.5;
      header.screenWindowWidth() = 3;
    };
    tests::make_exr(in, {spec});
    const Plane value(3, 3, 1.0F);
    write({{0, "h", value, {0, 10, 2, 12}}});
    const FileParts before = tests::take_apart(in), after = tests::take_apart(out);
    EXPECT_EQ(before.headers, after.headers);
    EXPECT_EQ(before.version, after.version);
    EXPECT_GE(before.headers[0].size(), 12U);
    EXPECT_EQ(tests::decode_all(out)[0].at("u"), tests::decode_all(in)[0].at("u"));
  }
}

TEST_F(ExrWriter, DropsStaleAttributesAndNamesThem) {
  PartSpec spec = mixed("", Imf::ZIP_COMPRESSION, false);
  spec.more = [](Imf::Header& header) {
    header.setPreviewImage(Imf::PreviewImage(4, 4));
    header.insert("acesImageContainerFlag", Imf::IntAttribute(1));
  };
  tests::make_exr(in, {spec});
  const Plane value(3, 3, 1.0F);
  const Names notes = write({{0, "h", value, {0, 10, 2, 12}}});
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_NE(notes[0].find("preview"), std::string::npos);
  EXPECT_NE(notes[1].find("acesImageContainerFlag"), std::string::npos);
  EXPECT_EQ(differences(tests::take_apart(in).headers[0], tests::take_apart(out).headers[0]),
            (Names{"-acesImageContainerFlag", "-preview"}));
  EXPECT_EQ(write({}), Names{});
  EXPECT_EQ(tests::take_apart(in).headers, tests::take_apart(out).headers);
}

TEST_F(ExrWriter, ObeysTheCompressionOption) {
  tests::make_exr(in, {mixed("", Imf::B44_COMPRESSION, false)});
  const Plane value(3, 3, 1.0F);
  const std::vector<ChannelWrite> writes{{0, "h", value, {0, 10, 2, 12}}};
  for (const std::string name : {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"}) {
    const Names notes = write(writes, {name});
    const bool lossless = name == "none" || name == "rle" || name == "zips" || name == "zip" || name == "piz";
    ASSERT_EQ(notes.size(), lossless ? 0U : 1U) << name;
    EXPECT_TRUE(lossless || notes[0].find(name + " loses precision") != std::string::npos) << name;
    EXPECT_EQ(ExrReader(out).info().parts[0].compression, name);
    EXPECT_EQ(tests::decode_all(out)[0].at("u"), tests::decode_all(in)[0].at("u"));
  }
  EXPECT_EQ(write(writes, {"keep"}).size(), 1U) << "b44 loses precision";
  EXPECT_EQ(ExrReader(out).info().parts[0].compression, "b44");
  try {
    write(writes, {"jpeg"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(error.hint().find("b44a"), std::string::npos) << error.what();
  }
}

TEST(CheckCompression, KnowsTheNames) {
  for (const char* name : {"keep", "none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"})
    EXPECT_NO_THROW(check_compression(name));
  for (const char* name : {"", "ZIP ", "jpeg"}) EXPECT_THROW(check_compression(name), Error);
}

TEST_F(ExrWriter, GrowsTheDataWindowOfChangedPartsOnly) {
  for (const bool tiled : {false, true}) {
    PartSpec a = mixed("a", Imf::ZIP_COMPRESSION, tiled), b = mixed("b", Imf::ZIP_COMPRESSION, tiled);
    a.channels["depth.Z"] = Imf::FLOAT;
    tests::make_exr(in, {a, b});
    const Window grown{-12, 0, 44, 50}, written{-12, 0, 20, 50};
    const Plane value(written.width(), written.height(), 0.5F);
    write({{0, "h", value, written}}, kGrow);
    const FileParts before = tests::take_apart(in), after = tests::take_apart(out);
    EXPECT_EQ(differences(before.headers[0], after.headers[0]), (Names{"!chunkCount", "!dataWindow"}));
    EXPECT_EQ(before.headers[1], after.headers[1]);
    EXPECT_EQ(before.chunks[1], after.chunks[1]);
    EXPECT_EQ(ExrReader(out).info().parts[0].data_window, grown);
    const Packed was = tests::decode_all(in)[0], now = tests::decode_all(out)[0];
    int wrong = 0;
    for (int y = grown.min_y; y <= grown.max_y; ++y)
      for (int x = grown.min_x; x <= grown.max_x; ++x) {
        const bool inside = kWindow.contains(x, y);
        const uint32_t u = inside ? bits_at<uint32_t>(was.at("u"), kWindow, x, y) : 0;
        const uint32_t z = inside ? bits_at<uint32_t>(was.at("depth.Z"), kWindow, x, y) : 0x7f800000;
        uint16_t h = inside ? bits_at<uint16_t>(was.at("h"), kWindow, x, y) : uint16_t{0};
        if (written.contains(x, y)) h = half(0.5F).bits();
        wrong += bits_at<uint32_t>(now.at("u"), grown, x, y) != u;
        wrong += bits_at<uint32_t>(now.at("depth.Z"), grown, x, y) != z;
        wrong += bits_at<uint16_t>(now.at("h"), grown, x, y) != h;
      }
    EXPECT_EQ(wrong, 0);
    write({{0, "h", value, written}});
    EXPECT_EQ(ExrReader(out).info().parts[0].data_window, kWindow);
  }
}

TEST_F(ExrWriter, WritesNewChannelsAlone) {
  tests::make_exr(in, three_parts());
  const Window window = three_parts()[1].window;
  const Plane ao(window.width(), window.height(), 0.75F);
  write({{1, "h", ao, window}, {1, "AO", ao, window, true}}, kOnlyNew);
  const ExrReader file(out);
  ASSERT_EQ(file.info().parts.size(), 1U);
  ASSERT_EQ(file.info().parts[0].channels.size(), 1U);
  EXPECT_EQ(file.info().parts[0].channels[0].name, "AO");
  EXPECT_EQ(file.info().parts[0].data_window, window);
  EXPECT_EQ(read_plane(file, 0, "AO", window)(70, 50), 0.75F);
  EXPECT_EQ(tests::take_apart(out).version, 2U);
  EXPECT_EQ(differences(tests::take_apart(in).headers[1], tests::take_apart(out).headers[0]),
            (Names{"!channels", "!compression", "-chunkCount", "-name", "-type", "-view"}));
  tests::decode_all(out);
}

TEST_F(ExrWriter, PutsTheViewBeforeNewChannelsOfTheSameName) {
  std::vector<PartSpec> parts = three_parts();
  tests::make_exr(in, parts);
  const Plane first(50, 38, 0.25F), second(111, 61, 0.75F);
  write({{0, "AO", first, kWindow, true}, {1, "AO", second, parts[1].window, true}}, kOnlyNew);
  const ExrReader file(out);
  EXPECT_EQ(file.info().parts[0].channels.size(), 2U);
  EXPECT_EQ(file.info().parts[0].data_window, united(kWindow, parts[1].window));
  EXPECT_EQ(read_plane(file, 0, "AO", {0, 10, 0, 10})(0, 0), 0.25F);
  EXPECT_EQ(read_plane(file, 0, "left.AO", {0, 10, 0, 10})(0, 0), 0.75F);
}

TEST_F(ExrWriter, RefusesWritesThatFitNoChannel) {
  tests::make_exr(in, {mixed("", Imf::ZIP_COMPRESSION, false)});
  const Plane value(3, 3);
  const Window window{0, 10, 2, 12};
  EXPECT_THROW(write({{0, "nix", value, window}}), Error);
  EXPECT_THROW(write({{0, "h", value, window, true}}), Error);
  EXPECT_THROW(write({{1, "h", value, window}}), Error);
  EXPECT_THROW(write({{0, "h", value, kWindow}}), Error);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST_F(ExrWriter, LeavesNothingWhenTheSourceIsDamaged) {
  tests::make_exr(in, {mixed("", Imf::PXR24_COMPRESSION, false)});
  std::string bytes = tests::read_file(in);
  const size_t at = bytes.find(tests::take_apart(in).chunks[0][1]);
  for (size_t i = 8; i < 48; ++i) bytes[at + i] = static_cast<char>(~bytes[at + i]);
  tests::write_file(in, bytes);
  const Plane value(3, 3);
  EXPECT_THROW(write({{0, "h", value, {0, 10, 2, 12}}}), Error);
  ++bytes[at];  // the chunk's line number: found even by a copy that does not decode
  tests::write_file(in, bytes);
  EXPECT_THROW(write({}), Error);
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST_F(ExrWriter, MakesNewFiles) {
  const Plane h(50, 38, 0.5F), f(50, 38, 0.1F), u(50, 38, 7.0F);
  Mat4 matrix;
  matrix[3][1] = 2.5;
  write_new_exr({.display_window = {0, 0, 63, 47},
                 .data_window = kWindow,
                 .channels = {{"R", PixelType::half, h}, {"Z", PixelType::single, f}, {"id", PixelType::uint, u}},
                 .matrices = {{"worldToCamera", matrix}},
                 .texts = {{"comment", "made"}}},
                out);
  const ExrReader file(out);
  EXPECT_EQ(file.info().display_window, (Window{0, 0, 63, 47}));
  EXPECT_EQ(file.info().parts[0].data_window, kWindow);
  EXPECT_EQ(file.info().parts[0].compression, "zip");
  EXPECT_EQ(read_plane(file, 0, "R", kWindow)(3, 3), 0.5F);
  EXPECT_EQ(read_plane(file, 0, "Z", kWindow)(49, 37), 0.1F);
  EXPECT_EQ(read_plane(file, 0, "id", kWindow)(0, 0), 7.0F);
  EXPECT_EQ((*file.matrix(0, "worldToCamera"))[3][1], 2.5);
  EXPECT_EQ(file.text(0, "comment"), "made");
}

TEST_F(ExrWriter, CopiesBeachballWithOneChangedChannel) {
  const std::string data = tests::data_folder() + "/beachball/singlepart.000";
  if (!std::filesystem::exists(data + "1.exr")) GTEST_SKIP() << "SKIPPED: no beachball sequence at " << data;
  for (int frame = 1; frame <= 8; ++frame) {
    const std::string source = data + std::to_string(frame) + ".exr";
    const ExrReader file(source);
    const Window window = file.info().parts[0].data_window;
    Plane red = read_plane(file, 0, "R", window);
    for (int y = 0; y < red.height(); ++y)
      for (int x = 0; x < red.width(); ++x) red(x, y) *= 0.5F;
    write_exr(file, std::vector<ChannelWrite>{{0, "R", red, window}}, out, {});
    EXPECT_EQ(tests::take_apart(source).headers, tests::take_apart(out).headers);
    Packed before = tests::decode_all(source)[0], after = tests::decode_all(out)[0];
    EXPECT_NE(before["R"], after["R"]);
    before.erase("R");
    after.erase("R");
    EXPECT_EQ(before, after) << frame;
  }
}

}  // namespace
}  // namespace aftershade::io
