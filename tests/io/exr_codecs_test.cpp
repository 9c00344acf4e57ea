#include <ImfMultiPartInputFile.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cstring>
#include <random>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/exr_writer.h"
#include "core/parallel/rows.h"
#include "tests/io/exr_files.h"

/// Our codecs and the OpenEXR library say the same of every file, and read each other's.
namespace aftershade::io {
namespace {
using tests::PartSpec;
using tests::TempFolder;

ReadLimits with(PixelCodecs codecs) {
  ReadLimits limits;
  limits.max_frame_bytes = 256 << 20;
  limits.codecs = codecs;
  return limits;
}

/// All pixels as the bits of floats, or nothing when the file cannot be read.
std::optional<std::vector<uint32_t>> pixels_of(const std::string& path, PixelCodecs codecs) {
  try {
    std::vector<uint32_t> bits;
    const ExrReader file(path, with(codecs));
    for (size_t i = 0; i < file.info().parts.size(); ++i) {
      const PartInfo& part = file.info().parts[i];
      std::vector<Plane> planes;
      std::vector<ExrReader::Request> requests;
      for (const ChannelInfo& channel : part.channels) {
        planes.emplace_back(part.data_window.width(), part.data_window.height());
        requests.push_back({channel.name, planes.back()});
      }
      file.read(static_cast<int>(i), requests, part.data_window);
      for (const Plane& plane : planes)
        for (int y = 0; y < plane.height(); ++y)
          for (int x = 0; x < plane.width(); ++x) bits.push_back(std::bit_cast<uint32_t>(plane(x, y)));
    }
    return bits;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::data) << error.what();
    return std::nullopt;
  }
}

/// Returns whether both could read it.
bool expect_agreement(const std::string& path, const std::string& what) {
  const auto ours = pixels_of(path, PixelCodecs::automatic), theirs = pixels_of(path, PixelCodecs::openexr);
  EXPECT_EQ(ours.has_value(), theirs.has_value()) << what << ": only " << (ours ? "ours" : "OpenEXR") << " reads it";
  if (ours && theirs) {
    EXPECT_TRUE(*ours == *theirs) << what << ": other pixels";
  }
  return ours && theirs;
}

struct Kind {
  Imf::Compression compression;
  bool tiled;
  Imf::LineOrder order;
};
std::vector<Kind> all_kinds() {
  std::vector<Kind> kinds;
  for (int compression = 0; compression < 10; ++compression)
    for (const bool tiled : {false, true})
      for (const auto order : {Imf::INCREASING_Y, Imf::DECREASING_Y})
        kinds.push_back({static_cast<Imf::Compression>(compression), tiled, order});
  return kinds;
}
PartSpec spec_of(const Kind& kind, Window window, const std::string& name = "") {
  return {name,
          window,
          {{"h", Imf::HALF}, {"f", Imf::FLOAT}, {"u", Imf::UINT}, {"A", Imf::HALF}},
          kind.compression,
          kind.tiled,
          kind.order};
}
const Window kWindows[] = {{-5, 3, 44, 40}, {0, 0, 0, 0}, {7, -33, 7, 20}, {-100, -3, 33, -3}, {-20, -20, 43, 43}};

TEST(ExrCodecs, BothReadersAgreeOnValidFiles) {
  const TempFolder folder;
  for (const Kind& kind : all_kinds()) {
    for (const Window& window : kWindows) {
      tests::make_exr(folder / "a.exr", {spec_of(kind, window)});
      EXPECT_TRUE(expect_agreement(folder / "a.exr", "one part"));
    }
    tests::make_exr(folder / "a.exr", {spec_of(kind, kWindows[0], "a"), spec_of(kind, kWindows[4], "b")});
    EXPECT_TRUE(expect_agreement(folder / "a.exr", "two parts"));
  }
}

/// Smooth pixels, so that chunks are packed and damage hits the stream.
void make_smooth(const std::string& path, Imf::Compression compression, bool tiled) {
  tests::make_exr(path, {spec_of({Imf::NO_COMPRESSION, tiled, Imf::INCREASING_Y}, {-20, -20, 43, 43})});
  const Window window{-20, -20, 43, 43};
  Plane plane(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) plane(x, y) = static_cast<float>(x / 3 + y * 5);
  std::vector<ChannelWrite> writes;
  for (const char* channel : {"h", "f", "u", "A"}) writes.push_back({0, channel, plane, window});
  constexpr const char* kNames[] = {"none", "rle", "zips", "zip"};
  write_exr(ExrReader(path), writes, path, {.compression = kNames[compression]});
}

// What OpenEXR makes of a chunk that unpacks to fewer bytes than its pixels is whatever lay in its memory: no answer to
// agree with. Such a size can only be found in the leader of a chunk, which mutants keep.
TEST(ExrCodecs, BothReadersAgreeOnDamagedChunks) {
  const TempFolder folder;
  std::mt19937 random(7);
  int readable = 0, damaged = 0;
  for (int compression = 0; compression < 4; ++compression)
    for (const bool tiled : {false, true}) {
      make_smooth(folder / "a.exr", static_cast<Imf::Compression>(compression), tiled);
      const std::string bytes = tests::read_file(folder / "a.exr");
      const auto chunks = tests::take_apart(folder / "a.exr").chunks.at(0);
      for (int round = 0; round < 60; ++round) {
        const std::string& chunk = chunks[random() % chunks.size()];
        const size_t leader = tiled ? 20 : 8, at = bytes.find(chunk) + leader;
        std::string mutant = bytes;
        for (int i = 0; i < 1 + round % 3; ++i)
          mutant[at + random() % (chunk.size() - leader)] = static_cast<char>(random());
        tests::write_file(folder / "b.exr", mutant);
        (expect_agreement(folder / "b.exr", "a mutant") ? readable : damaged) += 1;
      }
    }
  EXPECT_GT(readable, 100);
  EXPECT_GT(damaged, 100);
}

// The headers alone, and no line order that is another than that of the chunks: OpenEXR reads on where it expects the
// next chunk, without a look at the offset table.
TEST(ExrCodecs, BothReadersAgreeOnDamagedHeaders) {
  const TempFolder folder;
  std::mt19937 random(11);
  int readable = 0, damaged = 0;
  for (const bool multi_part : {false, true}) {
    const Kind kind{Imf::ZIP_COMPRESSION, multi_part, Imf::INCREASING_Y};
    const PartSpec a = spec_of(kind, kWindows[0], multi_part ? "a" : ""), b = spec_of(kind, kWindows[4], "b");
    tests::make_exr(folder / "a.exr", multi_part ? std::vector{a, b} : std::vector{a});
    const std::string bytes = tests::read_file(folder / "a.exr");
    size_t table = 0;
    for (const auto& part : tests::take_apart(folder / "a.exr").chunks) table += 8 * part.size();
    const size_t header = bytes.find(tests::take_apart(folder / "a.exr").chunks[0][0]) - table - 8;
    for (int round = 0; round < 400; ++round) {
      std::string mutant = bytes;
      const size_t at = 8 + random() % (header - 8);
      if (bytes.substr(at - 4, 4) == std::string("\1\0\0\0", 4)) continue;  // a value of one byte
      mutant[at] = static_cast<char>(random() % 3 == 0 ? random() : random() % 4);
      tests::write_file(folder / "b.exr", mutant);
      const std::string what =
          cat("byte ", at, " is ", int{mutant[at]}, ", behind ", bytes.substr(at < 40 ? 0 : at - 40, 40));
      (expect_agreement(folder / "b.exr", what) ? readable : damaged) += 1;
    }
  }
  EXPECT_GT(readable, 50);
  EXPECT_GT(damaged, 100);
}

TEST(ExrCodecs, BothReadersAgreeOnTruncatedFiles) {
  const TempFolder folder;
  for (const bool tiled : {false, true}) {
    make_smooth(folder / "a.exr", Imf::ZIP_COMPRESSION, tiled);
    const std::string bytes = tests::read_file(folder / "a.exr");
    for (size_t length = 1; length < bytes.size(); length += 61) {
      tests::write_file(folder / "b.exr", bytes.substr(0, length));
      EXPECT_FALSE(expect_agreement(folder / "b.exr", "cut"));
    }
  }
}

TEST(ExrCodecs, BothReadersAgreeOnTheDamagedFilesOfOpenExr) {
  const std::string damaged = tests::data_folder() + "/damaged";
  if (!std::filesystem::is_directory(damaged)) GTEST_SKIP() << "SKIPPED: no damaged files at " << damaged;
  for (const auto& entry : std::filesystem::directory_iterator(damaged)) expect_agreement(entry.path(), entry.path());
}

// A chunk that says too much or too little of itself.
TEST(ExrCodecs, RefusesChunksOfOtherSizes) {
  const TempFolder folder;
  for (int compression = 0; compression < 4; ++compression)
    for (const bool tiled : {false, true}) {
      make_smooth(folder / "a.exr", static_cast<Imf::Compression>(compression), tiled);
      const std::string bytes = tests::read_file(folder / "a.exr");
      const std::string chunk = tests::take_apart(folder / "a.exr").chunks.at(0).at(1);
      const size_t at = bytes.find(chunk) + (tiled ? 16 : 4);
      for (const int32_t size : {-1, 0, 1, static_cast<int32_t>(chunk.size()) / 2, 1 << 20, 0x7FFFFFFF}) {
        std::string mutant = bytes;
        std::memcpy(mutant.data() + at, &size, sizeof size);
        tests::write_file(folder / "b.exr", mutant);
        EXPECT_FALSE(pixels_of(folder / "b.exr", PixelCodecs::automatic)) << compression << tiled << " " << size;
      }
    }
}

TEST(ExrCodecs, CountsWhatIsNoNumber) {
  const TempFolder folder;
  const Window window{0, 0, 40, 30};
  Plane plane(41, 31, 0.5F);
  plane(3, 4) = plane(40, 30) = std::numeric_limits<float>::quiet_NaN();
  plane(0, 0) = -std::numeric_limits<float>::infinity();
  write_new_exr({window, window, {{"h", PixelType::half, plane}, {"f", PixelType::single, plane}}, {}, {}},
                folder / "a.exr");
  for (const PixelCodecs codecs : {PixelCodecs::automatic, PixelCodecs::openexr}) {
    const ExrReader file(folder / "a.exr", with(codecs));
    NotNumbers h, f;
    Plane a(41, 31), b(41, 31);
    const ExrReader::Request requests[] = {{"h", a, &h}, {"f", b, &f}};
    file.read(0, requests, window);
    for (const NotNumbers& found : {h, f}) {
      EXPECT_EQ(found.nan, 2);
      EXPECT_EQ(found.infinite, 1);
    }
    const Window part{1, 0, 20, 30};
    const ExrReader::Request narrow[] = {{"h", a, &h}};
    file.read(0, narrow, part);
    EXPECT_EQ(h.nan, 1);
    EXPECT_EQ(h.infinite, 0);
  }
}

class Recode : public testing::Test {
 protected:
  TempFolder folder;
  const std::string in = folder / "in.exr", out = folder / "out.exr";
};

TEST_F(Recode, KeepsEveryBitOfLosslessParts) {
  for (const Kind& kind : all_kinds()) {
    if (kind.compression > Imf::PIZ_COMPRESSION) continue;
    for (const Window& window : kWindows) {
      tests::make_exr(in, {spec_of(kind, window, "a"), spec_of(kind, kWindows[1], "b")});
      EXPECT_TRUE(write_exr(ExrReader(in), {}, out, {.recode = true}).empty());
      EXPECT_EQ(tests::decode_all(in), tests::decode_all(out));
      EXPECT_EQ(tests::take_apart(in).headers, tests::take_apart(out).headers);
      const Imf::MultiPartInputFile file(out.c_str());
      EXPECT_TRUE(file.partComplete(0) && file.partComplete(1));
    }
  }
}

TEST_F(Recode, MakesZipOfLossyParts) {
  tests::make_exr(in, {spec_of({Imf::B44_COMPRESSION, false, Imf::INCREASING_Y}, kWindows[0])});
  EXPECT_EQ(write_exr(ExrReader(in), {}, out, {.recode = true}).size(), 1U);
  EXPECT_EQ(tests::decode_all(in), tests::decode_all(out));
  EXPECT_EQ(ExrReader(out).info().parts[0].compression, "zip");
}

// The bytes do not depend on the number of threads, and neither on what was decoded before.
TEST_F(Recode, IsTheSameOnAnyNumberOfThreads) {
  tests::make_exr(in, {spec_of({Imf::ZIP_COMPRESSION, false, Imf::DECREASING_Y}, {-20, -20, 43, 180})});
  const ExrReader file(in);
  write_exr(file, {}, out, {.recode = true});
  const std::string expected = tests::read_file(out);
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    PackedParts parts{{0, file.read_and_keep(0, {}, {})}};
    write_exr(file, {}, out, {.recode = true}, parts);
    EXPECT_EQ(tests::read_file(out), expected) << threads;
  }
  set_thread_count(0);
}

