#include "core/preview/false_color.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace aftershade::tests {
namespace {

using namespace preview;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

Plane row_of(std::initializer_list<float> values) {
  Plane out(static_cast<int>(values.size()), 1);
  int x = 0;
  for (const float value : values) out(x++, 0) = value;
  return out;
}
Rgb at(const std::vector<Plane>& planes, int x, int y = 0) {
  return {planes[0](x, y), planes[1](x, y), planes[2](x, y)};
}

TEST(FalseColor, RangeIsOfFiniteValues) {
  const Range range = range_of(row_of({kNan, 3, -2, kInf, 1, -kInf}));
  EXPECT_EQ(range.least, -2);
  EXPECT_EQ(range.largest, 3);
  const Range nothing = range_of(row_of({kNan, kInf}));
  EXPECT_EQ(nothing.least, 0);
  EXPECT_EQ(nothing.largest, 0);
}

TEST(FalseColor, GreyGoesEvenlyFromBlackToWhite) {
  const Plane grey = scaled(row_of({-1, 2, 4, 6, 9, kNan, kInf}), 2, 6);
  const std::array<float, 7> expected{0, 0, 0.5F, 1, 1, 0, 1};
  for (int x = 0; x < 7; ++x) EXPECT_EQ(grey(x, 0), expected[static_cast<size_t>(x)]) << x;
  EXPECT_EQ(scaled(row_of({5}), 3, 3)(0, 0), 0);
  EXPECT_EQ(scaled(row_of({2}), 6, 2)(0, 0), 1) << "it may also go down";
}

TEST(FalseColor, CodesHaveTheirColours) {
  constexpr std::array<Rgb, 3> palette{{{0.1F, 0.2F, 0.3F}, {1, 0, 0}, {0, 1, 0.5F}}};
  const auto picture = coded(row_of({0, 2, 1, 3, -1, kNan, 1.9F}), palette);
  ASSERT_EQ(picture.size(), 3U);
  EXPECT_EQ(at(picture, 0), palette[0]);
  EXPECT_EQ(at(picture, 1), palette[2]);
  EXPECT_EQ(at(picture, 2), palette[1]);
  for (const int x : {3, 4, 5}) EXPECT_EQ(at(picture, x), Rgb{}) << x;
  EXPECT_EQ(at(picture, 6), palette[2]) << "half floats round";
}

TEST(FalseColor, LongestLeavesOutWhatIsNotFinite) {
  EXPECT_EQ(longest_of(row_of({3, 1, kNan, kInf}), row_of({-4, 0, 1, 0})), 5);
  EXPECT_EQ(longest_of(row_of({kNan}), row_of({0})), 0);
}

/// Within rounding.
void expect_color(Rgb color, Rgb expected) {
  EXPECT_NEAR(color.r, expected.r, 1e-5);
  EXPECT_NEAR(color.g, expected.g, 1e-5);
  EXPECT_NEAR(color.b, expected.b, 1e-5);
}

TEST(FalseColor, DirectionIsHueAndLengthIsBrightness) {
  expect_color(wheel_color(4, 0, 4), {1, 0, 0});      // right: red
  expect_color(wheel_color(0, 4, 4), {0.5F, 1, 0});   // down, a quarter turn: yellow-green
  expect_color(wheel_color(-4, 0, 4), {0, 1, 1});     // left: cyan
  expect_color(wheel_color(0, -4, 4), {0.5F, 0, 1});  // up: violet
  expect_color(wheel_color(1, 0, 4), {0.25F, 0, 0});
  expect_color(wheel_color(8, 0, 4), {1, 0, 0});
  expect_color(wheel_color(0, 0, 4), {0, 0, 0});
  expect_color(wheel_color(1, 1, 0), {0, 0, 0});
  expect_color(wheel_color(kNan, 1, 4), {0, 0, 0});
  for (int i = 0; i < 360; ++i) {  // full brightness: the largest channel is 1, the least 0
    const float turn = 6.2831853F * static_cast<float>(i) / 360;
    const Rgb color = wheel_color(std::cos(turn), std::sin(turn), 1);
    EXPECT_NEAR(std::max({color.r, color.g, color.b}), 1, 1e-5) << i;
    EXPECT_NEAR(std::min({color.r, color.g, color.b}), 0, 1e-5) << i;
  }
}

TEST(FalseColor, PicturesOfVectorsAndTheirKeyUseTheWheel) {
  const Plane x = row_of({2, -1, kNan}), y = row_of({0, 0.5F, 1});
  const auto picture = wheel(x, y, 2);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(at(picture, i), wheel_color(x(i, 0), y(i, 0), 2));
  const auto key = wheel_key(41);
  ASSERT_EQ(key[0].width(), 41);
  EXPECT_EQ(at(key, 0, 0), Rgb{}) << "outside the disc";
  EXPECT_EQ(at(key, 20, 20), Rgb{}) << "nothing moves";
  expect_color(at(key, 40, 20), wheel_color(20, 0, 20.5F));
  expect_color(at(key, 20, 0), wheel_color(0, -20, 20.5F));
}

}  // namespace
}  // namespace aftershade::tests
