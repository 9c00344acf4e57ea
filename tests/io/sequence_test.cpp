#include "core/io/sequence.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace aftershade::io {
namespace {

namespace fs = std::filesystem;

FrameNumbers range(int first, int last, int step = 1) {
  FrameNumbers out;
  for (int f = first; f <= last; f += step) out.push_back(f);
  return out;
}

TEST(Frames, RangesListsStepsAndNegativeNumbers) {
  EXPECT_EQ(parse_frames("7"), FrameNumbers{7});
  EXPECT_EQ(parse_frames("1001-1100"), range(1001, 1100));
  EXPECT_EQ(parse_frames("1-10x3"), (FrameNumbers{1, 4, 7, 10}));
  EXPECT_EQ(parse_frames("1-10:4"), (FrameNumbers{1, 5, 9}));
  EXPECT_EQ(parse_frames("-3--1"), (FrameNumbers{-3, -2, -1}));
  EXPECT_EQ(parse_frames("-2-1"), (FrameNumbers{-2, -1, 0, 1}));
  EXPECT_EQ(parse_frames("10-1x4"), (FrameNumbers{2, 6, 10})) << "counted down from 10";
  EXPECT_EQ(parse_frames("7-9,1,5,8"), (FrameNumbers{1, 5, 7, 8, 9})) << "sorted, each once";
}

TEST(Frames, AnythingElseIsAnErrorThatNamesThePiece) {
  for (const char* text : {"", "a", "1-", "1-2x", "1-2x0", "1-2y2", "1,,2", "1-2-3", "+1", "1 -2", "1-99999999999"}) {
    EXPECT_THROW(parse_frames(text), Error) << text;
  }
  EXPECT_THROW(parse_frames("1-2000000000"), Error) << "must not fill the memory";
  try {
    parse_frames("1-5,six");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(error.message().find("\"six\""), std::string::npos);
  }
}

TEST(Frames, FormattingReadsBack) {
  EXPECT_EQ(format_frames({}), "");
  EXPECT_EQ(format_frames({5}), "5");
  EXPECT_EQ(format_frames({1, 2}), "1,2");
  EXPECT_EQ(format_frames(parse_frames("1001-1100x2,1200")), "1001-1099x2,1200");
  EXPECT_EQ(format_frames(parse_frames("-5--1,3,10-12")), "-5--1,3,10-12");
  for (const char* text : {"1,2,10-12", "1,5-8", "-10-10x5", "1-3,5-9x2,20"})
    EXPECT_EQ(parse_frames(format_frames(parse_frames(text))), parse_frames(text)) << text;
}

TEST(PatternTest, EveryNotation) {
  struct Case {
    const char* text;
    const char* name_of_7;
  };
  for (const Case& c :
       {Case{"shot.####.exr", "shot.0007.exr"}, Case{"shot.#.exr", "shot.7.exr"},
        Case{"shot.%04d.exr", "shot.0007.exr"}, Case{"shot.%d.exr", "shot.7.exr"},
        Case{"shot.@@@@.exr", "shot.0007.exr"}, Case{"shot.$F4.exr", "shot.0007.exr"},
        Case{"shot.$F.exr", "shot.7.exr"}, Case{"shot_####", "shot_0007"}, Case{"shot.#@@.exr", "shot.007.exr"}}) {
    const auto pattern = parse_pattern(c.text, HashDigits::one);
    ASSERT_TRUE(pattern) << c.text;
    EXPECT_EQ(pattern->path(7), c.name_of_7) << c.text;
    EXPECT_FALSE(pattern->range) << c.text;
  }
  EXPECT_FALSE(parse_pattern("shot.1001.exr", HashDigits::one));
  EXPECT_FALSE(parse_pattern("shot.$FRAME.exr", HashDigits::one));
  EXPECT_FALSE(parse_pattern("50%.exr", HashDigits::one));
}

TEST(PatternTest, OpenImageIoHashesAreFourDigitsButOthersAreNot) {
  EXPECT_EQ(parse_pattern("a.#.exr", HashDigits::oiio)->path(7), "a.0007.exr");
  EXPECT_EQ(parse_pattern("a.##.exr", HashDigits::oiio)->path(7), "a.00000007.exr");
  EXPECT_EQ(parse_pattern("a.#@@.exr", HashDigits::oiio)->path(7), "a.000007.exr");
  EXPECT_EQ(parse_pattern("a.@.exr", HashDigits::oiio)->path(7), "a.7.exr");
  EXPECT_THROW(parse_pattern("a.####.exr", HashDigits::oiio), Error) << "16 digits are a misunderstanding";
}

TEST(PatternTest, OnlyTheFileNameIsSearched) {
  const auto pattern = parse_pattern("/jobs/@vol/%d/x.####.exr", HashDigits::one);
  ASSERT_TRUE(pattern);
  EXPECT_EQ(pattern->folder, "/jobs/@vol/%d");
  EXPECT_EQ(pattern->path(12), "/jobs/@vol/%d/x.0012.exr");
  EXPECT_EQ(pattern->text(), "/jobs/@vol/%d/x.####.exr");
  EXPECT_FALSE(parse_pattern("shot.####/beauty.exr", HashDigits::one));
  EXPECT_EQ(parse_pattern("/x.#.exr", HashDigits::one)->path(1), "/x.1.exr");
}

TEST(PatternTest, InlineRangesAndDigitsThatBelongToTheName) {
  const auto inline_range = parse_pattern("shot.1001-1100#.exr", HashDigits::one);
  EXPECT_EQ(inline_range->prefix, "shot.");
  EXPECT_EQ(inline_range->range, range(1001, 1100));
  EXPECT_EQ(parse_pattern("shot.1-9x2,20%04d.exr", HashDigits::one)->range, (FrameNumbers{1, 3, 5, 7, 9, 20}));
  EXPECT_EQ(parse_pattern("shot.-10--1####.exr", HashDigits::one)->range, range(-10, -1));
  EXPECT_EQ(parse_pattern("shot-1-3#.exr", HashDigits::one)->range, range(1, 3)) << "the first - separates";
  for (const char* name : {"v2#.exr", "shot010#.exr", "shot.2#.exr", "shot010-020#.exr", "a-#.exr", "a,#.exr"}) {
    const auto pattern = parse_pattern(name, HashDigits::one);
    EXPECT_FALSE(pattern->range) << name;
    EXPECT_EQ(pattern->prefix + "#.exr", name);
  }
}

TEST(PatternTest, LiteralFrames) {
  const auto check = [](const char* path, const char* prefix, int frame, int padding, const char* suffix) {
    const auto pattern = pattern_of_frame(path);
    ASSERT_TRUE(pattern) << path;
    EXPECT_EQ(pattern->prefix, prefix) << path;
    EXPECT_EQ(pattern->suffix, suffix) << path;
    EXPECT_EQ(pattern->padding, padding) << path;
    EXPECT_EQ(pattern->path(frame), path);
  };
  check("d/shot.1001.exr", "shot.", 1001, 4, ".exr");
  check("shot_v2.0007.exr", "shot_v2.", 7, 4, ".exr");
  check("shot_v2.-5.exr", "shot_v2.", -5, 1, ".exr");
  check("shot-5.exr", "shot-", 5, 1, ".exr");
  check("shot.1001.beauty_v3.exr", "shot.", 1001, 4, ".beauty_v3.exr");
  check("0001.exr", "", 1, 4, ".exr");
  check("shot.0012", "shot.", 12, 4, "");
  EXPECT_FALSE(pattern_of_frame("beauty.exr"));
  EXPECT_FALSE(pattern_of_frame("beauty_v2.exr")) << "a version is no frame number";
  EXPECT_FALSE(pattern_of_frame("d.0001/beauty.exr"));
}

TEST(PatternTest, PaddingDecidesWhatMatches) {
  const Pattern padded{.folder = ".", .prefix = "a.", .suffix = ".exr", .padding = 4};
  EXPECT_EQ(frame_of_name(padded, "a.0001.exr"), 1);
  EXPECT_EQ(frame_of_name(padded, "a.-0012.exr"), -12);
  EXPECT_EQ(frame_of_name(padded, "a.12345.exr"), 12345);
  for (const char* name : {"a.00001.exr", "a.001.exr", "a.exr", "a..exr", "a.0x01.exr", "b.0001.exr", "a.0001.exr.tmp",
                           "a.-0000.exr", "a.99999999999.exr"})
    EXPECT_FALSE(frame_of_name(padded, name)) << name;
  const Pattern unpadded{.folder = ".", .prefix = "a.", .suffix = ".exr", .padding = 1};
  EXPECT_EQ(frame_of_name(unpadded, "a.0.exr"), 0);
  EXPECT_EQ(frame_of_name(unpadded, "a.10.exr"), 10);
  EXPECT_FALSE(frame_of_name(unpadded, "a.01.exr"));
  for (int frame : {-123456, -1, 0, 9, 10, 1001, 99999}) {
    EXPECT_EQ(frame_of_name(padded, padded.name(frame)), frame);
    EXPECT_EQ(frame_of_name(unpadded, unpadded.name(frame)), frame);
  }
}

TEST(SequenceTest, SortsAndFindsHolesInItsOwnStep) {
  const Sequence twos({{9, "i"}, {1, "a"}, {3, "c"}, {3, "c"}});
  EXPECT_EQ(twos.frames(), (FrameNumbers{1, 3, 9}));
  EXPECT_EQ(twos.holes(), (FrameNumbers{5, 7}));
  EXPECT_EQ(*twos.path(3), "c");
  EXPECT_EQ(twos.path(2), nullptr);
  EXPECT_TRUE(Sequence({{5, ""}}).holes().empty());
  EXPECT_TRUE(Sequence().holes().empty());
  EXPECT_EQ(Sequence({{1, ""}, {2, ""}, {5, ""}}).holes(), (FrameNumbers{3, 4}));
}

/// A folder of empty files, removed at the end.
class FindSequence : public ::testing::Test {
 protected:
  FindSequence() : folder_(fs::path(::testing::TempDir()) / ("find_sequence_" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~FindSequence() override { fs::remove_all(folder_); }
  void touch(const std::string& name) { std::ofstream(folder_ / name).put('x'); }
  FoundSequence find(const std::string& name) { return find_sequence((folder_ / name).string(), HashDigits::one); }
  std::string message(const std::string& name) {
    try {
      find(name);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::no_input);
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(FindSequence, PatternLiteralFrameAndFolder) {
  for (const char* name : {"a.0998.exr", "a.0999.exr", "a.1000.exr", "a.-0001.exr", ".a.0001.exr.tmp", "notes.txt"})
    touch(name);
  for (const char* input : {"a.####.exr", "a.$F4.exr", "a.1000.exr", "a.0998.exr", "", "a.1-5####.exr"}) {
    const FoundSequence found = find(input);
    EXPECT_EQ(found.sequence.frames(), (FrameNumbers{-1, 998, 999, 1000})) << input;
    EXPECT_EQ(*found.sequence.path(999), (folder_ / "a.0999.exr").string());
  }
}

TEST_F(FindSequence, UnpaddedLiteralFrame) {
  for (const char* name : {"b.8.exr", "b.9.exr", "b.10.exr", "b.11.exr"}) touch(name);
  EXPECT_EQ(find("b.10.exr").sequence.frames(), range(8, 11));
  EXPECT_EQ(find("").sequence.frames(), range(8, 11));
  EXPECT_EQ(find("b.#.exr").sequence.frames(), range(8, 11));
}

TEST_F(FindSequence, OneFileWithoutNumber) {
  touch("beauty@2x.exr");
  EXPECT_EQ(find("beauty@2x.exr").sequence.entries().size(), 1U) << "a file that exists is never a pattern";
  EXPECT_FALSE(find("").pattern.has_token);
  EXPECT_EQ(find("").pattern.path(0), (folder_ / "beauty@2x.exr").string());
}

TEST_F(FindSequence, ErrorsSayWhatThereIs) {
  EXPECT_NE(message("").find("holds no EXR file"), std::string::npos);
  EXPECT_NE(message("no/such.####.exr").find("cannot read folder"), std::string::npos);
  for (const char* name : {"a.1.exr", "a.2.exr", "ab.0001.exr"}) touch(name);
  EXPECT_NE(message("").find("a.#.exr 1,2"), std::string::npos) << message("");
  EXPECT_NE(message("").find("ab.####.exr 1"), std::string::npos);
  EXPECT_NE(message("c.####.exr").find("a.#.exr 1,2"), std::string::npos);
  EXPECT_NE(message("a.3.exr").find("there is no file"), std::string::npos);
}

}  // namespace
}  // namespace aftershade::io
