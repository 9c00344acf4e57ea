#include "core/ao/ball_samples.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aftershade::tests {
namespace {

double length(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

TEST(BallSamples, FillTheVolumeEvenly) {
  const ao::BallSamples& ball = ao::ball_samples();
  ASSERT_EQ(ball.x.size(), static_cast<size_t>(ao::kSequenceLength));
  double mean[3] = {0, 0, 0}, squares[3] = {0, 0, 0};
  int inner = 0;
  for (size_t i = 0; i < ball.x.size(); ++i) {
    const double p[3] = {ball.x[i], ball.y[i], ball.z[i]};
    const double r = length(p[0], p[1], p[2]);
    ASSERT_LE(r, 1 + 1e-6);
    inner += r < 0.5 ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
      mean[axis] += p[axis] / ao::kSequenceLength;
      squares[axis] += p[axis] * p[axis] / ao::kSequenceLength;
    }
  }
  EXPECT_NEAR(inner / static_cast<double>(ao::kSequenceLength), 1.0 / 8, 1e-3);  // volume goes with the cube
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis], 0, 1e-3);
    EXPECT_NEAR(squares[axis], 1.0 / 5, 2e-3);  // of a uniform ball
  }
}

TEST(BallSamples, EveryRunOfSixteenIsSpreadMoreEvenlyThanChance) {
  // Share of the points in a half ball: 16 independent points would scatter by 1/8.
  const ao::BallSamples& ball = ao::ball_samples();
  for (const auto* axis : {&ball.x, &ball.y, &ball.z}) {
    double squares = 0;
    constexpr int kRuns = ao::kSequenceLength / 16;
    for (size_t run = 0; run < kRuns; ++run) {
      int above = 0;
      for (size_t i = 0; i < 16; ++i) above += (*axis)[run * 16 + i] > 0 ? 1 : 0;
      squares += std::pow(above / 16.0 - 0.5, 2) / kRuns;
    }
    EXPECT_LT(std::sqrt(squares), 0.07);
  }
}

TEST(MirrorTile, HasSixteenUnitVectorsSpreadOverTheSphere) {
  const ao::MirrorTile& tile = ao::mirror_tile();
  double sum[3] = {0, 0, 0};
  for (size_t i = 0; i < 16; ++i) {
    EXPECT_NEAR(length(tile.x[i], tile.y[i], tile.z[i]), 1, 1e-6);
    sum[0] += tile.x[i], sum[1] += tile.y[i], sum[2] += tile.z[i];
    for (size_t j = 0; j < i; ++j) {
      const double dot = tile.x[i] * tile.x[j] + tile.y[i] * tile.y[j] + tile.z[i] * tile.z[j];
      EXPECT_LT(dot, 0.9) << i << ' ' << j;
    }
  }
  EXPECT_LT(length(sum[0], sum[1], sum[2]), 1);
}

}  // namespace
}  // namespace aftershade::tests
