// What must hold of every blur that follows surfaces along their paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motionblur/gather_plus.h"
#include "core/motionblur/reconstruct.h"
#include "tests/motionblur/moving_scene.h"

namespace aftershade::tests {
namespace {

constexpr motionblur::Shutter kHalfFrame{-0.25F, 0.25F};

struct GatherPlusBlur {
  static std::vector<Plane> blurred(const MovingScene& scene) {
    std::vector<Plane> out;
    std::vector<Plane*> pointers;
    for (const Plane& plane : scene.channels) out.push_back(copy_of(plane));
    for (Plane& plane : out) pointers.push_back(&plane);
    motionblur::gather_plus({}, {&scene.motion, scene.depth, scene.window, kHalfFrame}, pointers);
    return out;
  }
};

struct ReconstructBlur {
  static std::vector<Plane> blurred(const MovingScene& scene) {
    motionblur::SequenceFrame frame{1, scene.window, {}, scene.depth, &scene.motion, {}};
    for (const Plane& plane : scene.channels) frame.channels.push_back(plane);
    return motionblur::reconstruct({}, {frame}, kHalfFrame).channels;
  }
};

template <class Blur>
class PathBlur : public testing::Test {
 protected:
  static std::vector<Plane> blurred(const MovingScene& scene) { return Blur::blurred(scene); }
};
using PathBlurs = testing::Types<GatherPlusBlur, ReconstructBlur>;
TYPED_TEST_SUITE(PathBlur, PathBlurs);

TYPED_TEST(PathBlur, ANanStaysWhereItIs) {
  for (const float bad : {kNan, kInf, -kInf, std::numeric_limits<float>::max()}) {
    MovingScene scene = make_scene(kLayered, layered, 3);
    scene.channels[1](30, 20) = bad;
    const std::vector<Plane> out = this->blurred(scene);
    for (size_t c = 0; c < 3; ++c)
      for (int y = 0; y < 44; ++y)
        for (int x = 0; x < 72; ++x)
          if (x == 30 && y == 20)
            EXPECT_EQ(std::memcmp(&out[c].row(y)[x], &scene.channels[c].row(y)[x], sizeof(float)), 0);
          else
            EXPECT_LE(std::abs(out[c](x, y)), 1.0001F);
  }
}

TYPED_TEST(PathBlur, HolesInTheDepthAreBackground) {
  MovingScene scene = make_scene(kLayered, layered);
  std::vector<Plane> expected;
  for (const float hole : {kInf, kNan, 0.0F, -1.0F}) {
    for (int y = 0; y < 44; ++y)
      for (int x = 0; x < 72; ++x)
        if (layered(x, y).depth == 4) scene.depth(x, y) = hole;
    std::vector<Plane> out = this->blurred(scene);
    if (!expected.empty()) {
      EXPECT_TRUE(same_bits(out[0], expected[0]));
    }
    expected = std::move(out);
  }
  EXPECT_TRUE(same_bits(expected[0], this->blurred(make_scene(kLayered, layered))[0]));
}

TYPED_TEST(PathBlur, DoesNotDependOnTheUnitOfLength) {
  MovingScene scene = make_scene(kLayered, layered);
  const std::vector<Plane> metres = this->blurred(scene);
  for (int y = 0; y < 44; ++y)
    for (int x = 0; x < 72; ++x) scene.depth(x, y) *= 1024;
  EXPECT_TRUE(same_bits(this->blurred(scene)[0], metres[0]));
}

/// 32 px around the picture are more than anything moves.
TYPED_TEST(PathBlur, DoesNotDependOnTheDataWindow) {
  const auto surface = [](int x, int y) { return layered(x, y); };
  const std::vector<Plane> small = this->blurred(make_scene({-45, -37, 100, 90}, surface));
  const std::vector<Plane> large = this->blurred(make_scene({-61, -70, 133, 110}, surface));
  for (int y = 0; y < 44; ++y)
    for (int x = 0; x < 72; ++x) EXPECT_EQ(small[0](x + 45, y + 37), large[0](x + 61, y + 70));
}

TYPED_TEST(PathBlur, NothingDarkensAtBorders) {
  MovingScene scene = make_scene(kLayered, layered);
  for (int y = 0; y < 44; ++y)
    for (int x = 0; x < 72; ++x) scene.channels[0](x, y) = 0.7F;
  EXPECT_TRUE(same_bits(this->blurred(scene)[0], scene.channels[0]));
}

TYPED_TEST(PathBlur, LightOfOneMovingLayerStays) {
  constexpr int kColumns = 31, kRows = 17, kMargin = 24;
  const Window window{0, 0, 4 * kColumns + 2 * kMargin - 1, 4 * kRows + 2 * kMargin - 1};
  MovingScene scene = make_scene(window, [](int, int) { return Surface{3, -53.2F, 28.4F, 53.2F, -28.4F}; });
  for (int y = 0; y < window.height(); ++y)
    for (int x = 0; x < window.width(); ++x)
      scene.channels[0](x, y) = x % kColumns == 5 && y % kRows == 3 ? 10.0F : 0.01F;
  const std::vector<Plane> out = this->blurred(scene);
  double before = 0, after = 0, brightest = 0;
  for (int y = kMargin; y < kMargin + 4 * kRows; ++y)
    for (int x = kMargin; x < kMargin + 4 * kColumns; ++x) {
      before += scene.channels[0](x, y);
      after += out[0](x, y);
      brightest = std::max(brightest, double{out[0](x, y)});
    }
  EXPECT_LT(brightest, 1.5) << "the lights are spread";
  EXPECT_NEAR(after / before, 1, 1e-4);
}

}  // namespace
}  // namespace aftershade::tests