TEST_F(Recode, StreamsAreWhatZlibReads) {
  make_smooth(in, Imf::ZIP_COMPRESSION, false);
  write_exr(ExrReader(in), {}, out, {.recode = true});
  const Window window{-20, -20, 43, 43};
  const tests::FileParts parts = tests::take_apart(out);
  for (const std::string& chunk : parts.chunks.at(0)) {
    std::vector<unsigned char> pixels(12 * 64 * 16);
    uLongf size = pixels.size();
    ASSERT_EQ(uncompress(pixels.data(), &size, reinterpret_cast<const Bytef*>(chunk.data()) + 8, chunk.size() - 8),
              Z_OK);
    EXPECT_EQ(size, pixels.size());
  }
  EXPECT_EQ(ExrReader(out).info().parts[0].data_window, window);
}

// Chunks whose pixels come out as they were are not packed again: they keep the bytes that another encoder made.
TEST_F(Recode, UnchangedChunksOfAChangedPartKeepTheirBytes) {
  for (const bool tiled : {false, true}) {
    tests::make_exr(in, {spec_of({Imf::ZIP_COMPRESSION, tiled, Imf::INCREASING_Y}, {-20, -20, 43, 43})});
    const ExrReader file(in);
    Plane red(64, 64);
    const ExrReader::Request request{"h", red};
    const Window window{-20, -20, 43, 43};
    PackedParts parts{{0, file.read_and_keep(0, {&request, 1}, window)}};
    red(0, 17) = red(0, 17) == 1.0F ? 2.0F : 1.0F;  // in the second chunk of scanlines, the ninth tile
    const std::vector<ChannelWrite> writes{{0, "h", red, window}};
    for (const PackedParts& decoded : {parts, PackedParts()}) {
      write_exr(file, writes, out, {}, decoded);
      const auto before = tests::take_apart(in).chunks[0], after = tests::take_apart(out).chunks[0];
      for (size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i] == after[i], i != (tiled ? 8U : 1U)) << i;
      EXPECT_NE(tests::decode_all(in)[0].at("h"), tests::decode_all(out)[0].at("h"));
      EXPECT_EQ(tests::decode_all(in)[0].at("u"), tests::decode_all(out)[0].at("u"));
    }
  }
}

}  // namespace
}  // namespace aftershade::io
