// Records on every SIMD target: what gathers and single stores give.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/simd/lane_records_test.cpp"  // this file, compiled once a SIMD target
#include <hwy/foreach_target.h>

#include <array>
#include <vector>

#include "core/simd/records.h"
#include "core/simd/targets.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::tests::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// Of every lane the four values of a record, then the eight of a long one, value by value.
std::vector<float> loaded(const float* base, int step) {
  const Int index = iota(0) * Int(step);
  const Quad q = load_records(base, index);
  const auto [same, next] = load_long_records(base, index);
  std::vector<float> out;
  for (const Float& value : {q.a, q.b, q.c, q.d, same.a, same.b, same.c, same.d, next.a, next.b, next.c, next.d}) {
    out.resize(out.size() + kLanes);
    store(out.data() + out.size() - kLanes, value);
  }
  return out;
}

int store_in_steps(float* base, int stride) {
  const Float lane = to_float(iota(0));
  store_records(base, stride, {lane, lane + 100.0F, lane + 200.0F, lane + 300.0F});
  return kLanes;
}

}  // namespace aftershade::tests::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

namespace aftershade::tests {
namespace {

HWY_EXPORT(loaded);
HWY_EXPORT(store_in_steps);

class Records : public testing::Test {
 protected:
  ~Records() override { lanes::force_target(lanes::targets().front()); }
};

TEST_F(Records, AreReadFromAnyPlace) {
  std::vector<float> memory(500);
  for (size_t i = 0; i < memory.size(); ++i) memory[i] = static_cast<float>(i);
  for (const std::string& target : lanes::targets())
    for (const int step : {-7, 0, 1, 6, 8, 13}) {
      lanes::force_target(target);
      const int first = step < 0 ? 200 : 3;
      const std::vector<float> got = HWY_DYNAMIC_DISPATCH(loaded)(memory.data() + first, step);
      constexpr int kParts[]{0, 1, 2, 3, 0, 1, 2, 3, 4, 5, 6, 7};
      const int lane_count = static_cast<int>(got.size()) / 12;
      for (int row = 0; row < 12; ++row)
        for (int lane = 0; lane < lane_count; ++lane)
          EXPECT_EQ(got[static_cast<size_t>(row * lane_count + lane)],
                    static_cast<float>(first + lane * step + kParts[row]))
              << target << ", step " << step;
    }
}

TEST_F(Records, AreWrittenSideBySideAndNowhereElse) {
  for (const std::string& target : lanes::targets())
    for (const int stride : {4, 6, 8, 11}) {
      lanes::force_target(target);
      std::vector<float> memory(300, -1.0F), want = memory;
      const int lane_count = HWY_DYNAMIC_DISPATCH(store_in_steps)(memory.data() + 5, stride);
      for (int lane = 0; lane < lane_count; ++lane)
        for (int part = 0; part < 4; ++part)
          want[static_cast<size_t>(5 + lane * stride + part)] = static_cast<float>(lane + 100 * part);
      EXPECT_EQ(memory, want) << target << ", stride " << stride;
    }
}

}  // namespace
}  // namespace aftershade::tests
#endif
