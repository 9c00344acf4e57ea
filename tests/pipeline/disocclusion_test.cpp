#include "tests/pipeline/disocclusion.h"

#include <gtest/gtest.h>

#include <iostream>

#include "tests/support/scenes.h"

namespace aftershade::tests {
namespace {

constexpr int kWidth = 240, kHeight = 135;

/// Share of the pixels of `a` that are also in `b`.
double recall(ConstPlaneView a, ConstPlaneView b) {
  double of_a = 0, of_both = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      of_a += a(x, y) > 0 ? 1 : 0;
      of_both += a(x, y) > 0 && b(x, y) > 0 ? 1 : 0;
    }
  return of_both / of_a;
}

/// A bar over columns 10 to 19 that moves by 8 pixels a frame.
Frame bar_frame(float background_x) {
  Frame frame;
  for (const Role role : {Role::velocity_prev, Role::velocity_next})
    for (int axis = 0; axis < 2; ++axis) frame.planes(role).emplace_back(40, 6);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 40; ++x) {
      const float v = x >= 10 && x < 20 ? 8 : background_x;
      frame.planes(Role::velocity_prev)[0](x, y) = -v;
      frame.planes(Role::velocity_next)[0](x, y) = v;
    }
  return frame;
}

TEST(DisocclusionOfAFile, IsTheStripThatAMovingBarLeaves) {
  // Within a quarter of a frame to either side the bar leaves 2 pixels: at its left later, at its right before.
  const Plane mask = disocclusion_of(bar_frame(0), 0.5, 64);
  for (int x = 0; x < 40; ++x) EXPECT_EQ(mask(x, 3), x == 10 || x == 11 || x == 18 || x == 19 ? 1 : 0) << x;
  // Where all moves alike only the image's border lets something in.
  const Plane whole = disocclusion_of(bar_frame(8), 0.5, 64);
  for (int x = 0; x < 40; ++x) EXPECT_EQ(whole(x, 3), x < 2 || x >= 38 ? 1 : 0) << x;
  EXPECT_EQ(share_of(disocclusion_of(bar_frame(0), 0, 4)), 0) << "a closed shutter";
  Frame unknown = bar_frame(0);
  for (int y = 0; y < 6; ++y)
    for (int x = 10; x < 20; ++x) unknown.planes(Role::velocity_next)[0](x, y) = std::nanf("");
  EXPECT_EQ(share_of(disocclusion_of(unknown, 0.5, 4)), 0) << "of unknown motion nothing is known to be left";
}

/// A box moves by 0.1 m a frame before a wall, seen from so far that 0.1 m are 8 pixels at its depth.
Scene box_before_wall() {
  Scene scene{"box", "", {}, {}, {}};
  const double metre_px = 80;
  scene.camera.orthographic_width_m = kWidth / metre_px;
  scene.camera.eye.origin = {0, 0, 5}, scene.camera.target.origin = {0, 0, 0};
  scene.objects.push_back({Box{{2, 2, 0.1}}, {}, {.origin = {0, 0, -1}}});
  scene.objects.push_back({Box{{0.25, 0.25, 0.1}}, {}, {.origin = {0, 0, 0}, .velocity = {0.1, 0, 0}}});
  return scene;
}

TEST(DisocclusionTruth, IsTheStripThatAMovingBoxLeaves) {
  const Scene scene = box_before_wall();
  const Plane mask = disocclusion_truth(scene, 0, 0.5, 64, kWidth, kHeight);
  for (int x = 0; x < kWidth; ++x) {
    const bool left = x >= 100 && x < 102, right = x >= 138 && x < 140;  // the box covers columns 100 to 139
    EXPECT_EQ(mask(x, kHeight / 2), left || right ? 1 : 0) << x;
    EXPECT_EQ(mask(x, 20), 0) << "above the box";
  }
  EXPECT_EQ(share_of(disocclusion_truth(scene, 0, 0, 4, kWidth, kHeight)), 0);
}

TEST(DisocclusionOfAFile, AgreesWithTheTruthOfTheScenes) {
  // The columns' camera uncovers strips of a fraction of a pixel everywhere.
  for (const auto& [name, least] : {std::pair{"crossing", 0.85}, {"columns", 0.45}, {"trail", 0.95}}) {
    const Scene& scene = find_scene(name);
    const Plane truth = disocclusion_truth(scene, 4, 0.5, 16, kWidth, kHeight);
    const Frame frame = render(scene, 4, {kWidth, kHeight, 1}, {Role::velocity_prev, Role::velocity_next}, false);
    const Plane mask = disocclusion_of(frame, 0.5, 64);
    std::cout << name << ": " << 100 * share_of(truth) << " % are uncovered; of these the file tells "
              << 100 * recall(truth, mask) << " %, and " << 100 * recall(mask, truth) << " % of what it tells are\n";
    EXPECT_GT(share_of(truth), 0.001);
    EXPECT_GT(recall(mask, truth), 0.85);
    EXPECT_GT(recall(truth, mask), least);
  }
}

}  // namespace
}  // namespace aftershade::tests
