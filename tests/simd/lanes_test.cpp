// Every operation of the lane layer on every SIMD target of this machine gives what one lane gives.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/simd/lanes_test.cpp"  // this file, compiled once a SIMD target
#include <hwy/foreach_target.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/math/sampling.h"
#include "core/simd/math.h"
#include "core/simd/targets.h"

#ifndef AFTERSHADE_TESTS_SIMD_LANES_TEST_ONCE
#define AFTERSHADE_TESTS_SIMD_LANES_TEST_ONCE
namespace aftershade::tests {

/// Values by the name of the operation; an Int as the float of the same bits.
using Results = std::map<std::string, std::vector<float>>;

/// Lengths are multiples of 16.
struct Operands {
  std::vector<float> a, b;
};

}  // namespace aftershade::tests
#endif

HWY_BEFORE_NAMESPACE();
namespace aftershade::tests::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

inline Float flag(Mask m) { return select(m, Float(1.0F), Float(0.0F)); }

/// Stores a row of results, operation by operation.
struct Recorder {
  Results& results;
  size_t index, count;
  void operator()(const char* name, Float value) const {
    std::vector<float>& row = results[name];
    row.resize(count);
    store(row.data() + index, value);
  }
  void operator()(const char* name, Int value) const { (*this)(name, float_of_bits(value)); }
  void operator()(const char* name, Mask value) const { (*this)(name, flag(value)); }
};

inline void record_floats(const Recorder& record, Float a, Float b) {
  record("a + b", a + b);
  record("a - b", a - b);
  record("a * b", a * b);
  record("a / b", a / b);
  record("-a", -a);
  record("a < b", a < b);
  record("a <= b", a <= b);
  record("a > b", a > b);
  record("a >= b", a >= b);
  record("a == b", a == b);
  record("not", !(a < b));
  record("and", (a < b) & (b > 0.0F));
  record("or", (a < b) | (b > 0.0F));
  record("select", select(a < b, a, b));
  record("min", min(a, b));
  record("max", max(a, b));
  record("clamp", clamp(a, -1.0F, b));
  record("sat", sat(a));
  record("abs", abs(a));
  record("sqrt", sqrt(a));
  record("floor", floor(a));
  record("round", round(a));
  record("is_finite", is_finite(a));
  record("to_int", to_int(a));
}

inline void record_ints(const Recorder& record, Int a, Int b) {
  record("int a + b", a + b);
  record("int a - b", a - b);
  record("int a * b", a * b);
  record("int a & b", a & b);
  record("int a | b", a | b);
  record("int a ^ b", a ^ b);
  record("int a << 7", a << 7);
  record("int a >> 7", a >> 7);
  record("int a >> b", a >> (b & 31));
  record("int a < b", a < b);
  record("int a >= b", a >= b);
  record("int a == b", a == (b & a));
  record("int select", select(a < b, a, b));
  record("int min", min(a, b));
  record("int max", max(a, b));
  record("int clamp", clamp(a, -100, 100));
  record("to_float", to_float(a));
}

inline void record_functions(const Recorder& record, Float a, Float b) {
  record("exp2", exp2(a));
  record("log2", log2(abs(a)));
  record("round_small", round_small(clamp(a, -1e6F, 1e6F)));
  record("floor_log2", floor_log2(abs(a)));
  record("times_power_of_two", times_power_of_two(a, round_small(clamp(b, -126.0F, 127.0F))));
  const SinCos angle = sincos_turns(clamp(b, -1e6F, 1e6F));
  record("sin", angle.sin);
  record("cos", angle.cos);
}

Results all_operations(const Operands& operands) {
  constexpr std::array<int32_t, 16> kTable{7, -1, 0, 1 << 30, 5, 42, -1000, 3};
  const size_t count = operands.a.size();
  std::vector<float> pairs(2 * count);
  Results results;
  for (size_t i = 0; i < count; i += kLanes) {
    const Recorder record{results, i, count};
    const Float a = load(operands.a.data() + i), b = load(operands.b.data() + i);
    record_floats(record, a, b);
    record_ints(record, bits_of(a), bits_of(b));
    record_functions(record, a, b);
    const Int index = iota(static_cast<int>(i));
    record("iota", index);
    record("gather", gather(operands.b.data(), Int(static_cast<int>(count) - 1) - index));
    record("look_up", look_up(kTable.data(), bits_of(b) & 7));
    store_pairs(pairs.data() + 2 * i, a, b);
    const Pairs again = load_pairs(pairs.data() + 2 * i);
    record("even", again.even);
    record("odd", again.odd);
  }
  results["pairs"] = pairs;
  return results;
}

/// any and all see every lane: true and false in each position.
bool any_and_all_see_every_lane() {
  for (int lane = 0; lane < kLanes; ++lane) {
    const Mask one = iota(0) == Int(lane);
    if (!any(one) || all(!one) || any(one & !one) || !all(one | !one)) return false;
    if (kLanes > 1 && (all(one) || !any(!one))) return false;
  }
  return true;
}

}  // namespace aftershade::tests::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

namespace aftershade::tests {

HWY_EXPORT(all_operations);
HWY_EXPORT(any_and_all_see_every_lane);

namespace {

/// Special values against each other, then random bits.
Operands operands() {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const std::array<float, 16> special{0.0F,  -0.0F,  1.0F,  -1.0F,          0.5F, 2.5F,  -2.5F,   1e-45F,
                                      3e38F, -3e38F, 1e10F, -2147483648.0F, kInf, -kInf, 126.75F, std::nanf("")};
  Operands out;
  for (const float a : special)
    for (const float b : special) {
      out.a.push_back(a);
      out.b.push_back(b);
    }
  for (uint32_t i = 0; i < 65536; ++i) {
    out.a.push_back(std::bit_cast<float>(hash_counters(i, 0)));
    out.b.push_back(std::bit_cast<float>(hash_counters(i, 1)));
  }
  return out;
}

/// The same bits; any NaN is like any other, as x86 keeps the payload of whichever operand the compiler put first.
bool same(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

class Lanes : public testing::TestWithParam<std::string> {
 protected:
  ~Lanes() override { lanes::force_target(lanes::targets().front()); }
};

TEST_P(Lanes, GiveWhatOneLaneGives) {
  const Operands in = operands();
  lanes::force_target("scalar");
  const Results twin = HWY_DYNAMIC_DISPATCH(all_operations)(in);
  lanes::force_target(GetParam());
  const Results tested = HWY_DYNAMIC_DISPATCH(all_operations)(in);
  ASSERT_GT(twin.size(), 40U);
  for (const auto& [name, values] : twin) {
    size_t wrong = 0;
    while (wrong < values.size() && same(values[wrong], tested.at(name)[wrong])) ++wrong;
    if (wrong < values.size())
      ADD_FAILURE() << name << " of " << in.a[wrong] << " and " << in.b[wrong] << ": " << values[wrong] << " and "
                    << tested.at(name)[wrong];
  }
}

TEST_P(Lanes, AnyAndAllSeeEveryLane) {
  lanes::force_target(GetParam());
  EXPECT_TRUE(HWY_DYNAMIC_DISPATCH(any_and_all_see_every_lane)());
}

INSTANTIATE_TEST_SUITE_P(OfThisMachine, Lanes, testing::ValuesIn(lanes::targets()),
                         [](const auto& target) { return target.param; });

TEST(Targets, ThatAreNotThereAreRefused) {
  EXPECT_THROW(lanes::force_target("abacus"), std::exception);
  EXPECT_EQ(lanes::targets().back(), "scalar");
}

}  // namespace
}  // namespace aftershade::tests
#endif
