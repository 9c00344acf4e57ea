// What both literal methods must do: agree with the papers, and survive what the papers do not speak of.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>

#include "core/motionblur/jitter.h"
#include "core/parallel/rows.h"
#include "tests/motionblur/literal_reference.h"

namespace aftershade::tests {
namespace {

using motionblur::Guertin2014Params;
using motionblur::Mcguire2012Params;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

bool same_bits(const Plane& a, const Plane& b) {
  for (int y = 0; y < a.height(); ++y)
    if (std::memcmp(a.row(y), b.row(y), sizeof(float) * static_cast<size_t>(a.width())) != 0) return false;
  return a.width() == b.width() && a.height() == b.height();
}

BlurScene patchy_scene(Window window, float fastest) {
  return make_blur_scene(
      window, [&](int x, int y) { return patchy_pixel(x + window.min_x + 100, y + window.min_y + 100, fastest); });
}

template <class Params>
void expect_like_reference(const Params& params, int radius, const BlurScene& scene) {
  const std::vector<Plane> got = literally_blurred(params, scene);
  const auto expected = reference_blur(params, radius, scene);
  for (size_t c = 0; c < got.size(); ++c)
    for (int y = 0; y < scene.window.height(); ++y)
      for (int x = 0; x < scene.window.width(); ++x) {
        const double truth = expected[c][static_cast<size_t>(y * scene.window.width() + x)];
        if (!std::isfinite(truth)) {
          EXPECT_FALSE(std::isfinite(got[c](x, y)));
          continue;
        }
        ASSERT_NEAR(got[c](x, y), truth, 2e-5 * std::max(1.0, truth)) << "channel " << c << " at " << x << ", " << y;
      }
}

/// Variants of a method's parameters, all at this radius, the usual ones first.
std::vector<Mcguire2012Params> variants(const Mcguire2012Params& usual) {
  std::vector<Mcguire2012Params> out(4, usual);
  out[1].taps = 3;
  out[2].taps = 41;
  out[3].soft_depth_extent_m = 1;
  return out;
}
std::vector<Guertin2014Params> variants(const Guertin2014Params& usual) {
  std::vector<Guertin2014Params> out(8, usual);
  out[1].taps = 2;
  out[2].taps = 60;
  out[3].tap_jitter = 0.2F;
  out[4].tile_jitter = 2;
  out[5].centre_divisor = 4;
  out[6].slow_px = 6;
  out[7].split = motionblur::TapSplit::variance;
  return out;
}

template <class Params>
class LiteralBlur : public testing::Test {
 protected:
  static std::vector<Plane> blurred(float radius, const BlurScene& scene) {
    return literally_blurred(literal<Params>(radius), scene);
  }
};
using Methods = testing::Types<Mcguire2012Params, Guertin2014Params>;
TYPED_TEST_SUITE(LiteralBlur, Methods);

TYPED_TEST(LiteralBlur, AgreesWithThePaperForAllParameters) {
  const BlurScene scene = patchy_scene({-5, 3, 57, 44}, 9);
  const std::vector<TypeParam> all = variants(literal<TypeParam>(9));
  const std::vector<Plane> usual = literally_blurred(all[0], scene);
  for (size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE("variant " + std::to_string(i));
    expect_like_reference(all[i], 9, scene);
    EXPECT_EQ(same_bits(literally_blurred(all[i], scene)[0], usual[0]), i == 0) << "the parameter counts";
  }
}

TYPED_TEST(LiteralBlur, AgreesWithThePaperOnHoles) {
  BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  scene.channels[0](20, 20) = kNan;
  scene.channels[2](31, 11) = kInf;
  scene.channels[3](5, 5) = -kInf;
  for (int x = 0; x < 48; ++x) {
    scene.depth(x, 10) = kInf;
    scene.depth(x, 11) = kNan;
    scene.depth(x, 12) = 0;
    scene.depth(x, 13) = -1;
  }
  expect_like_reference(literal<TypeParam>(9), 9, scene);
}

TYPED_TEST(LiteralBlur, ANanStaysWhereItIs) {
  BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  for (const float bad : {kNan, kInf, std::numeric_limits<float>::max()}) {
    scene.channels[1](20, 20) = bad;
    const std::vector<Plane> out = this->blurred(9, scene);
    for (size_t c = 0; c < out.size(); ++c)
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 48; ++x)
          if (x == 20 && y == 20)
            EXPECT_EQ(std::memcmp(&scene.channels[c].row(y)[x], &out[c].row(y)[x], sizeof(float)), 0);
          else
            EXPECT_LT(std::abs(out[c](x, y)), 10);
  }
}

TYPED_TEST(LiteralBlur, WhatDoesNotMoveKeepsItsBits) {
  const BlurScene still = make_blur_scene({0, 0, 63, 47}, [](int x, int y) {
    return BlurPixel{1, 0.5F, 0, {noise(x, y, 1, 0, 1)}};
  });
  EXPECT_TRUE(same_bits(this->blurred(8, still)[0], still.channels[0]));
}

TYPED_TEST(LiteralBlur, WhatLiesTwoTilesFromMotionKeepsItsBits) {
  const BlurScene scene = make_blur_scene({0, 0, 63, 63}, [](int x, int y) {
    return BlurPixel{1, x < 16 ? 7.0F : 0.0F, 0, {noise(x, y, 1, 0, 1)}};
  });
  const std::vector<Plane> out = this->blurred(8, scene);
  for (int y = 0; y < 64; ++y)
    for (int x = 24; x < 64; ++x) EXPECT_EQ(out[0](x, y), scene.channels[0](x, y));
  int changed = 0;
  for (int x = 0; x < 16; ++x) changed += out[0](x, 30) != scene.channels[0](x, 30);
  EXPECT_GT(changed, 14);
}

TYPED_TEST(LiteralBlur, AUniformColourStaysToTheLastPixel) {
  const BlurScene scene = make_blur_scene({-3, 2, 60, 50}, [](int x, int y) {
    BlurPixel pixel = patchy_pixel(x, y, 9);
    pixel.colour = {0.18F, 1, 1e-4F, 1000};
    return pixel;
  });
  const std::vector<Plane> out = this->blurred(9, scene);
  for (size_t c = 0; c < out.size(); ++c) EXPECT_TRUE(same_bits(out[c], scene.channels[c])) << "also at the borders";
}

// A border that is repeated smears: the last column would count for half of all taps.
TYPED_TEST(LiteralBlur, TapsOutsideTheImageAreDroppedWithTheirWeight) {
  const BlurScene scene = make_blur_scene({0, 0, 63, 31}, [](int x, int) {
    return BlurPixel{1, 8, 0, {x == 63 ? 1.0F : 0.0F}};
  });
  const std::vector<Plane> out = this->blurred(8, scene);
  for (int y = 0; y < 32; ++y) EXPECT_LT(out[0](63, y), 0.3F);
}

TYPED_TEST(LiteralBlur, PremultipliedColourKeepsItsRatioToAlpha) {
  const float colour[3] = {0.8F, 0.4F, 0.2F};
  const BlurScene scene = make_blur_scene({0, 0, 79, 59}, [&](int x, int y) {
    const bool object = (x - 40) * (x - 40) + (y - 30) * (y - 30) < 225;
    const float a = object ? 1.0F : 0.0F;
    return BlurPixel{object ? 2.0F : kInf,
                     object ? 6.5F : 0.0F,
                     object ? -3.1F : 0.0F,
                     {colour[0] * a, colour[1] * a, colour[2] * a, a}};
  });
  const std::vector<Plane> out = this->blurred(9, scene);
  int partly = 0;
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) {
      const float alpha = out[3](x, y);
      partly += alpha > 0.01F && alpha < 0.99F;
      EXPECT_LE(alpha, 1.0F);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(out[c](x, y), colour[c] * alpha, 1e-6);
    }
  EXPECT_GT(partly, 200);
}

