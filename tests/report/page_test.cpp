#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/base/error.h"
#include "core/params/table.h"
#include "core/report/page_pictures.h"
#include "tests/preview/png.h"
#include "tests/report/sample.h"

namespace aftershade::tests {
namespace {

using namespace report;
using params::Json;

constexpr size_t kMegabyte = size_t{1} << 20;

/// Twelve small frames with pictures.
SampleOptions many_frames() {
  SampleOptions options;
  options.frames = 24;
  options.shown = 12;
  options.display = {16, 8, 16 + 319, 8 + 179};
  return options;
}

std::string page(const Comparison& comparison, size_t budget, std::vector<std::string>& notes) {
  return page_text(comparison, budget, notes);
}

/// The JSON inside the script element with this id.
Json inside(const std::string& page, const std::string& id) {
  const std::string open = "<script type=\"application/json\" id=\"" + id + "\">";
  const size_t from = page.find(open) + open.size(), to = page.find("</script>", from);
  return Json::parse(page.substr(from, to - from));
}

std::vector<unsigned char> from_base64(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> out;
  unsigned bits = 0, count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(kDigits.find(c));
    if ((count += 6) >= 8) out.push_back(static_cast<unsigned char>(bits >> (count -= 8) & 255U));
  }
  return out;
}

/// What a reader of the page does: the picture's PNG plus its base, modulo 256. read_png() wants colour.
std::vector<uint8_t> unpacked(const Json& set, size_t index) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / ("aftershade-page-test-" + std::to_string(getpid()) + ".png");
  const auto bytes = from_base64(set[index]["png"].get<std::string>());
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  std::vector<uint8_t> pixels = read_png(path.string()).pixels;
  std::filesystem::remove(path);
  const int base = set[index]["base"].get<int>();
  if (base < 0) return pixels;
  const std::vector<uint8_t> other = unpacked(set, static_cast<size_t>(base));
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint8_t>(pixels[i] + other[i]);
  return pixels;
}

TEST(Page, PicturesAreLossless) {
  SampleOptions options;
  options.shown = 1;
  const Comparison comparison = sample_comparison(options);
  std::vector<std::string> notes;
  const Json shown = inside(page(comparison, 24 * kMegabyte, notes), "shown");
  EXPECT_TRUE(notes.empty());
  ASSERT_EQ(shown.size(), 1U);
  EXPECT_EQ(shown[0]["frame"], 2);
  for (size_t i = 0; i < comparison.shown[0].whole.size(); ++i) {
    EXPECT_EQ(unpacked(shown[0]["whole"], i), comparison.shown[0].whole[i].rgb) << i;
    EXPECT_EQ(unpacked(shown[0]["detail"], i), comparison.shown[0].detail[i].rgb) << i;
  }
}

/// A textured picture, darkened towards its lower right corner by up to `most`.
Picture textured(unsigned seed, int most) {
  Picture out{160, 90, {}};
  std::minstd_rand random(seed);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      for (int c = 0; c < 3; ++c)
        out.rgb.push_back(
            static_cast<unsigned char>(100 + random() % 80 - static_cast<unsigned>(most * x * y / 14400)));
  return out;
}

size_t bytes_alone(const std::vector<Picture>& pictures) {
  size_t bytes = 0;
  for (const Picture& picture : pictures) bytes += preview::png(picture).size();
  return bytes;
}

size_t bytes_packed(const std::vector<Picture>& pictures) {
  size_t bytes = 0;
  for (const PackedPicture& picture : packed(pictures, 0)) bytes += picture.png.size();
  return bytes;
}

TEST(Page, WhatChangesLittleTakesLittleRoom) {
  const std::vector<Picture> alike{textured(1, 0), textured(1, 20), textured(1, 22), textured(1, 40)};
  EXPECT_LT(static_cast<double>(bytes_packed(alike)), 0.4 * static_cast<double>(bytes_alone(alike)));
}

TEST(Page, DifferencesAreNeverLargerThanPictures) {
  const std::vector<Picture> unlike{textured(1, 0), textured(2, 0), textured(3, 9)};
  EXPECT_LE(bytes_packed(unlike), bytes_alone(unlike));
  SampleOptions options;
  options.shown = 1;
  const std::vector<Picture> noisy = sample_comparison(options).shown[0].whole;
  EXPECT_LE(bytes_packed(noisy), bytes_alone(noisy));
}

TEST(Page, BasesAreTheNearestPictureBefore) {
  Picture a{4, 1, {}}, b = a, c = a, other{2, 1, {}};
  a.rgb = {0, 90, 0, 200, 0, 30, 0, 255, 9, 77, 0, 140};
  b.rgb = c.rgb = a.rgb;
  for (auto& value : b.rgb) value = static_cast<unsigned char>(value + 9);
  for (auto& value : c.rgb) value = static_cast<unsigned char>(value + 8);
  other.rgb = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(bases_of({b, c, a, other}, 2), (std::vector{2, 0, -1, -1}));
  EXPECT_EQ(bases_of({Picture{}, a, a}, 0), (std::vector{-1, -1, 1})) << "none is no base";
}

