#include "core/motionblur/scalable_blur.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "core/parallel/rows.h"
#include "tests/motionblur/blur_scene.h"
#include "tests/motionblur/reference_blur.h"

namespace aftershade::tests {
namespace {

using motionblur::Directions;
using motionblur::Jitter;
using motionblur::ScalableBlurParams;

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

void expect_like_reference(const ScalableBlurParams& params, int radius, const BlurScene& scene) {
  const std::vector<Plane> got = blurred(params, scene);
  const auto expected = reference_blur(params, radius, scene);
  for (size_t c = 0; c < got.size(); ++c)
    for (int y = 0; y < scene.window.height(); ++y)
      for (int x = 0; x < scene.window.width(); ++x) {
        const double truth = expected[c][static_cast<size_t>(y * scene.window.width() + x)];
        if (!std::isfinite(truth)) {
          EXPECT_FALSE(std::isfinite(got[c](x, y)));
          continue;
        }
        ASSERT_NEAR(got[c](x, y), truth, 1e-5 * std::max(1.0, truth)) << "channel " << c << " at " << x << ", " << y;
      }
}

TEST(ScalableBlur, AgreesWithTheSlides) {
  const BlurScene scene = patchy_scene({-5, 3, 57, 44}, 9);
  for (const Jitter jitter : {Jitter::checkerboard, Jitter::random4x4})
    for (const Directions directions :
         {Directions::neighbourhood, Directions::alternate, Directions::alternate_literal})
      for (const int taps : {3, 7, 9, 27}) {
        ScalableBlurParams params = unscaled(9);
        params.jitter = jitter;
        params.directions = directions;
        params.taps = taps;
        expect_like_reference(params, 9, scene);
      }
}

TEST(ScalableBlur, AgreesWithTheSlidesForOtherWeights) {
  const BlurScene scene = patchy_scene({0, 0, 47, 39}, 12);
  float ScalableBlurParams::*const weights[] = {
      &ScalableBlurParams::background_weight, &ScalableBlurParams::foreground_weight,
      &ScalableBlurParams::both_moving_weight, &ScalableBlurParams::centre_weight};
  const std::vector<Plane> usual = blurred(unscaled(12), scene);
  for (const auto weight : weights) {
    ScalableBlurParams params = unscaled(12);
    params.*weight = 3;
    expect_like_reference(params, 12, scene);
    EXPECT_FALSE(same_bits(blurred(params, scene)[0], usual[0])) << "the weight counts";
  }
  ScalableBlurParams soft = unscaled(12);
  soft.soft_depth_extent_m = 1;
  expect_like_reference(soft, 12, scene);
}

/// What the slides name to scale for quality, one by one and together.
TEST(ScalableBlur, AgreesWithTheSlidesForEveryQualityKnob) {
  const BlurScene scene = patchy_scene({-5, 3, 57, 44}, 9);
  const std::vector<Plane> usual = blurred(unscaled(9), scene);
  const std::function<void(ScalableBlurParams&)> knobs[] = {
      [](auto& p) { p.directions = Directions::three; },
      [](auto& p) { p.dilation = motionblur::Dilation::directional; },
      [](auto& p) { p.dilation = motionblur::Dilation::line; },
      [](auto& p) { p.passes = 3; },
      [](auto& p) { p.comparison = motionblur::DepthComparison::relative; },
      [](auto& p) { p.velocity_bits = motionblur::VelocityBits::eight; }};
  ScalableBlurParams all = unscaled(9);
  for (const auto& turn : knobs) {
    ScalableBlurParams one = unscaled(9);
    turn(one);
    turn(all);
    expect_like_reference(one, 9, scene);
    EXPECT_FALSE(same_bits(blurred(one, scene)[0], usual[0])) << "the knob counts";
  }
  expect_like_reference(all, 9, scene);
  all.jitter = Jitter::checkerboard;
  all.passes = 2;
  expect_like_reference(all, 9, scene);
}

TEST(ScalableBlur, WithoutALimitItIsThatOfTheLongestVelocity) {
  const BlurScene scene = patchy_scene({0, 0, 57, 44}, 12);
  const auto longest = static_cast<int>(std::ceil(motionblur::longest_px(scene.velocity)));
  ASSERT_GT(longest, 5);
  EXPECT_EQ(motionblur::radius_px(unscaled(0), scene.velocity, 1), longest);
  EXPECT_EQ(motionblur::radius_px(unscaled(30), scene.velocity, 1), 30);
  EXPECT_TRUE(same_bits(blurred(unscaled(0), scene)[0], blurred(unscaled(static_cast<float>(longest)), scene)[0]));
  BlurScene stray = patchy_scene({0, 0, 57, 44}, 12);
  stray.velocity.x(3, 3) = 1e6F;
  EXPECT_EQ(motionblur::radius_px(unscaled(0), stray.velocity, 1), 58) << "no farther than the picture is wide";
  const BlurScene still = make_blur_scene({0, 0, 7, 7}, [](int, int) { return BlurPixel{1, 0, 0, {1}}; });
  EXPECT_EQ(motionblur::radius_px(unscaled(0), still.velocity, 1), 1);
}

TEST(ScalableBlur, TakenLiterallyAlternationKillsTheOuterBlur) {
  const BlurScene scene = make_blur_scene({0, 0, 95, 15}, [](int x, int) {
    const bool object = x < 48;
    return BlurPixel{object ? 1.0F : 5.0F, object ? 20.0F : 0.0F, 0, {object ? 1.0F : 0.0F}};
  });
  const auto coverage = [&](Directions directions) {
    ScalableBlurParams params = unscaled(20);
    params.directions = directions;
    const std::vector<Plane> out = blurred(params, scene);
    double sum = 0;
    for (int y = 4; y < 8; ++y)
      for (int x = 48; x < 52; ++x) sum += out[0](x, y) / 16;
    return sum;
  };
  EXPECT_GT(coverage(Directions::alternate), 0.4);
  EXPECT_LT(coverage(Directions::alternate_literal), 0.06);
}

/// A still pixel between an object that moves across to it and a faster one that moves along the border.
TEST(ScalableBlur, TheTilesOwnMaximumBringsWhatTheNeighboursHides) {
  const BlurScene scene = make_blur_scene({0, 0, 47, 47}, [](int x, int y) {
    const bool object = x >= 18 && x < 21 && y >= 16 && y < 32, faster = x >= 34 && x < 38;
    return BlurPixel{object || faster ? 1.0F : 2.0F, object ? 9.0F : 0, faster ? 14.0F : 0, {object ? 1.0F : 0.0F}};
  });
  ScalableBlurParams params = unscaled(16);
  params.taps = 27;
  const auto light = [&](Directions directions) {
    params.directions = directions;
    const std::vector<Plane> out = blurred(params, scene);
    double sum = 0;
    for (int x = 23; x < 28; ++x) sum += out[0](x, 24);
    return sum;
  };
  EXPECT_EQ(light(Directions::neighbourhood), 0);
  EXPECT_EQ(light(Directions::alternate), 0) << "a still pixel has no direction of its own";
  EXPECT_GT(light(Directions::three), 0.2);
}

TEST(ScalableBlur, SixteenPassesLeaveNoPatternOfTheJitter) {
  const BlurScene scene = make_blur_scene({0, 0, 63, 31}, [](int x, int) {
    return BlurPixel{3, 11, 0, {noise(x, 0, 1, 0, 1)}};
  });
  const auto unevenness = [&](int passes) {
    ScalableBlurParams params = unscaled(12);
    params.passes = passes;
    const std::vector<Plane> out = blurred(params, scene);
    double most = 0;
    for (int x = 0; x < 64; ++x)
      for (int y = 9; y < 13; ++y) most = std::max<double>(most, std::abs(out[0](x, y) - out[0](x, 8)));
    return most;
  };
  EXPECT_GT(unevenness(1), 0.05);
  EXPECT_LT(unevenness(16), 1e-5) << "every pixel has had every jitter";
}

TEST(ScalableBlur, ARelativeComparisonKnowsNoUnitOfLength) {
  const BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  BlurScene large = patchy_scene({0, 0, 47, 39}, 9);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) large.depth(x, y) *= 1024;
  ScalableBlurParams params = unscaled(9);
  EXPECT_FALSE(same_bits(blurred(params, scene)[0], blurred(params, large)[0]));
  params.comparison = motionblur::DepthComparison::relative;
  EXPECT_TRUE(same_bits(blurred(params, scene)[0], blurred(params, large)[0]));
}

TEST(ScalableBlur, AStillPictureKeepsItsBitsInEightBitsToo) {
  const BlurScene still = patchy_scene({0, 0, 47, 39}, 0);
  BlurScene scene = make_blur_scene({0, 0, 47, 39}, [&](int x, int y) {
    return BlurPixel{1, 0, 0, {still.channels[0](x, y)}};
  });
  ScalableBlurParams params = unscaled(18);
  params.velocity_bits = motionblur::VelocityBits::eight;
  EXPECT_TRUE(same_bits(blurred(params, scene)[0], scene.channels[0])) << "0 comes back as K / 255, below half a pixel";
}

TEST(ScalableBlur, AgreesWithTheSlidesOnHoles) {
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
  expect_like_reference(unscaled(9), 9, scene);
}

TEST(ScalableBlur, ANanStaysWhereItIs) {
  BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  for (const float bad : {kNan, kInf, std::numeric_limits<float>::max()}) {
    scene.channels[1](20, 20) = bad;
    const std::vector<Plane> out = blurred(unscaled(9), scene);
    for (size_t c = 0; c < out.size(); ++c)
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 48; ++x)
          if (x == 20 && y == 20)
            EXPECT_EQ(std::memcmp(&scene.channels[c].row(y)[x], &out[c].row(y)[x], sizeof(float)), 0);
          else
            EXPECT_LT(std::abs(out[c](x, y)), 10);
  }
}