TYPED_TEST(LiteralBlur, MoreThanFourChannelsShareTheirWeights) {
  BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  const std::vector<Plane> four = this->blurred(9, scene);
  for (const size_t c : {3U, 0U, 1U}) scene.channels.push_back(copy_of(scene.channels[c]));
  const std::vector<Plane> seven = this->blurred(9, scene);
  ASSERT_EQ(seven.size(), 7U);
  for (size_t c = 0; c < 7; ++c) EXPECT_TRUE(same_bits(seven[c], four[c < 4 ? c : (c + 3) % 4]));
}

TYPED_TEST(LiteralBlur, WithoutDepthEverythingIsAtOneDepth) {
  BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) scene.depth(x, y) = 4;
  const std::vector<Plane> flat = this->blurred(9, scene);
  scene.depth = Plane();
  EXPECT_TRUE(same_bits(this->blurred(9, scene)[0], flat[0]));
}

TYPED_TEST(LiteralBlur, ThreadsDoNotMatter) {
  const BlurScene scene = patchy_scene({0, 0, 99, 79}, 12);
  set_thread_count(1);
  const std::vector<Plane> one = this->blurred(12, scene);
  set_thread_count(4);
  const std::vector<Plane> four = this->blurred(12, scene);
  set_thread_count(0);
  for (size_t c = 0; c < one.size(); ++c) EXPECT_TRUE(same_bits(one[c], four[c]));
}

