#include "core/ao/tap_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>

namespace aftershade::tests {
namespace {

/// The definition, by counting: boxes whose corners lie at, or just below, the points' coordinates.
double counted_discrepancy(int taps, int turns) {
  std::vector<double> xs, ys;
  for (int i = 0; i < taps; ++i) {
    xs.push_back((i + 0.5) / taps);
    ys.push_back(std::fmod((i + 0.5) / taps * turns, 1.0));
  }
  std::vector<double> edges_x = xs, edges_y = ys;
  edges_x.push_back(1);
  edges_y.push_back(1);
  double worst = 0;
  for (const double a : edges_x)
    for (const double b : edges_y) {
      int closed = 0, open = 0;
      for (size_t i = 0; i < xs.size(); ++i) {
        closed += xs[i] <= a && ys[i] <= b;
        open += xs[i] < a && ys[i] < b;
      }
      worst = std::max({worst, closed / static_cast<double>(taps) - a * b, a * b - open / static_cast<double>(taps)});
    }
  return worst;
}

TEST(TapPattern, TurnsHaveTheLeastStarDiscrepancy) {
  for (const int taps : {3, 4, 5, 8, 9, 16, 19, 32, 36}) {
    const int turns = ao::spiral_turns(taps);
    EXPECT_NEAR(ao::star_discrepancy(taps, turns), counted_discrepancy(taps, turns), 1e-12) << taps;
    EXPECT_EQ(std::gcd(taps, turns), 1);
    for (int other = 1; other < taps; ++other)
      EXPECT_TRUE(std::gcd(taps, other) != 1 ||
                  counted_discrepancy(taps, other) >= counted_discrepancy(taps, turns) - 1e-12);
    std::printf("%d taps: %d turns, star discrepancy %.4f\n", taps, turns, ao::star_discrepancy(taps, turns));
  }
}

TEST(TapPattern, LargeSpiralsAreEvenToo) {
  for (const int taps : {65, 128, 512}) {
    EXPECT_EQ(std::gcd(taps, ao::spiral_turns(taps)), 1);
    EXPECT_LT(ao::star_discrepancy(taps, ao::spiral_turns(taps)), 2.0 * std::log(taps) / taps) << taps;
  }
}

TEST(TapPattern, SpiralIsLinearInRadiusWithUnitVectors) {
  for (const int taps : {1, 2, 9, 36}) {
    const auto spiral = ao::spiral_taps(taps);
    ASSERT_EQ(spiral.size(), static_cast<size_t>(taps));
    const int turns = ao::spiral_turns(taps);
    for (int i = 0; i < taps; ++i) {
      const ao::Tap& tap = spiral[static_cast<size_t>(i)];
      const double alpha = (i + 0.5) / taps, angle = 2 * std::numbers::pi * alpha * turns;
      EXPECT_NEAR(tap.radius, alpha, 1e-7);
      EXPECT_NEAR(tap.x, std::cos(angle), 1e-6);
      EXPECT_NEAR(tap.y, std::sin(angle), 1e-6);
    }
  }
}

TEST(TapPattern, MirroredTapsComeInOppositePairs) {
  for (const int taps : {1, 4, 7, 16}) {
    const auto mirrored = ao::mirrored_taps(taps);
    ASSERT_EQ(mirrored.size(), static_cast<size_t>((taps + 1) / 2 * 2));
    for (size_t i = 0; i < mirrored.size(); i += 2) {
      EXPECT_EQ(mirrored[i].radius, mirrored[i + 1].radius);
      EXPECT_EQ(mirrored[i].x, -mirrored[i + 1].x);
      EXPECT_EQ(mirrored[i].y, -mirrored[i + 1].y);
    }
  }
  const auto four = ao::mirrored_taps(4);
  EXPECT_NEAR(four[0].x * four[2].x + four[0].y * four[2].y, 0, 1e-6) << "two pairs cross at right angles";
}

}  // namespace
}  // namespace aftershade::tests
