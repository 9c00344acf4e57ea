#include "core/metrics/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/math/sampling.h"
#include "core/metrics/flip_filters.h"
#include "core/metrics/temporal_metrics.h"
#include "core/parallel/rows.h"
#include "tests/metrics/flip_reference.h"

namespace aftershade::metrics {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

struct Picture {
  std::array<Plane, 3> planes;
  Picture(int width, int height, naive::Color color) {
    for (size_t c = 0; c < 3; ++c) planes[c] = Plane(width, height, static_cast<float>(color[c]));
  }
  operator Rgb() const { return {planes[0], planes[1], planes[2]}; }
};

double mean(const Plane& errors) { return distribution(std::vector<ConstPlaneView>{errors}).mean; }
double uniform_error(const naive::Color& a, const naive::Color& b) {
  const Plane errors = ldr_flip(Picture(24, 16, a), Picture(24, 16, b));
  for (int y = 0; y < errors.height(); ++y)
    for (int x = 0; x < errors.width(); ++x)
      EXPECT_NEAR(errors(x, y), errors(0, 0), 1e-5) << "even surfaces, borders included";
  return static_cast<double>(errors(0, 0));
}

/// Noise, a bright disk and a coloured half, so that every channel and both detectors answer; 0..brightness.
Picture busy(int width, int height, uint32_t seed, double brightness = 1) {
  Picture picture(width, height, {0, 0, 0});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t c = 0; c < 3; ++c) {
        const uint32_t place = static_cast<uint32_t>(y * width + x) * 3 + static_cast<uint32_t>(c);
        double value = 0.2 * static_cast<double>(unit_float(hash_counters(place, seed)));
        if (std::hypot(x - 0.4 * width, y - 0.5 * height) < 0.2 * height) value += 0.4;
        if (2 * x > width && c == 2) value += 0.3 + 0.01 * seed;
        picture.planes[c](x, y) = static_cast<float>(brightness * value);
      }
  return picture;
}

TEST(LdrFlip, OfEvenSurfacesIsTheirColourDifference) {
  // Black and white differ by 100 in lightness alone: 100^0.7 = 25.119. Green is L 87.735, a -86.183, b 83.179, blue L
  // 32.297, a 79.188, b -107.860; with chroma times L/100 they differ by 55.438 + 147.86 = 203.30: 203.30^0.7 = 41.28.
  // 25.119 lies above 0.4 of that: 0.95 + 0.05 (25.119 - 16.511) / (41.28 - 16.511) = 0.96738.
  EXPECT_NEAR(uniform_error({0, 0, 0}, {1, 1, 1}), 0.96738, 2e-5);
  EXPECT_NEAR(uniform_error({0, 1, 0}, {0, 0, 1}), 1, 1e-5) << "the pair that is 1";
  // Luminance 0.18 is L 49.496, 0.2 is L 51.837: 2.3418^0.7 / 16.511 * 0.95 = 0.10439.
  EXPECT_NEAR(uniform_error({0.18, 0.18, 0.18}, {0.2, 0.2, 0.2}), 0.10439, 1e-4);
  for (const auto& [a, b] : {std::pair<naive::Color, naive::Color>{{0.5, 0.1, 0.1}, {0.1, 0.1, 0.5}},
                             {{0.9, 0.9, 0.1}, {0.9, 0.1, 0.9}},
                             {{0.001, 0.002, 0.001}, {0.002, 0.001, 0.001}}})
    EXPECT_NEAR(uniform_error(a, b), naive::color_error(a, b), 5e-4);
}

TEST(LdrFlip, IsTheUnseparatedFormulaOfThePaper) {
  for (const double pixels_per_degree : {67.0, 25.0}) {
    constexpr int width = 40, height = 28;
    const Picture a = busy(width, height, 1), b = busy(width, height, 9);
    const auto naive_image = [&](const Picture& p) {
      naive::Image image{width, height, {}};
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          image.pixels.push_back({p.planes[0](x, y), p.planes[1](x, y), p.planes[2](x, y)});
      return image;
    };
    const Plane errors = ldr_flip(a, b, pixels_per_degree);
    const std::vector<double> expected = naive::ldr_flip(naive_image(a), naive_image(b), pixels_per_degree);
    double sum = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double here = expected[static_cast<size_t>(y * width + x)];
        ASSERT_NEAR(errors(x, y), here, 1e-4) << x << "," << y;
        sum += here / (width * height);
      }
    EXPECT_NEAR(mean(errors), sum, 1e-6);
    EXPECT_GT(mean(errors), 0.05);
  }
}

TEST(LdrFlip, OfEqualImagesIsZeroAndSwappingThemChangesNothing) {
  const Picture a = busy(48, 32, 1), b = busy(48, 32, 4);
  const Plane same = ldr_flip(a, a), ab = ldr_flip(a, b), ba = ldr_flip(b, a);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 48; ++x) {
      EXPECT_EQ(same(x, y), 0);
      EXPECT_EQ(ab(x, y), ba(x, y));
      EXPECT_GE(ab(x, y), 0);
      EXPECT_LE(ab(x, y), 1);
    }
}