TEST(ScalableBlur, EvenTapsCountAsTheNextOddNumber) {
  const BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  ScalableBlurParams even = unscaled(9), odd = unscaled(9);
  even.taps = 8;
  odd.taps = 9;
  EXPECT_TRUE(same_bits(blurred(even, scene)[0], blurred(odd, scene)[0]));
}

TEST(ScalableBlur, WhatDoesNotMoveKeepsItsBits) {
  const BlurScene still = make_blur_scene({0, 0, 63, 47}, [](int x, int y) {
    return BlurPixel{1, 0.5F, 0, {noise(x, y, 1, 0, 1)}};
  });
  EXPECT_TRUE(same_bits(blurred(unscaled(8), still)[0], still.channels[0]));
}

TEST(ScalableBlur, WhatLiesTwoTilesFromMotionKeepsItsBits) {
  const BlurScene scene = make_blur_scene({0, 0, 63, 63}, [](int x, int y) {
    return BlurPixel{1, x < 16 ? 7.0F : 0.0F, 0, {noise(x, y, 1, 0, 1)}};
  });
  const std::vector<Plane> out = blurred(unscaled(8), scene);
  for (int y = 0; y < 64; ++y)
    for (int x = 24; x < 64; ++x) EXPECT_EQ(out[0](x, y), scene.channels[0](x, y));
  int changed = 0;
  for (int x = 0; x < 16; ++x) changed += out[0](x, 30) != scene.channels[0](x, 30);
  EXPECT_GT(changed, 14);
}