TYPED_TEST(LiteralBlur, TilesAndJitterFollowAbsoluteCoordinates) {
  const int radius = 7, margin = 4 * radius;  // a pixel may take a tile beside its own, whose neighbours reach on
  const Window whole{-20, -10, 99, 89}, part{-7, 4, 80, 81};
  const std::vector<Plane> a = this->blurred(radius, patchy_scene(whole, radius));
  const std::vector<Plane> b = this->blurred(radius, patchy_scene(part, radius));
  for (int y = part.min_y + margin; y <= part.max_y - margin; ++y)
    for (int x = part.min_x + margin; x <= part.max_x - margin; ++x)
      EXPECT_EQ(a[0](x - whole.min_x, y - whole.min_y), b[0](x - part.min_x, y - part.min_y));
}

// A single layer in uniform motion. Each pixel's weights sum to 1, but pixels differ in their shift, so that light is
// kept on the mean only; spread over n pixels and lights, what is lost or won falls with the root of n.
TYPED_TEST(LiteralBlur, OneMovingLayerKeepsItsLightOnTheMean) {
  constexpr int kColumns = 31, kRows = 17, kMargin = 24;
  const Window window{0, 0, 16 * kColumns + 2 * kMargin, 16 * kRows + 2 * kMargin};
  const BlurScene scene = make_blur_scene(window, [](int x, int y) {
    return BlurPixel{3, 13.3F, -7.1F, {x % kColumns == 5 && y % kRows == 3 ? 10.0F : 0.01F, noise(x, y, 1, 0, 1)}};
  });
  const std::vector<Plane> out = this->blurred(20, scene);
  for (size_t c = 0; c < 2; ++c) {
    double before = 0, after = 0, brightest = 0;
    for (int y = kMargin; y < kMargin + 16 * kRows; ++y)
      for (int x = kMargin; x < kMargin + 16 * kColumns; ++x) {
        before += scene.channels[c](x, y);
        after += out[c](x, y);
        brightest = std::max(brightest, double{out[c](x, y)});
      }
    std::cout << TypeParam::method << (c == 0 ? ", lights: " : ", noise: ") << after / before - 1
              << " of the light won\n";
    EXPECT_LT(brightest, c == 0 ? 4 : 1) << "the light is spread";
    EXPECT_NEAR(after / before, 1, c == 0 ? 0.01 : 0.001);
  }
}