TEST(LdrFlip, OfBlackImagesIsZeroAndOfBlackAndWhiteTheSameBothWays) {
  EXPECT_EQ(uniform_error({0, 0, 0}, {0, 0, 0}), 0);
  EXPECT_EQ(uniform_error({0, 0, 0}, {1, 1, 1}), uniform_error({1, 1, 1}, {0, 0, 0}));
}

TEST(LdrFlip, GrowsWithTheDifferenceAndWithItsSizeOnTheRetina) {
  double before = 0;
  for (const double grey : {0.21, 0.25, 0.4, 0.7, 1.0}) {
    const double error = uniform_error({0.2, 0.2, 0.2}, {grey, grey, grey});
    EXPECT_GT(error, before);
    before = error;
  }
  // One wrong pixel is seen the less, the more pixels fit in a degree.
  Picture wrong(64, 64, {0.5, 0.5, 0.5});
  for (Plane& plane : wrong.planes) plane(32, 32) = 1;
  const Picture right(64, 64, {0.5, 0.5, 0.5});
  const auto at_pixel = [&](double pixels_per_degree) { return ldr_flip(wrong, right, pixels_per_degree)(32, 32); };
  EXPECT_GT(at_pixel(20), at_pixel(67));
  EXPECT_GT(at_pixel(67), at_pixel(200));
}

TEST(LdrFlip, ClipsWhatNoDisplayShows) {
  EXPECT_EQ(uniform_error({1, 1, 1}, {7, 7, 7}), 0);
  EXPECT_EQ(uniform_error({0, 0, 0}, {-3, -1, 0}), 0);
}

TEST(FlipKernels, AreThoseOfThePaper) {
  const FlipKernels kernels = flip_kernels(67);
  const auto sum = [](const Kernel& kernel, bool positive) {
    double total = 0;
    for (const float w : kernel) total += (w > 0) == positive ? static_cast<double>(w) : 0;
    return total;
  };
  EXPECT_EQ(kernels.achromatic.size(), 21U) << "3 sigma of b = 0.04: 9.05 pixels";
  EXPECT_EQ(kernels.edge.size(), 19U) << "3 sigma of half of 0.082 degrees: 8.24 pixels";
  for (const Kernel* kernel : {&kernels.achromatic, &kernels.red_green, &kernels.blue_yellow_wide,
                               &kernels.blue_yellow_narrow, &kernels.smooth, &kernels.edge, &kernels.point})
    EXPECT_NEAR(sum(*kernel, true), 1, 1e-6);
  for (const Kernel* kernel : {&kernels.edge, &kernels.point}) EXPECT_NEAR(sum(*kernel, false), -1, 1e-6);
  // Neighbour over centre is exp(-(pi / 67)^2 / b).
  EXPECT_NEAR(kernels.achromatic[11] / kernels.achromatic[10], std::exp(-std::pow(M_PI / 67, 2) / 0.0047), 1e-6);
  EXPECT_NEAR(kernels.red_green[11] / kernels.red_green[10], std::exp(-std::pow(M_PI / 67, 2) / 0.0053), 1e-6);
  // The volume of a sqrt(pi / b) exp(...) is proportional to a sqrt(b) in the plane: 6.82 and 2.135.
  EXPECT_NEAR(kernels.wide_share, 6.82 / (6.82 + 2.1345), 0.003);
}

TEST(FlipExposures, BringTheBrightestAndTheMedianToTheSameTone) {
  // 0.9036 x^2 + 0.018 x over 0.8748 x^2 + 0.354 x + 0.14 is 0.85 at x = 2.1189 (0.16002 x^2 - 0.2829 x - 0.119 = 0).
  Picture picture(5, 1, {0.5, 0.5, 0.5});
  for (Plane& plane : picture.planes) plane(0, 0) = 8, plane(1, 0) = 0;
  const Exposures exposures = flip_exposures(picture);
  EXPECT_NEAR(exposures.start, std::log2(2.1189 / 8), 1e-3);
  EXPECT_NEAR(exposures.stop, std::log2(2.1189 / 0.5), 1e-3);
  EXPECT_EQ(exposures.count, 4);
  EXPECT_EQ(exposures.at(0), exposures.start);
  EXPECT_DOUBLE_EQ(exposures.at(3), exposures.stop);
  EXPECT_EQ(flip_exposures(Picture(4, 4, {1, 1, 1})).count, 2) << "never fewer than two";
}

