#include "core/metrics/image_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/math/sampling.h"
#include "tests/metrics/metric_planes.h"

namespace aftershade::metrics {
namespace {

Plane noise(int width, int height, uint32_t seed) {
  Plane plane(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      plane(x, y) = unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), seed));
  return plane;
}

TEST(Differences, AreThoseComputedByHand) {
  const Plane a = plane_of(2, {1, 2, 3, 4}), b = plane_of(2, {1, 0, 4, 4});  // differences 0, 2, -1, 0
  EXPECT_DOUBLE_EQ(rmse(a, b), std::sqrt(5.0 / 4));
  EXPECT_DOUBLE_EQ(mae(a, b), 0.75);
  EXPECT_DOUBLE_EQ(mean_error(a, b), 0.25);
  EXPECT_DOUBLE_EQ(mean_error(b, a), -0.25);
  EXPECT_DOUBLE_EQ(psnr(a, b), -10 * std::log10(1.25));
}

TEST(Differences, OfATenthIsTwentyDecibel) {
  const Plane a(7, 5, 0.5F), b(7, 5, 0.6F);
  EXPECT_NEAR(psnr(a, b), 20, 1e-5);
  EXPECT_EQ(psnr(a, a), std::numeric_limits<double>::infinity());
}

TEST(Differences, CountOnlyMaskedAndFinitePixels) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const Plane a = plane_of(5, {1, nan, 3, 4, 9}), b = plane_of(5, {0, 0, infinity, 2, 0}),
              mask = plane_of(5, {1, 1, 1, 1, 0});
  EXPECT_DOUBLE_EQ(mae(a, b, mask), 1.5);
  EXPECT_DOUBLE_EQ(mae(a, b), 4);
}

TEST(Differences, OfNothingAreNoNumber) {
  const Plane a(3, 2), other(2, 3), none(3, 2, 0);
  EXPECT_TRUE(std::isnan(rmse(a, a, none)));
  EXPECT_TRUE(std::isnan(mae(a, other)));
  EXPECT_TRUE(std::isnan(correlation(a, a, other)));
  EXPECT_TRUE(std::isnan(ssim(a, other)));
  EXPECT_TRUE(std::isnan(display_psnr({a, a, a}, {other, other, other})));
}

TEST(Correlation, IsThatComputedByHand) {
  const Plane a = plane_of(4, {1, 2, 3, 4}), twice = plane_of(4, {2, 4, 6, 8}), down = plane_of(4, {4, 3, 2, 1});
  EXPECT_DOUBLE_EQ(correlation(a, twice), 1);
  EXPECT_DOUBLE_EQ(correlation(a, down), -1);
  // Deviations -1.5 -0.5 0.5 1.5 and -0.5 0.5 -0.5 0.5: 1 / sqrt(5 * 1).
  EXPECT_NEAR(correlation(a, plane_of(4, {0, 1, 0, 1})), 1 / std::sqrt(5.0), 1e-15);
  EXPECT_TRUE(std::isnan(correlation(a, Plane(4, 1, 2))));
}

TEST(DisplayPsnr, ClipsAndAppliesGamma) {
  const Plane white(3, 3, 1), bright(3, 3, 50), black(3, 3, 0), below(3, 3, -2), grey(3, 3, 0.25F);
  EXPECT_EQ(display_psnr({white, white, black}, {bright, white, below}), std::numeric_limits<double>::infinity());
  const double difference = 1 - std::pow(0.25, 1 / 2.2);
  EXPECT_NEAR(display_psnr({white, white, white}, {white, white, grey}), -10 * std::log10(difference * difference / 3),
              1e-12);
}

/// Wang et al. 2004 with the window of every pixel summed straight.
double naive_ssim(const Plane& a, const Plane& b) {
  double total = 0;
  int count = 0;
  for (int y = 5; y + 5 < a.height(); ++y)
    for (int x = 5; x + 5 < a.width(); ++x) {
      double sum = 0, ma = 0, mb = 0, va = 0, vb = 0, vab = 0;
      const auto each = [&](auto&& visit) {
        for (int j = -5; j <= 5; ++j)
          for (int i = -5; i <= 5; ++i)
            visit(std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5)), double{a(x + i, y + j)}, double{b(x + i, y + j)});
      };
      each([&](double w, double, double) { sum += w; });
      each([&](double w, double p, double q) { ma += w / sum * p, mb += w / sum * q; });
      each([&](double w, double p, double q) {
        va += w / sum * (p - ma) * (p - ma);
        vb += w / sum * (q - mb) * (q - mb);
        vab += w / sum * (p - ma) * (q - mb);
      });
      total += (2 * ma * mb + 1e-4) * (2 * vab + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
      ++count;
    }
  return total / count;
}

TEST(Ssim, EqualsItsNaiveTwin) {
  const Plane a = noise(31, 23, 1);
  Plane b = noise(31, 23, 2);
  for (int y = 0; y < b.height(); ++y)
    for (int x = 0; x < b.width(); ++x) b(x, y) = 0.7F * a(x, y) + 0.3F * b(x, y);
  const double expected = naive_ssim(a, b);
  EXPECT_NEAR(ssim(a, b), expected, 1e-12);
  EXPECT_GT(expected, 0.3);
  EXPECT_LT(expected, 0.99);
}

TEST(Ssim, OfConstantImagesIsTheLuminanceTerm) {
  const Plane a(16, 16, 0.5F), b(16, 16, 0.25F);
  EXPECT_NEAR(ssim(a, b), (2 * 0.125 + 1e-4) / (0.3125 + 1e-4), 1e-12);
  EXPECT_DOUBLE_EQ(ssim(a, a), 1);
  EXPECT_TRUE(std::isnan(ssim(Plane(10, 30), Plane(10, 30)))) << "no window fits";
}

TEST(Ssim, CountsMaskedPixelsOnly) {
  const Plane a = noise(40, 24, 3);
  Plane b = copy_of(a), left(40, 24);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) {
      if (x >= 25) b(x, y) = 0;
      left(x, y) = x < 20 ? 1 : 0;
    }
  EXPECT_NEAR(ssim(a, b, left), 1, 1e-12);
  EXPECT_LT(ssim(a, b), 0.8);
}

}  // namespace
}  // namespace aftershade::metrics