TYPED_TEST(LiteralBlur, TableReachesEveryMember) {
  using params::Kind;
  const TypeParam usual;
  for (const params::Record& record : TypeParam::table()) {
    TypeParam changed;
    params::Json value;
    switch (record.kind) {
      case Kind::boolean:
        value = !record.default_value.get<bool>();
        break;
      case Kind::choice:
        value = record.choices[record.default_value == record.choices[0] ? 1 : 0];
        break;
      case Kind::text:
        value = "some";
        break;
      default:
        value = record.range.max;
        if (record.kind == Kind::integer) value = static_cast<int>(record.range.max);
    }
    params::read(TypeParam::table(), &changed, {{record.key, value}}, "test");
    EXPECT_FALSE(changed == usual) << record.key;
    EXPECT_EQ(record.get(&usual), record.default_value) << record.key;
  }
}

TYPED_TEST(LiteralBlur, RadiusScalesWithTheHeightAndIsRoundedUp) {
  TypeParam params;
  params.max_radius_px = 20;
  const BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  EXPECT_EQ(motionblur::radius_px(params, scene.velocity, 720), 20);
  EXPECT_EQ(motionblur::radius_px(params, scene.velocity, 1080), 30);
  EXPECT_EQ(motionblur::radius_px(params, scene.velocity, 270), 8);
  EXPECT_EQ(motionblur::radius_px(params, scene.velocity, 1), 1);
  EXPECT_EQ(motionblur::limit_px(params, scene.window, 270), 8);
}

TYPED_TEST(LiteralBlur, WithoutARadiusTheLongestMotionIsIt) {
  const BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  const int longest = static_cast<int>(std::ceil(motionblur::longest_px(scene.velocity)));
  ASSERT_GT(longest, 3);
  EXPECT_EQ(motionblur::radius_px(literal<TypeParam>(0), scene.velocity, 720), longest);
  EXPECT_EQ(motionblur::limit_px(literal<TypeParam>(0), scene.window, 720), 48);
  EXPECT_TRUE(same_bits(this->blurred(0, scene)[0], this->blurred(static_cast<float>(longest), scene)[0]));
}

TEST(Mcguire2012, EvenTapsCountAsTheNextOddNumber) {
  const BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  Mcguire2012Params even = literal<Mcguire2012Params>(9), odd = even;
  even.taps = 8;
  odd.taps = 9;
  EXPECT_TRUE(same_bits(literally_blurred(even, scene)[0], literally_blurred(odd, scene)[0]));
}

// Depth is compared by ratio: another unit of length changes no bit.
TEST(Guertin2014, HasNoScaleOfDepth) {
  BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  const std::vector<Plane> metres = literally_blurred(literal<Guertin2014Params>(9), scene);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) scene.depth(x, y) *= 1024;
  EXPECT_TRUE(same_bits(literally_blurred(literal<Guertin2014Params>(9), scene)[0], metres[0]));
}

TEST(Jitter, CoversItsRangeEvenly) {
  const Window window{-7, 11, 120, 138};
  const Plane random = motionblur::random_jitter(window), even = motionblur::even_jitter(window);
  for (const auto& [plane, least, most, tolerance] :
       {std::tuple{&random, -0.5F, 0.5F, 0.15}, {&even, -1.0F, 1.0F, 0.01}}) {
    std::vector<int> count(16);
    for (int y = 0; y < 128; ++y)
      for (int x = 0; x < 128; ++x) {
        const float share = ((*plane)(x, y) - least) / (most - least);
        ASSERT_GE(share, 0);
        ASSERT_LT(share, 1);
        ++count[static_cast<size_t>(16 * share)];
      }
    for (const int n : count) EXPECT_NEAR(n, 1024, 1024 * tolerance);
  }
}

}  // namespace
}  // namespace aftershade::tests
