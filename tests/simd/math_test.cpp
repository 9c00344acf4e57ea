#include "core/simd/math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/math/sampling.h"

namespace aftershade::tests {
namespace {

namespace N_SCALAR = lanes::N_SCALAR;  // all targets give its bits (lanes_test.cpp)

float lane0(N_SCALAR::Float x) {
  float out[N_SCALAR::kLanes];
  N_SCALAR::store(out, x);
  return out[0];
}

double exp2_error(float x) {
  const double exact = std::exp2(static_cast<double>(x));
  return std::abs(static_cast<double>(lane0(N_SCALAR::exp2(x))) - exact) / exact;
}

TEST(SimdMath, Exp2StaysWithinItsStatedErrorOverItsWholeDomain) {
  double worst = 0;
  for (float f = 0.49F; f <= 0.5F; f = std::nextafter(f, 1.0F))  // every float where the series is at its worst
    worst = std::max({worst, exp2_error(f), exp2_error(-f)});
  constexpr int kSteps = 12'000'000;
  for (int i = 0; i <= kSteps; ++i) {
    const float x = static_cast<float>(-126.0 + 252.0 * i / kSteps);
    worst = std::max(worst, exp2_error(x));
  }
  std::printf("exp2: worst relative error %.3g\n", worst);
  EXPECT_LT(worst, 2.5e-7);
  EXPECT_GT(worst, 0.0);
}

TEST(SimdMath, Exp2OfWholeNumbersIsExactAndVanishesBelowItsDomain) {
  for (int n = -126; n <= 126; ++n) EXPECT_EQ(lane0(N_SCALAR::exp2(static_cast<float>(n))), std::ldexp(1.0F, n)) << n;
  EXPECT_EQ(lane0(N_SCALAR::exp2(-126.5F)), 0.0F);
  EXPECT_EQ(lane0(N_SCALAR::exp2(-1e30F)), 0.0F);
  EXPECT_EQ(lane0(N_SCALAR::exp2(-HUGE_VALF)), 0.0F);
}

double log2_error(float x) {
  const double exact = std::log2(static_cast<double>(x)),
               error = std::abs(static_cast<double>(lane0(N_SCALAR::log2(x))) - exact);
  return x >= 0.5F && x <= 2.0F ? error : error / std::abs(exact);
}

TEST(SimdMath, Log2StaysWithinItsStatedErrorOverItsWholeDomain) {
  double worst = 0;
  for (float x = 0.5F; x <= 2.0F; x = std::nextafter(x, 3.0F)) worst = std::max(worst, log2_error(x));
  for (uint32_t i = 0; i < 4'000'000; ++i) {  // every magnitude
    const int exponent = static_cast<int>(hash_counters(i, 1) % 252U) - 126;
    worst = std::max(worst, log2_error(std::ldexp(1.0F + unit_float(hash_counters(i, 0)), exponent)));
  }
  std::printf("log2: worst error %.3g\n", worst);
  EXPECT_LT(worst, 2e-7);
  EXPECT_GT(worst, 0.0);
}

TEST(SimdMath, Log2OfPowersOfTwoIsExactAndEndsAtTheLowestExponent) {
  for (int n = -126; n <= 126; ++n) EXPECT_EQ(lane0(N_SCALAR::log2(std::ldexp(1.0F, n))), static_cast<float>(n)) << n;
  EXPECT_EQ(lane0(N_SCALAR::log2(0.0F)), -126.0F);
  EXPECT_EQ(lane0(N_SCALAR::log2(-1.0F)), -126.0F);
}

double sincos_error(float t) {
  const N_SCALAR::SinCos value = N_SCALAR::sincos_turns(t);
  const double turns = static_cast<double>(t) - std::round(static_cast<double>(t));  // exact
  const double angle = 2 * std::numbers::pi * turns;
  return std::max(std::abs(static_cast<double>(lane0(value.sin)) - std::sin(angle)),
                  std::abs(static_cast<double>(lane0(value.cos)) - std::cos(angle)));
}

TEST(SimdMath, SincosTurnsStaysWithinItsStatedErrorOverItsWholeDomain) {
  double worst = 0;
  constexpr int kSteps = 4'000'000;
  for (int i = -kSteps; i <= kSteps; ++i) worst = std::max(worst, sincos_error(static_cast<float>(2.0 * i / kSteps)));
  for (uint32_t i = 0; i < 4'000'000; ++i) {  // every magnitude up to 2^22
    const float magnitude =
        std::ldexp(1.0F + unit_float(hash_counters(i, 0)), static_cast<int>(hash_counters(i, 1) % 44U) - 22);
    worst = std::max(worst, sincos_error((i & 1U) != 0 ? -magnitude : magnitude));
  }
  std::printf("sincos_turns: worst absolute error %.3g\n", worst);
  EXPECT_LT(worst, 4e-7);
}

TEST(SimdMath, SincosTurnsIsExactAtQuarterTurns) {
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const N_SCALAR::SinCos value = N_SCALAR::sincos_turns(static_cast<float>(quarter) * 0.25F);
    const int q = quarter & 3;
    EXPECT_EQ(lane0(value.sin), q == 1 ? 1.0F : q == 3 ? -1.0F : 0.0F) << quarter;
    EXPECT_EQ(lane0(value.cos), q == 0 ? 1.0F : q == 2 ? -1.0F : 0.0F) << quarter;
  }
}

TEST(SimdMath, RoundSmallIsRound) {
  for (int i = -4'000'000; i <= 4'000'000; ++i) {
    const float x = static_cast<float>(i) * 1.04F, tie = static_cast<float>(i) * 0.5F;
    ASSERT_EQ(lane0(N_SCALAR::round_small(x)), lane0(N_SCALAR::round(x))) << x;
    ASSERT_EQ(lane0(N_SCALAR::round_small(tie)), lane0(N_SCALAR::round(tie))) << tie;
  }
}

TEST(SimdMath, FloorLog2IsTheExponent) {
  const auto of = [](float x) { return lane0(N_SCALAR::to_float(N_SCALAR::floor_log2(x))); };
  for (int n = -126; n <= 127; ++n) {
    const float power = std::ldexp(1.0F, n);
    EXPECT_EQ(of(power), static_cast<float>(n));
    if (n > -126) {
      EXPECT_EQ(of(std::nextafter(power, 0.0F)), static_cast<float>(n - 1));
    }
  }
  EXPECT_EQ(of(0.75F), -1.0F);
  EXPECT_EQ(of(1000.0F), 9.0F);
}

}  // namespace
}  // namespace aftershade::tests
