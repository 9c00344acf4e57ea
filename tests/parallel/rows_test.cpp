#include "core/parallel/rows.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace aftershade {
namespace {

TEST(ForRows, VisitsEveryRowOnce) {
  for (const int threads : {1, 2, 0}) {
    set_thread_count(threads);
    std::vector<std::atomic<int>> visits(1000);
    for_rows(1000, [&](int y) { ++visits[static_cast<size_t>(y)]; });
    for (const auto& count : visits) EXPECT_EQ(count, 1);
  }
}

TEST(ForRows, TakesNoRows) {
  for_rows(0, [](int) { ADD_FAILURE(); });
  for_rows(-3, [](int) { ADD_FAILURE(); });
}

TEST(ForRows, RethrowsWhatARowThrows) {
  EXPECT_THROW(for_rows(100,
                        [](int y) {
                          if (y == 57) throw std::runtime_error("row");
                        }),
               std::runtime_error);
}

TEST(ThreadCount, IsWhatWasSet) {
  set_thread_count(1);
  EXPECT_EQ(thread_count(), 1);
  set_thread_count(0);
  EXPECT_GE(thread_count(), 1);
}

}  // namespace
}  // namespace aftershade
