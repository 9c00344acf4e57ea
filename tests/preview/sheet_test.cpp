#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "core/preview/loader.h"
#include "tests/preview/png.h"

namespace aftershade::tests {
namespace {

using namespace preview;
namespace fs = std::filesystem;
using Rgb = std::array<int, 3>;
constexpr Rgb kBackground{31, 31, 31};

Cell color_cell(int width, int height, std::array<float, 3> rgb, std::string label = {}) {
  Cell cell;
  for (const float value : rgb) cell.planes.emplace_back(width, height, value);
  cell.label = std::move(label);
  return cell;
}
Cell grey_cell(int width, int height, float value, std::string label = {}) {
  Cell cell;
  cell.planes.emplace_back(width, height, value);
  cell.label = std::move(label);
  return cell;
}

template <class... Cells>
std::vector<Cell> row_of(Cells&&... cells) {
  std::vector<Cell> row;
  (row.push_back(std::forward<Cells>(cells)), ...);
  return row;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ContactSheet : public ::testing::Test {
 protected:
  ContactSheet() : folder_(fs::temp_directory_path() / ("aftershade-sheet-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~ContactSheet() override { fs::remove_all(folder_); }
  std::string path() const { return (folder_ / "sheet.png").string(); }
  Png written(Sheet sheet) {
    note_ = write_sheet(std::move(sheet), path());
    return read_png(path());
  }
  /// Labels need the font; without it the tests that look at text say nothing.
  bool font_is_missing() {
    Sheet sheet;
    sheet.rows.push_back(row_of(grey_cell(8, 8, 0, "x")));
    written(std::move(sheet));
    return !note_.empty();
  }
  fs::path folder_;
  std::string note_;
};

/// How many pixels of the rectangle are not background.
int marked(const Png& png, int x0, int y0, int x1, int y1) {
  int count = 0;
  for (int y = std::max(0, y0); y < std::min(png.height, y1); ++y)
    for (int x = std::max(0, x0); x < std::min(png.width, x1); ++x) count += png.at(x, y) != kBackground;
  return count;
}

TEST_F(ContactSheet, ShowsColourThroughTheDisplayAndGreyAsItIs) {
  Sheet sheet;
  sheet.style.gap_px = 4;
  sheet.rows.push_back(row_of(color_cell(20, 10, {0.18F, 1.0F, 0.0F}), grey_cell(20, 10, 0.5F)));
  const Png png = written(std::move(sheet));
  EXPECT_EQ(note_, "");
  EXPECT_EQ(png.width, 4 + 20 + 4 + 20 + 4);
  EXPECT_EQ(png.height, 4 + 10 + 4);
  for (const int x : {4, 13, 23}) EXPECT_EQ(png.at(x, 8), (Rgb{118, 255, 0})) << x;  // sRGB of 18 % is 117.6
  for (const int x : {28, 47}) EXPECT_EQ(png.at(x, 13), (Rgb{128, 128, 128})) << x;
  EXPECT_EQ(marked(png, 0, 0, png.width, png.height), 2 * 20 * 10);
  EXPECT_EQ(std::count(png.chunks.begin(), png.chunks.end(), "sRGB"), 1);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "a temporary file was left";
}

TEST_F(ContactSheet, ScalesWidePicturesDownWithoutShiftingThem) {
  Cell cell = grey_cell(200, 100, 0.25F);
  for (int y = 0; y < 100; ++y)
    for (int x = 100; x < 200; ++x) cell.planes[0](x, y) = 0.75F;
  Sheet sheet;
  sheet.style = {.max_cell_width_px = 50, .gap_px = 2};
  sheet.rows.push_back(row_of(std::move(cell)));
  const Png png = written(std::move(sheet));
  ASSERT_EQ(png.width, 2 + 50 + 2);
  ASSERT_EQ(png.height, 2 + 25 + 2);
  for (const int y : {2, 14, 26}) {  // corners and edges as well: the filter must not mix in what is outside
    EXPECT_EQ(png.at(2, y)[0], 64);
    EXPECT_EQ(png.at(20, y)[0], 64);
    EXPECT_EQ(png.at(33, y)[0], 191);
    EXPECT_EQ(png.at(51, y)[0], 191);
    EXPECT_NEAR(png.at(26, y)[0] + png.at(27, y)[0], 64 + 191, 1);  // the edge stays in the middle
  }
}

TEST_F(ContactSheet, FiltersNoNumbersAndClampsBeforeFiltering) {
  Cell cell = grey_cell(80, 80, 0.5F);
  cell.planes[0](40, 40) = std::numeric_limits<float>::quiet_NaN();
  cell.planes[0](8, 8) = std::numeric_limits<float>::infinity();
  cell.planes[0](60, 8) = 1e30F;
  const SheetStyle style{.max_cell_width_px = 20};
  shrink(cell, style);
  ASSERT_EQ(cell.planes[0].width(), 20);
  ASSERT_EQ(cell.planes[0].height(), 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) EXPECT_NEAR(cell.planes[0](x, y), 0.5F, 0.1F) << x << ' ' << y;
  EXPECT_LT(cell.planes[0](10, 10), 0.5F);
  EXPECT_GT(cell.planes[0](2, 2), 0.5F);
}

TEST_F(ContactSheet, ShrinkMakesPixelsSquareOnce) {
  Cell cell = color_cell(60, 40, {0.1F, 0.2F, 0.3F});
  cell.pixel_aspect = 2;
  shrink(cell, {});
  shrink(cell, {});
  ASSERT_EQ(cell.planes.size(), 3U);
  EXPECT_EQ(cell.planes[2].width(), 120);
  EXPECT_EQ(cell.planes[2].height(), 40);
  EXPECT_NEAR(cell.planes[1](119, 39), 0.2F, 1e-5);
}

TEST_F(ContactSheet, DrawsLabelsInTheirStrips) {
  if (font_is_missing()) GTEST_SKIP() << "NO FONT: " << note_;
  Sheet sheet;
  sheet.title = "A title";
  sheet.rows.push_back(row_of(grey_cell(200, 40, 0.5F, "before, frame 2"), grey_cell(200, 40, 0.5F, "gjpqy")));
  const Png png = written(std::move(sheet));
  ASSERT_EQ(png.width, 16 + 200 + 16 + 200 + 16);
  const int title_bottom = 16 + 33, top = title_bottom + 16, bottom = top + 40, end = bottom + 28;
  ASSERT_EQ(png.height, end + 16);
  EXPECT_GT(marked(png, 16, 16, 216, title_bottom), 100);
  EXPECT_GT(marked(png, 16, bottom, 216, end), 100);
  EXPECT_GT(marked(png, 232, bottom, 432, end), 50);
  EXPECT_EQ(marked(png, 0, end, png.width, png.height), 0) << "a descender leaves its strip";
  EXPECT_EQ(marked(png, 0, title_bottom, png.width, top), 0);
  EXPECT_EQ(marked(png, 216, 0, 232, png.height), 0) << "text runs into the gap";
  for (int x = 16; x < 216; ++x) EXPECT_EQ(png.at(x, bottom - 1), (Rgb{128, 128, 128}));  // text stays off the picture
}

TEST_F(ContactSheet, WidensColumnsForLabelsAndCutsWhatIsTooLong) {
  if (font_is_missing()) GTEST_SKIP() << "NO FONT: " << note_;
  Sheet sheet;
  sheet.title = std::string(300, 'W');
  sheet.style.max_cell_width_px = 150;
  sheet.rows.push_back(row_of(grey_cell(10, 10, 0.5F, "frame 1042"), grey_cell(10, 10, 0.5F, std::string(200, 'M'))));
  const Png png = written(std::move(sheet));
  EXPECT_GT(png.width, 16 + 60 + 16 + 150);
  EXPECT_LT(png.width, 16 + 150 + 16 + 150 + 16);
  EXPECT_EQ(marked(png, png.width - 16, 0, png.width, png.height), 0) << "text is cut by the margin";
}

TEST_F(ContactSheet, LeavesLabelsOutWithoutTheFontAndSaysSo) {
  Sheet sheet;
  sheet.title = "A title";
  sheet.style.font = (folder_ / "no-such-font.ttf").string();
  sheet.rows.push_back(row_of(grey_cell(30, 20, 0.5F, "before")));
  const Png png = written(std::move(sheet));
  EXPECT_NE(note_.find("no-such-font.ttf"), std::string::npos) << note_;
  EXPECT_EQ(png.width, 16 + 30 + 16);
  EXPECT_EQ(png.height, 16 + 20 + 16);
}

TEST_F(ContactSheet, ShowsDisplayValuesAsTheyAre) {
  Sheet sheet;
  sheet.style.gap_px = 4;
  Cell cell = color_cell(20, 10, {0.2F, 1.0F, 0.4F});
  cell.is_display = true;
  sheet.rows.push_back(row_of(std::move(cell)));
  EXPECT_EQ(written(std::move(sheet)).at(13, 8), (Rgb{51, 255, 102}));
}

TEST_F(ContactSheet, DrawsLegendsAsPatchesWithText) {
  if (font_is_missing()) GTEST_SKIP() << note_;
  Cell legend;
  legend.legend = {{{1, 0, 0}, "one"}, {{0, 0, 1}, "and another one"}};
  Sheet sheet;
  sheet.style = {.gap_px = 10, .label_size_px = 16};  // lines of 32 px with patches of 16 px in their middle
  sheet.rows.push_back(row_of(grey_cell(40, 80, 0.5F), std::move(legend)));
  const Png png = written(std::move(sheet));
  const int left = 10 + 40 + 10, top = 10 + 80 - 2 * 32;
  const auto is_patch = [&](int x, int y, Rgb color) {
    return png.at(x, y + 8) == color && png.at(x + 15, y + 23) == color;
  };
  EXPECT_TRUE(is_patch(left, top, {255, 0, 0}));
  EXPECT_TRUE(is_patch(left, top + 32, {0, 0, 255}));
  EXPECT_EQ(png.at(left, top + 6), kBackground);
  EXPECT_EQ(png.at(left + 17, top + 16), kBackground);
  const int one = marked(png, left + 32, top, png.width, top + 32),
            another = marked(png, left + 32, top + 32, png.width, top + 64);
  EXPECT_GT(one, 30);
  EXPECT_GT(another, 2 * one);
}

TEST_F(ContactSheet, KeepsAPlaceForACellWithoutPicture) {
  Sheet sheet;
  sheet.style.gap_px = 2;
  sheet.rows.push_back(row_of(grey_cell(10, 10, 0.5F), Cell{}, grey_cell(10, 10, 0.5F)));
  sheet.rows.push_back(row_of(grey_cell(10, 10, 0.5F), grey_cell(8, 6, 0.5F)));
  const Png png = written(std::move(sheet));
  EXPECT_EQ(png.width, 2 + 10 + 2 + 8 + 2 + 10 + 2);
  EXPECT_EQ(marked(png, 12, 0, 24, 12), 0);
}

TEST_F(ContactSheet, DoesNotDependOnTheNumberOfThreads) {
  std::string first;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    Cell cell = color_cell(301, 203, {0, 0, 0}, "noise");
    for (int y = 0; y < 203; ++y)
      for (int x = 0; x < 301; ++x) cell.planes[1](x, y) = static_cast<float>((x * 7919 + y * 104729) % 257) / 200.0F;
    Sheet sheet;
    sheet.style.max_cell_width_px = 97;
    sheet.rows.push_back(row_of(std::move(cell)));
    written(std::move(sheet));
    if (first.empty()) first = bytes_of(path());
    EXPECT_EQ(bytes_of(path()), first) << threads;
  }
  set_thread_count(0);
}

ErrorCode code_of(Sheet sheet, const std::string& path) {
  try {
    write_sheet(std::move(sheet), path);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::internal;
}

TEST_F(ContactSheet, RefusesWhatIsNoPicture) {
  Sheet two_planes;
  two_planes.rows.push_back(row_of(grey_cell(4, 4, 0)));
  two_planes.rows[0][0].planes.emplace_back(4, 4);
  EXPECT_EQ(code_of(std::move(two_planes), path()), ErrorCode::usage);

  Sheet odd_sizes;
  odd_sizes.rows.push_back(row_of(color_cell(4, 4, {})));
  odd_sizes.rows[0][0].planes[2] = Plane(4, 5);
  EXPECT_EQ(code_of(std::move(odd_sizes), path()), ErrorCode::usage);

  Sheet bad_aspect;
  bad_aspect.rows.push_back(row_of(grey_cell(4, 4, 0)));
  bad_aspect.rows[0][0].pixel_aspect = 0;
  EXPECT_EQ(code_of(std::move(bad_aspect), path()), ErrorCode::usage);

  Sheet too_high;
  too_high.style.gap_px = 40000;
  too_high.rows.push_back(row_of(grey_cell(4, 4, 0)));
  EXPECT_EQ(code_of(std::move(too_high), path()), ErrorCode::usage);

  EXPECT_EQ(code_of({}, path()), ErrorCode::usage);
  EXPECT_FALSE(fs::exists(path()));
}

TEST_F(ContactSheet, NamesAPathThatCannotBeWritten) {
  Sheet sheet;
  sheet.rows.push_back(row_of(grey_cell(4, 4, 0)));
  EXPECT_EQ(code_of(std::move(sheet), (folder_ / "no-such-folder" / "sheet.png").string()), ErrorCode::cannot_create);
}

}  // namespace
}  // namespace aftershade::tests
