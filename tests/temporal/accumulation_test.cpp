#include "core/temporal/accumulation.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/temporal/accumulation_kernel.h"
#include "tests/temporal/temporal_helpers.h"

namespace aftershade::tests {
namespace {

using temporal::accumulate;
using temporal::AccumulationHistory;
using temporal::look_up;
using temporal::Past;
using temporal::Reprojected;

constexpr int kWidth = 40, kHeight = 24;

/// Twin of look_up and accumulate for one pixel, in double (algorithms 6 and 7.3).
struct Cell {
  double ao, weight;
};
Cell twin(const AccumulationHistory& h, double x, double y, double compared, double epsilon, Cell added, double cap) {
  double ao = 0, weight = 0, sum = 0;
  for (int dy = 0; dy < 2; ++dy)
    for (int dx = 0; dx < 2; ++dx) {
      const int i = static_cast<int>(std::floor(x - 0.5)) + dx - h.window.min_x;
      const int j = static_cast<int>(std::floor(y - 0.5)) + dy - h.window.min_y;
      if (std::isnan(x) || i < 0 || j < 0 || i >= h.ao.width() || j >= h.ao.height()) continue;
      if (!(std::abs(1 - compared / h.depth(i, j)) < epsilon)) continue;
      const double w = (1 - std::abs(x - 0.5 - h.window.min_x - i)) * (1 - std::abs(y - 0.5 - h.window.min_y - j));
      ao += w * h.ao(i, j), weight += w * h.weight(i, j), sum += w;
    }
  if (!(sum >= 0.25)) return {added.ao, std::min(added.weight, cap)};
  const double n = weight / sum, k = added.weight;
  return {(n * ao / sum + k * added.ao) / (n + k), std::min(n + k, cap)};
}

AccumulationHistory history_of(int width, int height, int min_x, int min_y) {
  return {
      window_of(width, height, min_x, min_y), plane_of(width, height, [](int x, int y) { return noise(x, y, 1); }),
      plane_of(width, height, [](int x, int y) { return noise(x, y, 2) < 0.1F ? 0.0F : noise(x / 6, y / 6, 3) + 2; }),
      plane_of(width, height, [](int x, int y) { return 1 + 20 * noise(x, y, 4); }),
      plane_of(width, height, [](int x, int y) { return static_cast<float>(x + 100 * y); })};
}

TEST(Accumulation, AgreesWithTheTwin) {
  const AccumulationHistory before = history_of(kWidth + 5, kHeight - 3, -4, 2);
  Reprojected where{
      plane_of(kWidth, kHeight, [](int x, int y) { return static_cast<float>(x) + 3 * noise(x, y, 5) - 1; }),
      plane_of(kWidth, kHeight, [](int x, int y) { return static_cast<float>(y) + 3 * noise(x, y, 6) - 1; }),
      plane_of(kWidth, kHeight, [](int x, int y) { return noise(x / 6, y / 6, 3) + 2 + 0.05F * noise(x, y, 7); })};
  for (int i = 0; i < 60; ++i) where.x((i * 7) % kWidth, (i * 5) % kHeight) = kNaN;
  const Plane ao = plane_of(kWidth, kHeight, [](int x, int y) { return noise(x, y, 8); });
  const Plane k = plane_of(kWidth, kHeight, [](int x, int y) { return noise(x, y, 9) < 0.5F ? 8.0F : 32.0F; });
  const Plane depth(kWidth, kHeight, 3);
  const Past past = look_up(before, where, where.depth, 0.1F);
  const AccumulationHistory now = accumulate(past, {ao, k, depth, window_of(kWidth, kHeight)}, 35);
  int misses = 0, capped = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const Cell exact = twin(before, where.x(x, y), where.y(x, y), where.depth(x, y), 0.1F, {ao(x, y), k(x, y)}, 35);
      ASSERT_NEAR(now.ao(x, y), exact.ao, 2e-6) << x << ' ' << y;
      ASSERT_NEAR(now.weight(x, y), exact.weight, 1e-4) << x << ' ' << y;
      misses += past.weight(x, y) == 0 ? 1 : 0;
      capped += exact.weight == 35 ? 1 : 0;
    }
  EXPECT_GT(misses, 60);
  EXPECT_LT(misses, kWidth * kHeight * 2 / 3);
  EXPECT_GT(capped, 20);
}

TEST(Accumulation, NextIsThatOfTheNearestPixel) {
  const AccumulationHistory before = history_of(kWidth, kHeight, 3, 5);
  const Reprojected where{Plane(1, 1, 10.9F), Plane(1, 1, 12.2F), Plane(1, 1, before.depth(7, 7))};
  EXPECT_EQ(look_up(before, where, where.depth, 1e9F).next(0, 0), 7 + 100 * 7);
}

TEST(Accumulation, NothingIsKnownAtFirst) {
  const Plane depth(3, 2, 4);
  const Past past = look_up({}, standing_still(depth, window_of(3, 2)), depth, 1e9F);
  EXPECT_EQ(past.weight(1, 1), 0);
  const AccumulationHistory now = accumulate(past, {Plane(3, 2, 0.3F), Plane(3, 2, 4), depth, window_of(3, 2)}, 29);
  EXPECT_EQ(now.ao(1, 1), 0.3F) << "this frame's AO alone, to the bit";
  EXPECT_EQ(now.weight(1, 1), 4);
}

/// Accumulates f(frame) on a still picture.
template <class F>
std::vector<double> still_sequence(int frames, float max_weight, F&& value) {
  const Plane depth(4, 4, 3);
  const auto where = standing_still(depth, window_of(4, 4));
  AccumulationHistory history;
  std::vector<double> out;
  for (int frame = 0; frame < frames; ++frame) {
    const Past past = look_up(history, where, where.depth, 0.02F);
    history = accumulate(past, {Plane(4, 4, value(frame)), Plane(4, 4, 1), depth, window_of(4, 4)}, max_weight);
    out.push_back(history.ao(2, 2));
  }
  return out;
}

TEST(Accumulation, IsAMeanUntilTheCapAndThenOnePartInThirty) {
  const auto step = [](int frame) { return frame < 1 ? 0.0F : 1.0F; };
  const std::vector<double> ao = still_sequence(60, 29, step);
  for (int frame = 0; frame < 30; ++frame) EXPECT_NEAR(ao[static_cast<size_t>(frame)], frame / (frame + 1.0), 1e-5);
  double ema = 29.0 / 30;
  for (size_t frame = 30; frame < 60; ++frame) {
    ema = ema * 29 / 30 + 1.0 / 30;  // seed 003
    EXPECT_NEAR(ao[frame], ema, 1e-5);
  }
}

TEST(Accumulation, AConstantStaysTheSameToTheBit) {
  for (const double ao : still_sequence(50, 29, [](int) { return 0.123456F; }))
    EXPECT_EQ(static_cast<float>(ao), 0.123456F);
}

TEST(Accumulation, ValuesThatAreNoNumbersCountAsOpen) {
  const Plane depth = plane_of(4, 1, [](int x, int) { return x == 0 ? kNaN : x == 1 ? kInf : x == 2 ? -1.0F : 5.0F; });
  const auto now = accumulate(look_up({}, standing_still(depth, window_of(4, 1)), depth, 1),
                              {Plane(4, 1, kNaN), Plane(4, 1, 1), depth, window_of(4, 1)}, 9);
  for (int x = 0; x < 4; ++x) {
    EXPECT_EQ(now.ao(x, 0), 1);
    EXPECT_EQ(now.depth(x, 0), x == 3 ? 5 : 0) << "background is stored as none";
  }
}

/// What the texture gives back, by whole digits.
double unorm_digits(double value) {
  const auto number = static_cast<int64_t>(value * 16777216);  // exact: a float in [0, 1)
  const auto channel = [](int64_t digit) { return std::floor(static_cast<double>(digit) / 256 * 255 + 0.5) / 255; };
  const double fine = std::min(1.0, std::floor(static_cast<double>(number % 256) / 256 * 255 + 0.5) / 255);
  return channel(number / 65536) + channel(number / 256 % 256) / 256 + fine / 65536;
}

TEST(LiteralPacking, LosesUpToTwoThousandthsInEightBitChannels) {
  double worst = 0, worst_in_float = 0;
  for (int i = 0; i < 1 << 20; ++i) {
    const float value = static_cast<float>(i) * 16 / 16777216.0F;
    float lanes_back[lanes::N_SCALAR::kLanes];
    lanes::N_SCALAR::store(lanes_back, temporal::N_SCALAR::through_24_bits(value));
    const double back = lanes_back[0];
    ASSERT_NEAR(back, unorm_digits(value), 1e-7) << value;
    worst = std::max(worst, std::abs(back - static_cast<double>(value)));
    // The same digits, in channels of float: packing itself is exact.
    const double fine = std::fmod(value * 65536.0, 1), middle = std::fmod(value * 256.0, 1), coarse = value;
    const double exact = fine / 65536 + (middle - fine / 256) / 256 + (coarse - middle / 256);
    worst_in_float = std::max(worst_in_float, std::abs(exact - static_cast<double>(value)));
  }
  std::printf("24-bit packing in 8-bit UNORM channels: error up to %.6f of the range; in float channels %.1e\n", worst,
              worst_in_float);
  EXPECT_NEAR(worst, 0.0020, 0.00005);  // algorithms 14, item 17
  EXPECT_LT(worst_in_float, 1e-12);
}

TEST(LiteralPacking, KeepsAoIn255StepsAndDepthAsAShareOfTheRange) {
  AccumulationHistory history = history_of(kWidth, kHeight, 0, 0);
  history.depth(0, 0) = 0;
  history.depth(1, 0) = 1000;
  const Plane ao = copy_of(history.ao), depth = copy_of(history.depth);
  temporal::pack_literally(history, 50);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_NEAR(history.ao(x, y), std::round(ao(x, y) * 255) / 255, 1e-6);
      ASSERT_NEAR(history.depth(x, y), std::min(depth(x, y), 50.0F), 50 * 0.0021);
    }
  EXPECT_EQ(history.depth(0, 0), 0) << "background stays background";
}

TEST(LiteralPacking, MakesAStrictDepthTestMiss) {
  // Digits of base 256 in 255 steps make all depths below half the range 1/255 too large.
  const Plane depth = plane_of(200, 1, [](int x, int) { return 1 + 0.2F * static_cast<float>(x); });
  const auto where = standing_still(depth, window_of(200, 1));
  const auto misses = [&](bool packed, float epsilon) {
    AccumulationHistory history =
        accumulate(look_up({}, where, depth, 1), {Plane(200, 1, 0.5F), Plane(200, 1, 1), depth, window_of(200, 1)}, 29);
    if (packed) temporal::pack_literally(history, 100);
    const Past past = look_up(history, where, where.depth, epsilon);
    int count = 0;
    for (int x = 0; x < 200; ++x) count += past.weight(x, 0) == 0 ? 1 : 0;
    return count;
  };
  EXPECT_EQ(misses(false, 0.0025F), 0);
  EXPECT_GT(misses(true, 0.0025F), 100);
  EXPECT_EQ(misses(true, 0.02F), 0);
}

}  // namespace
}  // namespace aftershade::tests
