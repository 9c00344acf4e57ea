#include "core/preview/sheet_layout.h"

#include <gtest/gtest.h>

namespace aftershade::tests {
namespace {

using namespace preview;

TEST(Fitted, ScalesDownWithProportionsAndNeverUp) {
  constexpr PixelSize kLimit{640, 480};
  EXPECT_EQ(fitted({640, 360}, 1, kLimit), (PixelSize{640, 360}));
  EXPECT_EQ(fitted({1920, 1080}, 1, kLimit), (PixelSize{640, 360}));
  EXPECT_EQ(fitted({1080, 1920}, 1, kLimit), (PixelSize{270, 480}));
  EXPECT_EQ(fitted({64, 36}, 1, kLimit), (PixelSize{64, 36}));
}

TEST(Fitted, MakesPixelsSquare) {
  constexpr PixelSize kLimit{4000, 4000};
  EXPECT_EQ(fitted({914, 778}, 2, kLimit), (PixelSize{1828, 778}));    // anamorphic: widened
  EXPECT_EQ(fitted({720, 480}, 0.5F, kLimit), (PixelSize{720, 960}));  // heightened
  EXPECT_EQ(fitted({914, 778}, 2, {457, 4000}), (PixelSize{457, 195}));
}

TEST(Fitted, NeverVanishesUnlessEmpty) {
  EXPECT_EQ(fitted({100000, 1}, 1, {640, 640}), (PixelSize{640, 1}));
  EXPECT_EQ(fitted({0, 5}, 1, {640, 640}), (PixelSize{0, 0}));
}

TEST(Layout, PlacesAGrid) {
  const SheetLayout layout = lay_out({{{{100, 50}}, {{80, 40}}}, {{{60, 30}}, {{90, 45}}}},
                                     {.gap_px = 10, .title_height_px = 20, .label_height_px = 15});
  EXPECT_EQ(layout.sheet, (PixelSize{10 + 100 + 10 + 90 + 10, 10 + 20 + 10 + (50 + 15 + 10) + (45 + 15 + 10)}));
  EXPECT_EQ(layout.title, (Box{10, 10, 200, 20}));
  EXPECT_EQ(layout.rows[0][0].picture, (Box{10, 40, 100, 50}));
  EXPECT_EQ(layout.rows[0][0].label, (Box{10, 90, 100, 15}));
  EXPECT_EQ(layout.rows[0][1].picture, (Box{120, 50, 80, 40}));  // on the bottom of its row
  EXPECT_EQ(layout.rows[0][1].label, (Box{120, 90, 90, 15}));
  EXPECT_EQ(layout.rows[1][0].picture, (Box{10, 130, 60, 30}));
  EXPECT_EQ(layout.rows[1][1].picture, (Box{120, 115, 90, 45}));
}

TEST(Layout, WithoutTextHasNoStrips) {
  const SheetLayout layout = lay_out({{{{100, 50}}}}, {.gap_px = 4});
  EXPECT_EQ(layout.sheet, (PixelSize{108, 58}));
  EXPECT_EQ(layout.title, (Box{}));
  EXPECT_EQ(layout.rows[0][0].picture, (Box{4, 4, 100, 50}));
}

TEST(Layout, WidensAColumnForALabel) {
  const SheetLayout layout = lay_out({{{{40, 30}, 120}, {{40, 30}, 10}}}, {.gap_px = 5, .label_height_px = 12});
  EXPECT_EQ(layout.rows[0][0].label.width, 120);
  EXPECT_EQ(layout.rows[0][0].picture.width, 40);
  EXPECT_EQ(layout.rows[0][1].picture.x, 5 + 120 + 5);
}

TEST(Layout, TakesRowsOfDifferentLengthAndEmptyPlaces) {
  const SheetLayout layout = lay_out({{{{40, 30}}, {}, {{40, 30}}}, {{{40, 20}}}}, {.gap_px = 5});
  ASSERT_EQ(layout.rows[0].size(), 3U);
  ASSERT_EQ(layout.rows[1].size(), 1U);
  EXPECT_EQ(layout.rows[0][1].picture.width, 0);
  EXPECT_EQ(layout.sheet, (PixelSize{5 + 45 + 5 + 45, 5 + 35 + 25}));
}

TEST(Layout, CellsNeverOverlapOrLeaveTheSheet) {
  std::vector<std::vector<CellSize>> sizes;
  for (int row = 0; row < 4; ++row) {
    auto& cells = sizes.emplace_back();
    for (int column = 0; column < 5; ++column)
      cells.push_back({{30 + 17 * (row * column % 4), 20 + 13 * ((row + column) % 3)}, 11 * column});
  }
  const SheetLayout layout = lay_out(sizes, {.gap_px = 3, .title_height_px = 9, .label_height_px = 7});
  std::vector<Box> boxes{layout.title};
  for (const auto& row : layout.rows)
    for (const auto& cell : row) boxes.insert(boxes.end(), {cell.picture, cell.label});
  const auto apart = [](const Box& a, const Box& b) {
    return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
  };
  for (size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_GE(boxes[i].x, 3);
    EXPECT_GE(boxes[i].y, 3);
    EXPECT_LE(boxes[i].x + boxes[i].width, layout.sheet.width - 3);
    EXPECT_LE(boxes[i].y + boxes[i].height, layout.sheet.height - 3);
    for (size_t j = i + 1; j < boxes.size(); ++j) EXPECT_TRUE(apart(boxes[i], boxes[j])) << i << " and " << j;
  }
}

}  // namespace
}  // namespace aftershade::tests
