#include "core/parallel/background.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "core/parallel/rows.h"

namespace aftershade {
namespace {

TEST(Background, IsDoneAfterWaitingWithAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 0}) {
    set_thread_count(threads);
    std::atomic<int> rows = 0;
    Background a([&] { for_rows(100, [&](int) { ++rows; }); });
    Background b([&] { for_rows(100, [&](int) { ++rows; }); });
    for_rows(100, [&](int) { ++rows; });
    b.wait();
    a.wait();
    EXPECT_EQ(rows, 300) << threads;
  }
}

TEST(Background, WaitingRethrowsWhatItThrew) {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    Background fails([] { throw std::runtime_error("work"); });
    Background nested([] {
      for_rows(50, [](int y) {
        if (y == 20) throw std::out_of_range("row");
      });
    });
    EXPECT_THROW(fails.wait(), std::runtime_error);
    EXPECT_THROW(nested.wait(), std::out_of_range);
    for_rows(10, [](int) {});  // nothing was cancelled
  }
}

TEST(Background, ItsEndWaitsForTheWork) {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    std::atomic<bool> done = false;
    {
      Background work([&] { done = true; });
    }
    EXPECT_TRUE(done);
    {
      Background nobody_asks([] { throw std::runtime_error("lost"); });
    }
  }
}

TEST(Background, StartsFromWorkInTheBackground) {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    int value = 0;
    Background outer([&] {
      Background inner([&] { value = 1; });
      inner.wait();
      ++value;
    });
    outer.wait();
    EXPECT_EQ(value, 2);
  }
  set_thread_count(0);
}

TEST(Undisturbed, DoesItsOwnWorkAndPassesOnWhatItThrows) {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    std::atomic<int> rows = 0;
    Background other([&] { for_rows(100, [&](int) { ++rows; }); });
    undisturbed([&] { for_rows(100, [&](int) { ++rows; }); });
    EXPECT_GE(rows, 100);
    EXPECT_THROW(undisturbed([] { throw std::runtime_error("work"); }), std::runtime_error);
    other.wait();
    EXPECT_EQ(rows, 200);
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace aftershade
