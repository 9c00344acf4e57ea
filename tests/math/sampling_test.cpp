#include "core/math/sampling.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>

namespace aftershade {
namespace {

TEST(MixBits, FlipsHalfTheBitsForEveryInputBit) {
  for (int bit = 0; bit < 32; ++bit) {
    double flipped = 0;
    constexpr uint32_t kCount = 2000;
    for (uint32_t i = 0; i < kCount; ++i)
      flipped += std::popcount(mix_bits(i * 977) ^ mix_bits((i * 977) ^ (1U << bit)));
    EXPECT_NEAR(flipped / kCount, 16, 0.6) << "bit " << bit;
  }
}

TEST(HashCounters, DependsOnEveryCounter) {
  const uint32_t base = hash_counters(3, 5, 7, 11);
  for (const uint32_t other : {hash_counters(4, 5, 7, 11), hash_counters(3, 6, 7, 11), hash_counters(3, 5, 8, 11),
                               hash_counters(3, 5, 7, 12), hash_counters(5, 3, 7, 11), hash_counters(3, 7, 5, 11)})
    EXPECT_NE(base, other);
  static_assert(hash_counters(1, 2) == hash_counters(1, 2, 0, 0));
}

TEST(UnitFloat, IsBelowOneAndUniform) {
  EXPECT_EQ(unit_float(0), 0.0F);
  EXPECT_LT(unit_float(0xffffffffU), 1.0F);
  EXPECT_EQ(unit_float(0x80000000U), 0.5F);
  constexpr int kBins = 16, kSide = 400;
  int counts[kBins] = {};
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x) ++counts[static_cast<int>(unit_float(hash_counters(x, y)) * kBins)];
  double chi2 = 0;
  constexpr double kExpected = kSide * kSide / static_cast<double>(kBins);
  for (const int count : counts) chi2 += (count - kExpected) * (count - kExpected) / kExpected;
  EXPECT_LT(chi2, 37.7);  // 15 degrees of freedom, p = 0.001
}

TEST(UnitFloat, NeighboursAreUncorrelated) {
  double sum = 0;
  constexpr uint32_t kSide = 300;
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x)
      sum += (unit_float(hash_counters(x, y)) - 0.5) * (unit_float(hash_counters(x + 1, y)) - 0.5) * 12;
  EXPECT_NEAR(sum / (kSide * kSide), 0, 4.0 / kSide);  // four standard deviations
}

TEST(Bayer, HasSixteenValuesAndEvenBlocks) {
  std::set<float> values(kBayer4x4.begin(), kBayer4x4.end());
  EXPECT_EQ(values.size(), 16U);
  EXPECT_EQ(*values.begin(), 0.5F / 16);
  EXPECT_EQ(*values.rbegin(), 15.5F / 16);
  for (size_t y = 0; y < 4; ++y)
    for (size_t x = 0; x < 4; ++x) {
      std::set<int> quarters;  // wrapping, as the pattern tiles
      for (const size_t i : {y * 4 + x, y * 4 + (x + 1) % 4, (y + 1) % 4 * 4 + x, (y + 1) % 4 * 4 + (x + 1) % 4})
        quarters.insert(static_cast<int>(kBayer4x4[i] * 4));
      EXPECT_EQ(quarters.size(), 4U) << x << "," << y;
    }
}

}  // namespace
}  // namespace aftershade