TEST(ScalableBlur, AStillObjectStaysSharpBeforeAMovingBackground) {
  const BlurScene scene = make_blur_scene({0, 0, 63, 31}, [](int x, int y) {
    const bool object = x >= 20 && x < 44;
    return BlurPixel{object ? 1.0F : 10.0F,
                     object ? 0.0F : 8.0F,
                     0,
                     {object ? 1.0F + noise(x, y, 1, 0, 1) : noise(x, y, 2, 0, 0.5F)}};
  });
  const std::vector<Plane> out = blurred(unscaled(8), scene);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x)
      if (x >= 20 && x < 44)
        EXPECT_NEAR(out[0](x, y), scene.channels[0](x, y), 1e-6);
      else
        EXPECT_LE(out[0](x, y), 0.5F) << "nothing of the object leaks";
}

TEST(ScalableBlur, AUniformColourStaysToTheLastPixel) {
  const BlurScene scene = make_blur_scene({-3, 2, 60, 50}, [](int x, int y) {
    BlurPixel pixel = patchy_pixel(x, y, 9);
    pixel.colour = {0.18F, 1, 1e-4F, 1000};
    return pixel;
  });
  const std::vector<Plane> out = blurred(unscaled(9), scene);
  for (size_t c = 0; c < out.size(); ++c) EXPECT_TRUE(same_bits(out[c], scene.channels[c])) << "also at the borders";
}

TEST(ScalableBlur, PremultipliedColourKeepsItsRatioToAlpha) {
  const float colour[3] = {0.8F, 0.4F, 0.2F};
  const BlurScene scene = make_blur_scene({0, 0, 79, 59}, [&](int x, int y) {
    const bool object = (x - 40) * (x - 40) + (y - 30) * (y - 30) < 225;
    const float a = object ? 1.0F : 0.0F;
    return BlurPixel{object ? 2.0F : kInf,
                     object ? 6.5F : 0.0F,
                     object ? -3.1F : 0.0F,
                     {colour[0] * a, colour[1] * a, colour[2] * a, a}};
  });
  const std::vector<Plane> out = blurred(unscaled(9), scene);
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

TEST(ScalableBlur, MoreThanFourChannelsShareTheirWeights) {
  BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  const std::vector<Plane> four = blurred(unscaled(9), scene);
  for (const size_t c : {3U, 0U, 1U}) scene.channels.push_back(copy_of(scene.channels[c]));
  const std::vector<Plane> seven = blurred(unscaled(9), scene);
  ASSERT_EQ(seven.size(), 7U);
  for (size_t c = 0; c < 7; ++c) EXPECT_TRUE(same_bits(seven[c], four[c < 4 ? c : (c + 3) % 4]));
}

TEST(ScalableBlur, WithoutDepthEverythingIsAtOneDepth) {
  BlurScene scene = patchy_scene({0, 0, 47, 39}, 9);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 48; ++x) scene.depth(x, y) = 4;
  const std::vector<Plane> flat = blurred(unscaled(9), scene);
  scene.depth = Plane();
  EXPECT_TRUE(same_bits(blurred(unscaled(9), scene)[0], flat[0]));
}

