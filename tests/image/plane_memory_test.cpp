#include "core/image/plane_memory.h"

#include <gtest/gtest.h>

#include <optional>
#include <thread>
#include <vector>

#include "core/image/plane.h"

namespace aftershade {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr bool kKeeps = false;
#else
constexpr bool kKeeps = true;
#endif

TEST(PlaneMemory, APlaneTakesWhatOneOfItsSizeGaveBack) {
  if (!kKeeps) GTEST_SKIP() << "nothing is recycled under AddressSanitizer";
  const float* first = Plane(500, 400).row(0);
  const Plane second(500, 400);
  EXPECT_EQ(second.row(0), first);
  const Plane other_size(500, 500);
  EXPECT_NE(other_size.row(0), first);
}

TEST(PlaneMemory, RecycledPixelsAreFilledAsAskedFor) {
  { const Plane dirty(500, 400, 7.0F); }
  const Plane filled(500, 400, 2.0F);
  for (int y = 0; y < 400; ++y)
    for (int x = 0; x < 500 + Plane::kPadding; ++x) ASSERT_EQ(filled.row(y)[x], 2.0F);
}

TEST(PlaneMemory, PlanesForOverwritingHaveZerosBehindTheirRows) {
  for (const int width : {1, 16, 500, 512}) {
    { const Plane dirty(width, 300, 7.0F); }
    Plane plane = Plane::for_overwrite(width, 300);
    EXPECT_EQ(plane.width(), width);
    EXPECT_EQ(plane.height(), 300);
    for (int y = 0; y < 300; ++y)
      for (int x = width; x < plane.view().stride; ++x) ASSERT_EQ(plane.row(y)[x], 0.0F) << width;
  }
  EXPECT_TRUE(Plane::for_overwrite(0, 3).empty());
  EXPECT_TRUE(Plane::for_overwrite(3, -1).empty());
}

TEST(PlaneMemory, KeptMemoryNeverLiftsTheSumFarAboveThePeak) {
  release_plane_memory();
  for (int round = 0; round < 3; ++round)
    for (const int width : {300, 700, 1100, 500}) {  // sizes change, each unlike those kept
      std::vector<Plane> planes;
      for (int i = 0; i < 6; ++i) planes.emplace_back(width, 300);
      const PlaneMemory now = plane_memory();
      EXPECT_LE(now.used + now.kept, now.peak + now.peak / 4) << width;
    }
  EXPECT_EQ(plane_memory().kept > 0, kKeeps);
  release_plane_memory();
  EXPECT_EQ(plane_memory().kept, 0U);
}

TEST(PlaneMemory, CountsWhatIsInUse) {
  const size_t before = plane_memory().used;
  {
    const Plane plane(1000, 100);
    const size_t bytes = static_cast<size_t>(plane.view().stride) * 100 * sizeof(float),
                 now = plane_memory().used - before;
    EXPECT_GE(now, bytes);
    EXPECT_LE(now, bytes + bytes / 8);
    const Plane small(10, 10);
    EXPECT_EQ(plane_memory().used - before, now);
  }
  EXPECT_EQ(plane_memory().used, before);
}

TEST(PlaneMemory, ThreadsShareIt) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([t] {
      for (int i = 0; i < 200; ++i) {
        const auto value = static_cast<float>(1000 * t + i);
        Plane plane(300 + i % 3, 150, value);
        const Plane moved = std::move(plane);
        ASSERT_EQ(moved(299, 149), value);
        ASSERT_EQ(moved(0, 0), value);
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(plane_memory().used, 0U);
}

}  // namespace
}  // namespace aftershade
