#include "core/image/window.h"

#include <gtest/gtest.h>

#include "core/image/role.h"

namespace aftershade {
namespace {

TEST(Window, CornersAreInclusive) {
  const Window window{-2, 3, 4, 3};
  EXPECT_EQ(window.width(), 7);
  EXPECT_EQ(window.height(), 1);
  EXPECT_FALSE(window.empty());
  EXPECT_TRUE(window.contains(-2, 3));
  EXPECT_TRUE(window.contains(4, 3));
  EXPECT_FALSE(window.contains(5, 3));
  EXPECT_FALSE(window.contains(0, 4));
}

TEST(Window, DefaultIsEmpty) {
  EXPECT_TRUE(Window().empty());
  EXPECT_EQ(Window().width(), 0);
  EXPECT_FALSE(Window().contains(0, 0));
}

TEST(Intersection, IsWhatBothContain) {
  const Window a{0, 0, 9, 4}, b{-3, 2, 5, 20}, beside{10, 0, 12, 4};
  EXPECT_EQ(intersection(a, b), (Window{0, 2, 5, 4}));
  EXPECT_EQ(intersection(b, a), intersection(a, b));
  EXPECT_TRUE(intersection(a, beside).empty());
}

TEST(United, HoldsBothAndSkipsEmptyOnes) {
  const Window a{0, 0, 9, 4}, b{-3, 2, 5, 20};
  EXPECT_EQ(united(a, b), (Window{-3, 0, 9, 20}));
  EXPECT_EQ(united(a, Window()), a);
  EXPECT_EQ(united(Window(), b), b);
  EXPECT_TRUE(united(Window(), Window()).empty());
}

TEST(Roles, NamesAreFoundAgain) {
  for (const RoleInfo& entry : kRoles) {
    EXPECT_EQ(role_from_name(entry.name), entry.role);
    EXPECT_EQ(info(entry.role).name, entry.name);
    EXPECT_GE(entry.planes, 1);
  }
  EXPECT_EQ(role_from_name("beauty"), std::nullopt);
}

TEST(RoleSet, HoldsWhatWasPutIn) {
  RoleSet set{Role::depth};
  EXPECT_TRUE(set.contains(Role::depth));
  EXPECT_FALSE(set.contains(Role::normal));
  set.insert(RoleSet{Role::normal, Role::ao});
  EXPECT_TRUE(set.contains(Role::depth) && set.contains(Role::normal) && set.contains(Role::ao));
  EXPECT_FALSE(set.contains(Role::ambient));
  EXPECT_TRUE(RoleSet().empty());
  EXPECT_FALSE(set.empty());
}

}  // namespace
}  // namespace aftershade