TEST(ScalableBlur, ThreadsDoNotMatter) {
  const BlurScene scene = patchy_scene({0, 0, 99, 79}, 12);
  set_thread_count(1);
  const std::vector<Plane> one = blurred(unscaled(12), scene);
  set_thread_count(4);
  const std::vector<Plane> four = blurred(unscaled(12), scene);
  set_thread_count(0);
  for (size_t c = 0; c < one.size(); ++c) EXPECT_TRUE(same_bits(one[c], four[c]));
}

TEST(ScalableBlur, TilesAndJitterFollowAbsoluteCoordinates) {
  const int radius = 7, margin = 3 * radius;
  const Window whole{-20, -10, 99, 89}, part{-7, 4, 80, 81};
  const std::vector<Plane> a = blurred(unscaled(radius), patchy_scene(whole, radius));
  const std::vector<Plane> b = blurred(unscaled(radius), patchy_scene(part, radius));
  for (int y = part.min_y + margin; y <= part.max_y - margin; ++y)
    for (int x = part.min_x + margin; x <= part.max_x - margin; ++x)
      EXPECT_EQ(a[0](x - whole.min_x, y - whole.min_y), b[0](x - part.min_x, y - part.min_y));
}

TEST(ScalableBlur, GivesTheTilesItUsed) {
  const BlurScene scene = patchy_scene({-5, 3, 57, 44}, 9);
  const auto tiles = motionblur::velocity_tiles(unscaled(9), {scene.depth, &scene.velocity, scene.window, 1});
  const motionblur::HalfVelocity own = motionblur::tile_max(scene.velocity, 9, scene.window),
                                 neighbours = motionblur::neighbour_max(own);
  EXPECT_EQ(tiles.tile_px, 9);
  EXPECT_TRUE(same_bits(tiles.own.x, own.x));
  EXPECT_TRUE(same_bits(tiles.own.y, own.y));
  EXPECT_TRUE(same_bits(tiles.neighbours.x, neighbours.x));
  EXPECT_TRUE(same_bits(tiles.neighbours.y, neighbours.y));
}

TEST(ScalableBlurParams, RadiusScalesWithTheHeightAndIsRoundedUp) {
  ScalableBlurParams dx11;
  EXPECT_EQ(motionblur::max_radius_px(dx11, 1080), 18);
  EXPECT_EQ(motionblur::max_radius_px(dx11, 720), 12);
  EXPECT_EQ(motionblur::max_radius_px(dx11, 2160), 36);
  EXPECT_EQ(motionblur::max_radius_px(dx11, 540), 9);
  EXPECT_EQ(motionblur::max_radius_px(dx11, 541), 10);
  EXPECT_EQ(motionblur::max_radius_px(dx11, 1), 1);
  ScalableBlurParams current_gen;
  current_gen.max_radius_px = 10;
  current_gen.reference_height_px = 720;
  EXPECT_EQ(motionblur::max_radius_px(current_gen, 1080), 15);
  EXPECT_EQ(motionblur::max_radius_px(current_gen, 720), 10);
}

TEST(ScalableBlurParams, TableReachesEveryMember) {
  using params::Kind;
  const ScalableBlurParams usual;
  EXPECT_EQ(ScalableBlurParams::table().size(), 27U);
  for (const params::Record& record : ScalableBlurParams::table()) {
    ScalableBlurParams changed;
    params::Json value = record.kind == Kind::boolean ? params::Json(!record.default_value.get<bool>())
                         : record.kind == Kind::text  ? params::Json("x")
                         : record.kind == Kind::choice
                             ? params::Json(record.choices[record.default_value == record.choices[0] ? 1 : 0])
                             : params::Json(5);
    params::read(ScalableBlurParams::table(), &changed, {{record.key, value}}, "test");
    EXPECT_FALSE(changed == usual) << record.key;
    EXPECT_EQ(record.get(&changed), value) << record.key;
    EXPECT_EQ(record.get(&usual), record.default_value) << record.key;
  }
}

}  // namespace
}  // namespace aftershade::tests
