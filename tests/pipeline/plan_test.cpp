#include "core/pipeline/plan.h"

#include <gtest/gtest.h>

#include <numeric>

namespace aftershade::pipeline {
namespace {

std::vector<int> range(int first, int last) {
  std::vector<int> frames(static_cast<size_t>(last - first + 1));
  std::iota(frames.begin(), frames.end(), first);
  return frames;
}

TEST(Plan, WithoutHistoryVisitsOnlyWhatIsWritten) {
  EXPECT_EQ(plan({3, 7}, range(1, 10), false, 40), (std::vector<PlannedFrame>{{3, true, true}, {7, true, true}}));
}

TEST(Plan, HistoryIsBuiltUpFromFramesBefore) {
  EXPECT_EQ(plan({5}, range(1, 10), true, 2),
            (std::vector<PlannedFrame>{{3, false, true}, {4, false, false}, {5, true, false}}));
}

TEST(Plan, AllMeansFromTheFirstFrameOnDisk) {
  const auto frames = plan({60}, range(1, 80), true, kPrerollAll);
  EXPECT_EQ(frames.size(), 60U);
  EXPECT_EQ(frames.front(), (PlannedFrame{1, false, true}));
}

TEST(Plan, AGapOnDiskEndsTheHistory) {
  EXPECT_EQ(plan({5, 6}, {1, 2, 4, 5, 6}, true, 40),
            (std::vector<PlannedFrame>{{4, false, true}, {5, true, false}, {6, true, false}}));
}

TEST(Plan, EverySecondFrameStillFiltersThoseBetween) {
  EXPECT_EQ(plan({1, 3, 5}, range(1, 6), true, 40),
            (std::vector<PlannedFrame>{
                {1, true, true}, {2, false, false}, {3, true, false}, {4, false, false}, {5, true, false}}));
}

TEST(Plan, NegativeFrames) {
  EXPECT_EQ(plan({-1}, {-3, -2, -1, 0}, true, 1), (std::vector<PlannedFrame>{{-2, false, true}, {-1, true, false}}));
}

}  // namespace
}  // namespace aftershade::pipeline
