#include "core/color/display.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace aftershade::tests {
namespace {

/// IEC 61966-2-1, encoding direction.
double srgb_reference(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::array<Plane, 3> planes_with(const std::vector<float>& values) {
  const int width = static_cast<int>(values.size());
  std::array<Plane, 3> out{Plane(width, 1), Plane(width, 1), Plane(width, 1)};
  for (auto& plane : out) std::copy(values.begin(), values.end(), plane.row(0));
  return out;
}

void convert(std::array<Plane, 3>& rgb) {
  const std::array<PlaneView, 3> views{rgb[0].view(), rgb[1].view(), rgb[2].view()};
  color::to_display(views);
}

TEST(Display, IsTheSrgbCurve) {
  std::vector<float> values{0.0F, 0.0031308F, 0.18F, 0.5F, 1.0F};
  for (int i = 0; i <= 2000; ++i) values.push_back(static_cast<float>(i) / 2000.0F);
  auto rgb = planes_with(values);
  convert(rgb);
  for (const auto& plane : rgb)
    for (size_t i = 0; i < values.size(); ++i)
      EXPECT_NEAR(plane(static_cast<int>(i), 0), srgb_reference(static_cast<double>(values[i])), 1e-5) << values[i];
}

TEST(Display, ShowsMiddleGreyAt118Of255) {
  auto rgb = planes_with({0.18F});
  convert(rgb);
  EXPECT_EQ(std::lround(rgb[1](0, 0) * 255.0F), 118);  // the well-known code value of 18 % grey
}

TEST(Display, ClampsAndTurnsNanToBlack) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  auto rgb = planes_with({-1.0F, 4.0F, 65504.0F, kInf, -kInf, std::numeric_limits<float>::quiet_NaN(), 1.0F});
  convert(rgb);
  const std::array expected{0.0F, 1.0F, 1.0F, 1.0F, 0.0F, 0.0F, 1.0F};
  for (const auto& plane : rgb)
    for (int x = 0; x < plane.width(); ++x) {
      EXPECT_NEAR(plane(x, 0), expected[static_cast<size_t>(x)], 1e-6) << x;
      EXPECT_GE(plane(x, 0), 0.0F);
      EXPECT_LE(plane(x, 0), 1.0F);
    }
}

TEST(Display, KeepsChannelsAndRowsApartAndTouchesNothingOutsideTheView) {
  std::array<Plane, 3> rgb{Plane(5, 3, 0.1F), Plane(9, 3, 0.5F),
                           Plane(5, 3, 0.9F)};  // the green plane's rows are longer
  rgb[0](2, 1) = 0.25F;
  const PlaneView green{rgb[1].row(0) + 2, 5, 3, rgb[1].view().stride};
  color::to_display(std::array<PlaneView, 3>{rgb[0].view(), green, rgb[2].view()});
  EXPECT_NEAR(rgb[0](2, 1), srgb_reference(0.25), 1e-5);
  EXPECT_NEAR(rgb[0](2, 2), srgb_reference(0.1), 1e-5);
  EXPECT_NEAR(rgb[1](2, 2), srgb_reference(0.5), 1e-5);
  EXPECT_NEAR(rgb[2](4, 0), srgb_reference(0.9), 1e-5);
  EXPECT_EQ(rgb[1](1, 1), 0.5F);
  EXPECT_EQ(rgb[1](7, 1), 0.5F);
}

}  // namespace
}  // namespace aftershade::tests