TEST(FlipExposures, HaveValuesForBlackFrames) {
  const Exposures black = flip_exposures(Picture(4, 4, {0, 0, 0}));
  EXPECT_EQ(black.start, 0);
  EXPECT_EQ(black.stop, 0);
  EXPECT_EQ(black.count, 1);
  Picture lamp(8, 8, {0, 0, 0});  // three pixels have light; their median is 1
  const float lights[] = {4, 1, 0.25F};
  for (Plane& plane : lamp.planes)
    for (int i = 0; i < 3; ++i) plane(i, 0) = lights[i];
  const Exposures exposures = flip_exposures(lamp);
  EXPECT_NEAR(exposures.stop - exposures.start, 2, 1e-6);
  Picture dim(8, 8, {1e-30, 1e-30, 1e-30});
  for (Plane& plane : dim.planes) plane(0, 0) = 1000;
  EXPECT_EQ(flip_exposures(dim).count, 32);
  Picture broken(4, 4, {kNan, 0, 0});
  EXPECT_EQ(flip_exposures(broken).count, 1) << "nothing is known of it";
}

TEST(HdrFlip, IsTheGreatestLdrFlipOverTheExposures) {
  const Picture a = busy(40, 24, 1, 6), b = busy(40, 24, 7, 6);
  const Plane errors = hdr_flip(a, b);
  const Exposures exposures = flip_exposures(b);
  ASSERT_GE(exposures.count, 3);
  Plane greatest(40, 24);
  for (int i = 0; i < exposures.count; ++i) {
    const auto shown = [&](const Picture& p) {
      Picture out(40, 24, {0, 0, 0});
      for (size_t c = 0; c < 3; ++c)
        for (int y = 0; y < 24; ++y)
          for (int x = 0; x < 40; ++x) {
            const double v = 0.6 * std::exp2(exposures.at(i)) * static_cast<double>(p.planes[c](x, y));
            // Narkowicz 2016, clipped.
            const double tone = v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14);
            out.planes[c](x, y) = static_cast<float>(std::min(tone, 1.0));
          }
      return out;
    };
    const Plane ldr = ldr_flip(shown(a), shown(b));
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 40; ++x) greatest(x, y) = std::max(greatest(x, y), ldr(x, y));
  }
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) ASSERT_NEAR(errors(x, y), greatest(x, y), 1e-4);
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfLight) {
  const double once = mean(hdr_flip(busy(32, 24, 1), busy(32, 24, 3)));
  const double brighter = mean(hdr_flip(busy(32, 24, 1, 1024), busy(32, 24, 3, 1024)));
  EXPECT_NEAR(once, brighter, 1e-6);
  EXPECT_GT(once, 0.05);
}

TEST(HdrFlip, OfEqualAndOfBlackImagesIsZeroAndOfLightInTheDarkIsNot) {
  EXPECT_EQ(mean(hdr_flip(busy(32, 24, 1, 50), busy(32, 24, 1, 50))), 0);
  EXPECT_EQ(mean(hdr_flip(Picture(16, 16, {0, 0, 0}), Picture(16, 16, {0, 0, 0}))), 0);
  EXPECT_GT(mean(hdr_flip(Picture(16, 16, {0.2, 0.2, 0.2}), Picture(16, 16, {0, 0, 0}))), 0.5);
}

TEST(HdrFlip, LeavesOutWhatIsNotFiniteAndItsNeighboursSeeBlackInBoth) {
  const auto with = [](uint32_t seed, float value) {
    Picture picture = busy(32, 24, seed);
    for (Plane& plane : picture.planes) plane(10, 8) = value;
    return picture;
  };
  Picture green_is_broken = busy(32, 24, 1);
  green_is_broken.planes[1](10, 8) = kNan;
  const Plane errors = ldr_flip(green_is_broken, busy(32, 24, 3)), dark = ldr_flip(with(1, 0), with(3, 0));
  EXPECT_TRUE(std::isnan(errors(10, 8)));
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x)
      if (x != 10 || y != 8) {
        ASSERT_EQ(errors(x, y), dark(x, y));
      }
  EXPECT_EQ(mean(hdr_flip(with(1, kNan), with(1, kInf))), 0);
  EXPECT_TRUE(std::isnan(mean(hdr_flip(Picture(4, 4, {kNan, kNan, kNan}), Picture(4, 4, {0, 0, 0})))));
  EXPECT_TRUE(std::isnan(mean(hdr_flip(Picture(4, 4, {0, 0, 0}), Picture(4, 5, {0, 0, 0}))))) << "sizes";
}

TEST(HdrFlip, DoesNotDependOnThreads) {
  const Picture a = busy(64, 48, 1, 3), b = busy(64, 48, 2, 3);
  set_thread_count(1);
  const Plane one = hdr_flip(a, b);
  set_thread_count(0);
  const Plane all = hdr_flip(a, b);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) ASSERT_EQ(one(x, y), all(x, y));
}

}  // namespace
}  // namespace aftershade::metrics
