#include <gtest/gtest.h>

#include <array>

#include "core/image/frame.h"
#include "core/image/placed.h"
#include "core/image/plane_memory.h"

namespace aftershade {
namespace {

TEST(SharedPlane, HasTheSamePixelsUntilOneWantsItsOwn) {
  Plane a(20, 3, 0.25F);
  Plane b = a.shared();
  EXPECT_EQ(a.row(0), b.row(0));
  b.make_own();
  EXPECT_NE(a.row(0), b.row(0));
  b(4, 1) = 1;
  EXPECT_EQ(a(4, 1), 0.25F);
  EXPECT_EQ(b(5, 1), 0.25F);
}

TEST(SharedPlane, WhoHasItAloneKeepsItsPixels) {
  Plane a(20, 3, 0.25F);
  const float* pixels = a.row(0);
  { const Plane b = a.shared(); }
  a.make_own();
  EXPECT_EQ(a.row(0), pixels);
}

TEST(SharedPlane, OutlivesTheOther) {
  Plane b;
  {
    const Plane a(8, 2, 3.0F);
    b = a.shared();
  }
  EXPECT_EQ(b(7, 1), 3.0F);
}

TEST(SharedFrame, IsTheSameFrameOnTheSamePixels) {
  Frame frame;
  frame.number = 7;
  frame.view = "left";
  frame.window = {1, 2, 8, 9};
  frame.planes(Role::depth).emplace_back(8, 8, 2.0F);
  frame.named["mask"] = Plane(8, 8, 1.0F);
  frame.added["AO"] = Plane(8, 8, 0.5F);
  frame.layers.push_back({"", {"R"}, {}, -1, 0, frame.window, true, true, true, false});
  frame.layers[0].planes.emplace_back(8, 8, 0.1F);
  const Frame other = shared(frame);
  EXPECT_EQ(other.number, 7);
  EXPECT_EQ(other.view, "left");
  EXPECT_EQ(other.window, frame.window);
  EXPECT_EQ(other.depth().row(0), frame.depth().row(0));
  EXPECT_EQ(other.named.at("mask").row(0), frame.named.at("mask").row(0));
  EXPECT_EQ(other.added.at("AO").row(0), frame.added.at("AO").row(0));
  EXPECT_EQ(other.layers.at(0).planes.at(0).row(0), frame.layers[0].planes[0].row(0));
  EXPECT_TRUE(other.layers[0].is_beauty && other.layers[0].receives_ao);
}

TEST(Placed, FillsAroundAndCutsOff) {
  Plane source(2, 1);
  source(0, 0) = 1, source(1, 0) = 2;
  const Plane out = placed(source, {5, 5, 6, 5}, {4, 5, 5, 6}, -1);
  ASSERT_EQ(out.width(), 2);
  ASSERT_EQ(out.height(), 2);
  EXPECT_EQ(out(0, 0), -1);
  EXPECT_EQ(out(1, 0), 1);
  EXPECT_EQ(out(1, 1), -1);
}

TEST(MemoryAccount, HasThePlanesMadeOnItUntilTheyAreGone) {
  const auto account = std::make_shared<MemoryAccount>();
  Plane kept;
  {
    const OnAccount on_account(account);
    kept = Plane(64, 64);
    { const Plane gone(64, 64); }
  }
  const Plane elsewhere(64, 64);
  const size_t one = account->used;
  EXPECT_GE(one, sizeof(float) * 64 * 64);
  EXPECT_EQ(account->peak, 2 * one);
  const Plane same = kept.shared();
  kept = Plane();
  EXPECT_EQ(account->used, one);  // somebody has it still
}

}  // namespace
}  // namespace aftershade
