#include "core/motionblur/half_velocity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace aftershade::tests {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

struct Pair {
  float x, y;
};

struct Case {
  const char* name;
  Pair prev, next, expected;  ///< shutter 0.5, radius 10
};

Plane filled(float value) { return Plane(5, 3, value); }

TEST(HalfVelocity, CombinesWhatIsKnown) {
  const Case cases[] = {
      {"both agree: half of shutter times displacement", {-8, 4}, {8, -4}, {2, -1}},
      {"both known: mean of next and -prev", {-8, 0}, {4, 4}, {1.5F, 0.5F}},
      {"next unknown", {-8, 4}, {kNan, 4}, {2, -1}},
      {"next half unknown", {-8, 4}, {8, kInf}, {2, -1}},
      {"prev unknown", {kNan, kNan}, {8, -4}, {2, -1}},
      {"prev infinite", {-kInf, 0}, {8, -4}, {2, -1}},
      {"none known", {kNan, 0}, {0, kInf}, {0, 0}},
      {"longer than the radius", {-400, 300}, {400, -300}, {8, -6}},
      {"as long as the radius", {-40, 0}, {40, 0}, {10, 0}},
      {"a sentinel", {-3e38F, 0}, {8, -4}, {2, -1}},
      {"longest that is no sentinel", {-9e14F, 0}, {9e14F, 0}, {10, 0}},
  };
  for (const Case& c : cases) {
    const Plane px = filled(c.prev.x), py = filled(c.prev.y), nx = filled(c.next.x), ny = filled(c.next.y);
    const motionblur::HalfVelocity v = motionblur::half_velocity(px, py, nx, ny, 0.5F, 10);
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 5; ++x) {
        EXPECT_NEAR(v.x(x, y), c.expected.x, 1e-6) << c.name;
        EXPECT_NEAR(v.y(x, y), c.expected.y, 1e-6) << c.name;
      }
  }
}

TEST(HalfVelocity, TakesEitherPairAlone) {
  const Plane a = filled(8), b = filled(-4);
  const motionblur::HalfVelocity next = motionblur::half_velocity({}, {}, a, b, 1.0F, 100);
  const motionblur::HalfVelocity prev = motionblur::half_velocity(a, b, {}, {}, 1.0F, 100);
  ASSERT_EQ(next.x.width(), 5);
  ASSERT_EQ(prev.x.height(), 3);
  EXPECT_EQ(next.x(4, 2), 4.0F);
  EXPECT_EQ(next.y(4, 2), -2.0F);
  EXPECT_EQ(prev.x(4, 2), -4.0F);
  EXPECT_EQ(prev.y(4, 2), 2.0F);
}

TEST(HalfVelocity, NeverExceedsTheRadius) {
  Plane x(64, 64), y(64, 64);
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) {
      x(column, row) = static_cast<float>(column - 32) * 3.7F;
      y(column, row) = static_cast<float>(row - 32) * 2.9F;
    }
  const motionblur::HalfVelocity v = motionblur::half_velocity({}, {}, x, y, 1.0F, 18);
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) {
      EXPECT_LE(std::hypot(v.x(column, row), v.y(column, row)), 18 * (1 + 3e-7));
      EXPECT_NEAR(v.x(column, row) * y(column, row), v.y(column, row) * x(column, row), 2e-3) << "the direction stays";
    }
}

TEST(HalfVelocity, InEightBitsIsWithinHalfAStep) {
  constexpr float kLongest = 18, kStep = 2 * kLongest / 255;
  motionblur::HalfVelocity v{Plane(64, 2), Plane(64, 2)};
  for (int i = 0; i < 64; ++i) v.x(i, 0) = static_cast<float>(i - 32) * 0.55F, v.y(i, 1) = -v.x(i, 0);
  v.x(0, 1) = -kLongest, v.x(1, 1) = kLongest;
  const motionblur::HalfVelocity stored = motionblur::at_8_bits(v, kLongest);
  for (int i = 0; i < 64; ++i) {
    EXPECT_NEAR(stored.x(i, 0), v.x(i, 0), 0.5001F * kStep);
    EXPECT_NEAR(stored.y(i, 1), v.y(i, 1), 0.5001F * kStep);
    EXPECT_NEAR(std::remainder(stored.x(i, 0) + kLongest, kStep), 0, 1e-5) << "a step of 255";
  }
  EXPECT_EQ(stored.x(0, 1), -kLongest);
  EXPECT_EQ(stored.x(1, 1), kLongest);
  EXPECT_NEAR(stored.x(2, 1), 0.5F * kStep, 1e-5) << "there is no 0 among 256 values";
}

TEST(HalfVelocity, TheLongestIsFound) {
  motionblur::HalfVelocity v{Plane(9, 7), Plane(9, 7)};
  EXPECT_EQ(motionblur::longest_px(v), 0);
  v.x(8, 6) = -3, v.y(8, 6) = 4, v.x(1, 1) = 4.5F;
  EXPECT_EQ(motionblur::longest_px(v), 5);
}

TEST(HalfVelocity, OfCompleteMotionIsHalfTheShuttersShareOfItsMean) {
  motionblur::Motion motion{filled(-7), filled(3), filled(9), filled(-1)};
  const motionblur::HalfVelocity v = motionblur::half_velocity(motion, 0.5F, 100);
  EXPECT_EQ(v.x(2, 2), 2);
  EXPECT_EQ(v.y(2, 2), -0.5F);
}

}  // namespace
}  // namespace aftershade::tests
