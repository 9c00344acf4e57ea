#include "core/preview/picture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "tests/preview/png.h"

namespace aftershade::tests {
namespace {

using namespace preview;
namespace fs = std::filesystem;

Plane ramp(int width, int height, float first, float step) {
  Plane out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out(x, y) = first + step * static_cast<float>(y * width + x);
  return out;
}

Picture grey_of(const Plane& plane) { return display_picture(std::array<ConstPlaneView, 1>{plane}); }

std::array<int, 3> at(const Picture& picture, int x, int y) {
  const size_t i = 3 * (static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x));
  return {picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]};
}

TEST(Picture, GreyIsShownAsItIs) {
  Plane plane(4, 1);
  plane(0, 0) = 0.5F, plane(1, 0) = -1, plane(2, 0) = 7, plane(3, 0) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(grey_of(plane).rgb, (std::vector<unsigned char>{128, 128, 128, 0, 0, 0, 255, 255, 255, 0, 0, 0}));
}

TEST(Picture, ColourGoesThroughTheView) {
  const Plane red(1, 1, 0.18F), green(1, 1, 1.0F), blue(1, 1, 0.0F);
  const std::array<ConstPlaneView, 3> rgb{red, green, blue};
  EXPECT_EQ(at(display_picture(rgb), 0, 0), (std::array{118, 255, 0}));
  EXPECT_EQ(at(display_picture(rgb, {"", "Raw"}), 0, 0), (std::array{46, 255, 0}));
  EXPECT_EQ(red(0, 0), 0.18F);  // what is shown stays as it is
}

TEST(Picture, IsNeverEnlargedAndKeepsItsProportions) {
  const Plane plane = ramp(40, 20, 0, 0.001F);
  const auto size_at = [&](PictureSize size) {
    const Picture picture = display_picture(std::array<ConstPlaneView, 1>{plane}, {}, size);
    return std::array{picture.width, picture.height};
  };
  EXPECT_EQ(size_at({}), (std::array{40, 20}));
  EXPECT_EQ(size_at({100}), (std::array{40, 20}));
  EXPECT_EQ(size_at({10}), (std::array{10, 5}));
  EXPECT_EQ(size_at({40, 2}), (std::array{40, 10}));
}

TEST(Picture, NoPlanesNoPicture) {
  EXPECT_TRUE(display_picture({}).empty());
  EXPECT_TRUE(display_picture(std::array<ConstPlaneView, 3>{}).empty());
}

TEST(Picture, ViewsThatDoNotExistAreErrors) {
  EXPECT_EQ(view_name({}), "sRGB");
  EXPECT_THROW(view_name({"", "Rwa"}), Error);
  EXPECT_THROW(view_name({"/no/such.ocio", ""}), Error);
  EXPECT_EQ(view_name({}), "sRGB") << "an error does not stay";
}

TEST(Picture, PngHoldsEveryPixel) {
  Picture picture{37, 11, {}};
  for (int i = 0; i < 37 * 11 * 3; ++i) picture.rgb.push_back(static_cast<unsigned char>((i * 7919) >> 3));
  const fs::path path = fs::path(testing::TempDir()) / "aftershade-picture.png";
  const std::vector<unsigned char> bytes = png(picture);
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  const Png read = read_png(path.string());
  fs::remove(path);
  EXPECT_EQ(read.width, 37);
  EXPECT_EQ(read.height, 11);
  EXPECT_EQ(read.pixels, picture.rgb);
}

TEST(Picture, GreyPngHasOneChannel) {
  const std::vector<unsigned char> bytes = png(grey_of(ramp(8, 8, 0, 0.01F)));
  ASSERT_GT(bytes.size(), 26U);
  EXPECT_EQ(bytes[24], 8);  // IHDR: bits a channel
  EXPECT_EQ(bytes[25], 0);  // IHDR: colour type grey
}

TEST(Picture, ResizedKeepsAFlatPictureFlat) {
  Picture flat{9, 7, std::vector<unsigned char>(9 * 7 * 3, 201)};
  const Picture half = resized(flat, 4, 3);
  EXPECT_EQ(half.width, 4);
  EXPECT_EQ(half.rgb, std::vector<unsigned char>(4 * 3 * 3, 201));
}

}  // namespace
}  // namespace aftershade::tests
