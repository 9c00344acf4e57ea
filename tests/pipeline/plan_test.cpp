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

/// Five stages; the one in the middle depends on other frames.
std::vector<PlannedFrame> plan_of(const std::vector<int>& written, const std::vector<int>& on_disk,
                                  const std::vector<Dependency>& dependencies, int preroll = 40) {
  return plan(written, on_disk, 5, dependencies, preroll);
}
const std::vector<Dependency> kHistory{{2, 0, 0, true}};
const std::vector<Dependency> kWindow{{2, 1, 2, false}};

TEST(Plan, WithoutHistoryVisitsOnlyWhatIsWritten) {
  EXPECT_EQ(plan_of({3, 7}, range(1, 10), {}), (std::vector<PlannedFrame>{{3, 5, true, true}, {7, 5, true, true}}));
}

TEST(Plan, HistoryIsBuiltUpFromFramesBefore) {
  EXPECT_EQ(plan_of({5}, range(1, 10), kHistory, 2),
            (std::vector<PlannedFrame>{{3, 3, false, true}, {4, 3, false, false}, {5, 5, true, false}}));
}

TEST(Plan, AllMeansFromTheFirstFrameOnDisk) {
  const auto frames = plan_of({60}, range(1, 80), kHistory, kPrerollAll);
  EXPECT_EQ(frames.size(), 60U);
  EXPECT_EQ(frames.front(), (PlannedFrame{1, 3, false, true}));
}

TEST(Plan, AGapOnDiskEndsTheHistory) {
  EXPECT_EQ(plan_of({5, 6}, {1, 2, 4, 5, 6}, kHistory),
            (std::vector<PlannedFrame>{{4, 3, false, true}, {5, 5, true, false}, {6, 5, true, false}}));
}

TEST(Plan, EverySecondFrameStillFiltersThoseBetween) {
  EXPECT_EQ(
      plan_of({1, 3, 5}, range(1, 6), kHistory),
      (std::vector<PlannedFrame>{
          {1, 5, true, true}, {2, 3, false, false}, {3, 5, true, false}, {4, 3, false, false}, {5, 5, true, false}}));
}

TEST(Plan, PrerollIsCountedFromEachWrittenFrame) {
  EXPECT_EQ(plan_of({4, 9}, range(1, 10), kHistory, 2), (std::vector<PlannedFrame>{{2, 3, false, true},
                                                                                   {3, 3, false, false},
                                                                                   {4, 5, true, false},
                                                                                   {7, 3, false, true},
                                                                                   {8, 3, false, false},
                                                                                   {9, 5, true, false}}));
}

TEST(Plan, NegativeFrames) {
  EXPECT_EQ(plan_of({-1}, {-3, -2, -1, 0}, kHistory, 1),
            (std::vector<PlannedFrame>{{-2, 3, false, true}, {-1, 5, true, false}}));
}

TEST(Plan, AWindowNeedsItsNeighboursAsFarAsTheStagesBeforeIt) {
  EXPECT_EQ(plan_of({5}, range(1, 10), kWindow),
            (std::vector<PlannedFrame>{
                {4, 2, false, true}, {5, 5, true, false}, {6, 2, false, false}, {7, 2, false, false}}));
}

TEST(Plan, AWindowEndsAtAGapAndAtTheEndOfTheSequence) {
  EXPECT_EQ(plan_of({5}, {3, 5, 6, 8}, kWindow), (std::vector<PlannedFrame>{{5, 5, true, true}, {6, 2, false, false}}));
}

TEST(Plan, WindowsAddUp) {  // stage 1 reaches one frame to each side, stage 3 one frame back
  EXPECT_EQ(plan_of({5}, range(1, 10), {{1, 1, 1, false}, {3, 1, 0, false}}),
            (std::vector<PlannedFrame>{
                {3, 1, false, true}, {4, 3, false, false}, {5, 5, true, false}, {6, 1, false, false}}));
}

TEST(Plan, NeighboursOfAWindowHaveHistoryToo) {
  EXPECT_EQ(plan_of({5}, range(1, 10), {{1, 0, 0, true}, {3, 1, 0, false}}, 1),
            (std::vector<PlannedFrame>{{3, 2, false, true}, {4, 3, false, false}, {5, 5, true, false}}));
}

}  // namespace
}  // namespace aftershade::pipeline
