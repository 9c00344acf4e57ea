#include "core/image/plane.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace aftershade {
namespace {

/// Pixel (x, y) holds 100 y + x + 1.
Plane numbered(int width, int height) {
  Plane plane(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) plane(x, y) = static_cast<float>(100 * y + x + 1);
  return plane;
}

TEST(Plane, RowsAreAlignedAndPadded) {
  for (const int width : {1, 15, 16, 17, 48, 100}) {
    Plane plane(width, 3, 2.0F);
    EXPECT_EQ(plane.view().stride % 16, 0) << width;
    EXPECT_GE(plane.view().stride, width + Plane::kPadding) << width;
    for (int y = 0; y < 3; ++y) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(plane.row(y)) % 64, 0U) << width;
      for (int x = 0; x < width + Plane::kPadding; ++x) EXPECT_EQ(plane.row(y)[x], 2.0F);
      for (int x = width; x < width + Plane::kPadding; ++x) plane.row(y)[x] = 9.0F;  // writable, as asan would say
    }
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < width; ++x) EXPECT_EQ(plane(x, y), 2.0F) << "the padding of one row is another row";
  }
}

TEST(Plane, EmptyOnes) {
  EXPECT_TRUE(Plane().empty());
  EXPECT_TRUE(Plane(0, 5).empty());
  EXPECT_TRUE(Plane(5, -1).empty());
  EXPECT_EQ(Plane(0, 5).view().data, nullptr);
  EXPECT_TRUE(copy_of(Plane()).empty());
}

TEST(Plane, MovesLeaveAnEmptyOne) {
  Plane a = numbered(4, 2);
  const float* data = a.row(0);
  Plane b = std::move(a);
  EXPECT_EQ(b.row(0), data);
  EXPECT_TRUE(a.empty());  // NOLINT: what a moved-from plane is, is the point
  Plane c(7, 7);
  c = std::move(b);
  EXPECT_EQ(c.row(0), data);
  EXPECT_EQ(c.width(), 4);
  EXPECT_TRUE(b.empty());  // NOLINT
}

TEST(CopyOf, IsIndependent) {
  Plane a = numbered(5, 4);
  Plane b = copy_of(a);
  a(2, 3) = -1;
  EXPECT_EQ(b(2, 3), 303);
  EXPECT_EQ(b.width(), 5);
  EXPECT_EQ(b.height(), 4);
}

TEST(CopyAt, CopiesTheOverlapOnly) {
  const Plane source = numbered(3, 2);
  for (int dy = -3; dy <= 5; ++dy)
    for (int dx = -4; dx <= 6; ++dx) {
      Plane target(5, 4, 0.0F);
      copy_at(source, target, dx, dy);
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) {
          const int sx = x - dx, sy = y - dy;
          const bool inside = sx >= 0 && sx < 3 && sy >= 0 && sy < 2;
          EXPECT_EQ(target(x, y), inside ? source(sx, sy) : 0.0F) << dx << "," << dy << " at " << x << "," << y;
        }
    }
}

TEST(CopyAt, LeavesThePaddingAlone) {
  Plane target(5, 2, 3.0F);
  copy_at(numbered(40, 2), target, -2, 0);
  EXPECT_EQ(target(4, 1), 107);
  for (int x = 5; x < 5 + Plane::kPadding; ++x) EXPECT_EQ(target.row(0)[x], 3.0F);
}

}  // namespace
}  // namespace aftershade