/// Bytes of the page with all pictures and with none.
std::pair<size_t, size_t> page_sizes(Comparison comparison) {
  std::vector<std::string> notes;
  const size_t all = page(comparison, 24 * kMegabyte, notes).size();
  comparison.shown.clear();
  const size_t none = page(comparison, 24 * kMegabyte, notes).size();
  EXPECT_TRUE(notes.empty());
  return {all, none};
}

TEST(Page, KeepsItsBudget) {
  const Comparison comparison = sample_comparison(many_frames());
  const auto [all, none] = page_sizes(comparison);
  for (const size_t part : {2U, 5U, 20U, 100U}) {
    const size_t budget = none + 1500 + (all - none) / part;
    std::vector<std::string> told;
    const std::string text = page(comparison, budget, told);
    EXPECT_LE(text.size(), budget);
    EXPECT_FALSE(told.empty()) << part;
    EXPECT_EQ(inside(text, "data")["notes"].get<std::vector<std::string>>(), told) << "the page says so too";
  }
}

TEST(Page, FramesWithTheSmallestErrorsGoFirstThenSize) {
  const Comparison comparison = sample_comparison(many_frames());
  const auto [all, none] = page_sizes(comparison);
  std::vector<std::string> notes;
  const Json half = inside(page(comparison, (all + none) / 2, notes), "shown");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].find("the page shows pictures of " + std::to_string(half.size()) + " of the 12 worst frames"), 0U);
  ASSERT_GE(half.size(), 3U);
  EXPECT_EQ(half[0]["whole"][0]["width"], 160) << "fewer, but not smaller";
  double least_kept = 1, greatest_left = 0;
  for (const ShownFrame& frame : comparison.shown) {
    const bool kept =
        std::any_of(half.begin(), half.end(), [&](const Json& shown) { return shown["frame"] == frame.number; });
    if (kept) least_kept = std::min(least_kept, frame.error);
    if (!kept) greatest_left = std::max(greatest_left, frame.error);
  }
  EXPECT_GT(least_kept, greatest_left);

  const Json small = inside(page(comparison, none + 1500 + (all - none) / 8, notes), "shown");
  ASSERT_FALSE(small.empty());
  EXPECT_LT(small[0]["whole"][0]["width"].get<int>(), 160);
  EXPECT_EQ(small[0]["region"]["width"], small[0]["detail"][0]["width"]) << "a region stays pixel by pixel";
}

TEST(Page, SmallerRegionsAreCutAroundTheirMiddle) {
  SampleOptions options;
  options.shown = 1;
  const ShownFrame frame = sample_comparison(options).shown[0];
  const ShownFrame half = smaller(frame, 1);
  EXPECT_EQ(half.whole[0].width, frame.whole[0].width / 2);
  EXPECT_EQ(half.region.width(), 80);
  EXPECT_EQ(half.region.min_x, frame.region.min_x + 40);
  for (const size_t index : {size_t{0}, size_t{5}}) {
    const auto expected = sample_pixel(2, index, half.region.min_x - 16 + 3, half.region.min_y - 8 + 2);
    const size_t at = 3 * (2 * 80 + 3);
    EXPECT_EQ((std::array{half.detail[index].rgb[at], half.detail[index].rgb[at + 1], half.detail[index].rgb[at + 2]}),
              expected);
  }
}

TEST(Page, TooSmallABudgetIsAnError) {
  std::vector<std::string> notes;
  try {
    page(sample_comparison(), 1000, notes);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
  }
}

TEST(Page, NamesAreNeverMarkup) {
  Comparison comparison = sample_comparison();
  comparison.shown.clear();
  const std::string hostile = "</script><script>alert(1)</script><!-- {{style}} \" ' & \xFF";
  comparison.input = comparison.reference = comparison.candidates[0].preset.name = hostile;
  comparison.candidates[1].preset.description = hostile;
  std::vector<std::string> notes;
  const std::string text = page(comparison, kMegabyte, notes);
  EXPECT_EQ(text.find("<script>alert"), std::string::npos);
  EXPECT_EQ(text.find("<!-- {{"), std::string::npos);
  EXPECT_NE(text.find("<title>&lt;/script&gt;&lt;script&gt;"), std::string::npos);
  const std::string clean = hostile.substr(0, hostile.size() - 1) + "\xEF\xBF\xBD";  // U+FFFD
  EXPECT_EQ(inside(text, "data")["presets"][0]["name"], clean);
}

TEST(Page, NeedsNoOtherFile) {
  Comparison comparison = sample_comparison();
  comparison.shown.clear();
  std::vector<std::string> notes;
  const std::string text = page(comparison, kMegabyte, notes);
  for (const char* reach : {"{{", "<link", "@import", " src=", "url(", "fetch(", "XMLHttpRequest"})
    EXPECT_EQ(text.find(reach), std::string::npos) << reach;
}

}  // namespace
}  // namespace aftershade::tests
