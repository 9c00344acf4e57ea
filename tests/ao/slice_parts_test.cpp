#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <cmath>

#include "core/ao/slice_ao_kernel.h"
#include "core/math/sampling.h"

/// What slice-ao is put together from.
namespace aftershade::tests {
namespace {

TEST(SliceTurns, RepeatAfterTheNoiseTile) {
  for (const ao::NoiseTile tile : {ao::NoiseTile::four, ao::NoiseTile::three}) {
    const int size = tile == ao::NoiseTile::three ? 3 : 4;
    const ao::SliceTurns turns(tile, 2, 0.3);
    EXPECT_EQ(turns.cell(-1), size - 1);
    EXPECT_EQ(turns.cell(size), 0);
    std::vector<float> offsets;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        offsets.push_back(turns.offsets(y)[x]);
        EXPECT_EQ(turns.offsets(y)[x], turns.offsets(y)[x + size]);
        EXPECT_EQ(turns.cos(y, 1)[x], turns.cos(y, 1)[x + size]);
        EXPECT_NEAR(turns.cos(y, 0)[x], turns.sin(y, 1)[x], 1e-6) << "a right angle apart";
      }
    std::sort(offsets.begin(), offsets.end());
    EXPECT_EQ(std::unique(offsets.begin(), offsets.end()), offsets.end());
    EXPECT_TRUE(offsets.front() >= 0 && offsets.back() < 1);
  }
}

TEST(IntervalUnion, CoversWhatABitmaskCovers) {
  constexpr float kSectors = 2048;
  for (uint32_t trial = 0; trial < 300; ++trial) {
    std::bitset<4096> mask;
    ao::HWY_NAMESPACE::Intervals list;
    for (uint32_t i = 0; i < 1 + trial % 40; ++i) {
      const size_t from = hash_counters(trial, i) % 4000,
                   to = from + 1 + hash_counters(trial, i, 7) % (trial % 3 == 0 ? 9 : 96);
      for (size_t bit = from; bit < std::min<size_t>(to, 4096); ++bit) mask.set(bit);
      list.unite(
          {static_cast<float>(from) / kSectors - 1, static_cast<float>(std::min<size_t>(to, 4096)) / kSectors - 1});
      if (i % 3 == 0) list.unite(ao::HWY_NAMESPACE::no_interval());
    }
    float measure = 0;
    std::vector<std::pair<float, float>> sorted;
    for (int i = 0; i < list.size(); ++i) {
      measure += list[i].to.v - list[i].from.v;
      if (list[i].from.v <= 1) sorted.emplace_back(list[i].from.v, list[i].to.v);
    }
    std::sort(sorted.begin(), sorted.end());
    for (size_t i = 1; i < sorted.size(); ++i) EXPECT_LT(sorted[i - 1].second, sorted[i].first);
    ASSERT_EQ(static_cast<size_t>(measure * kSectors), mask.count()) << trial;
  }
}

TEST(SliceArc, MatchesQuadratureAndItsSegmentTheLibrary) {
  using ao::HWY_NAMESPACE::segment_area;
  for (int i = -20000; i <= 20000; ++i) {
    const float cosine = static_cast<float>(i) / 20000;
    const double angle = std::acos(static_cast<double>(cosine));
    ASSERT_NEAR(static_cast<double>(segment_area(cosine).v), angle - std::sin(angle) * std::cos(angle), 5e-7) << cosine;
  }
  EXPECT_EQ(segment_area(1.0000002F).v, 0);
  for (const double gamma : {-1.2, -0.3, 0.0, 0.7, 1.5}) {
    const ao::HWY_NAMESPACE::Arc arc{static_cast<float>(std::cos(gamma)), static_cast<float>(std::sin(gamma))};
    double sum = 0;
    const double end = gamma + 1.5707963267948966;
    for (int i = 0; i < 2000; ++i) {
      const double t = end * (i + 0.5) / 2000;
      sum += std::cos(t - gamma) * std::sin(t) * end / 2000;
      if (i % 100 == 99) {
        ao::HWY_NAMESPACE::Intervals list;
        list.unite({-1.0F, -static_cast<float>(std::cos(end * (i + 1) / 2000))});
        ASSERT_NEAR(static_cast<double>(arc.hidden(list).v), sum, 2e-6) << gamma;
      }
    }
  }
}

}  // namespace
}  // namespace aftershade::tests
