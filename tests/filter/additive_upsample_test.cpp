#include <gtest/gtest.h>

#include <array>

#include "core/filter/bilateral_upsample.h"
#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

/// SOMA's additive upsampling and the three findings about its printed form (algorithms 5.1).
namespace aftershade::tests {
namespace {

using filter::BilateralUpsampleParams;
using filter::UpsampleWeights;

BilateralUpsampleParams with(UpsampleWeights weights) {
  BilateralUpsampleParams params;
  params.weights = weights;
  return params;
}

/// From algorithms 5.1, in double.
double twin(const BilateralUpsampleParams& params, const Plane& value, const filter::SampleGrid& grid, const Picture& p,
            int x, int y) {
  const bool literal = params.weights == UpsampleWeights::additive_literal;
  const double px = (x - grid.origin_x + 0.5) / 2 - (literal ? 0 : 0.5),
               py = (y - grid.origin_y + 0.5) / 2 - (literal ? 0 : 0.5);
  const double bx = std::floor(px), by = std::floor(py), wx = 1 - (px - bx), wy = 1 - (py - by);
  double sum = 0, weights = 0;
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int tx = static_cast<int>(bx) + i, ty = static_cast<int>(by) + j;
      if (tx < 0 || ty < 0 || tx >= grid.width() || ty >= grid.height() || !std::isfinite(grid.depth(tx, ty))) continue;
      const double gap = std::abs(static_cast<double>(grid.depth(tx, ty)) - static_cast<double>(p.depth(x, y)));
      const double wb = literal ? (i - wx) * (j - wy) : std::abs((i - wx) * (j - wy));
      const double w = wb + 30 * std::max(1e-5, 0.1 - gap);
      sum += w * value(tx, ty);
      weights += w;
    }
  return literal ? std::clamp(sum / weights, 0.0, 1.0) : sum / weights;
}

/// A slope with thin things in front of it and a hole of background.
Picture scene(int origin = -3) {
  const Lens lens{80, 60, 30, 20};
  return picture(
      63, 41, lens,
      [&](double x, double y) {
        if (x > 40 && y > 30) return Hit{};
        Hit hit = meet_plane(lens, x, y, {0.3, 0.5, -0.8}, -3);
        if (std::fmod(x + 2 * y + 700, 7) < 2) hit.z -= 0.9;
        return hit;
      },
      origin, 5);
}

Plane noise_on(const filter::SampleGrid& grid) {
  Plane value(grid.width(), grid.height());
  for (int y = 0; y < value.height(); ++y)
    for (int x = 0; x < value.width(); ++x)
      value(x, y) = unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
  return value;
}

TEST(AdditiveUpsample, AgreesWithTheTwin) {
  for (const UpsampleWeights weights : {UpsampleWeights::additive, UpsampleWeights::additive_literal}) {
    const Picture p = scene();
    const filter::SampleGrid grid = filter::half_grid(p.surface());
    const Plane value = noise_on(grid);
    const Plane out = filter::bilateral_upsample(with(weights), value, grid, p.surface());
    for (int y = 0; y < 41; ++y)
      for (int x = 0; x < 63; ++x) {
        const double exact = std::isfinite(p.depth(x, y)) ? twin(with(weights), value, grid, p, x, y) : 1;
        // Negative weights may nearly cancel, and then amplify rounding.
        ASSERT_NEAR(out(x, y), exact, weights == UpsampleWeights::additive ? 1e-5 : 1e-3) << x << ' ' << y;
      }
  }
}

/// 3x3 blocks with hand-made depths: a pixel of the middle block at (x, y), whose value every texel holds but one.
float at_pixel(UpsampleWeights weights, int x, int y, ConstPlaneView depths, ConstPlaneView values, float own_depth) {
  const Lens lens{80, 80, 3, 3};
  Picture p = picture(6, 6, lens, slanted_plane(lens, {0, 0, -1}));
  p.depth(x, y) = own_depth;
  filter::SampleGrid grid = filter::half_grid(p.surface());
  grid.depth = copy_of(depths);
  return filter::bilateral_upsample(with(weights), values, grid, p.surface())(x, y);
}

TEST(AdditiveUpsample, PrintedWeightsAreNegativeForMixedTexels) {
  // Pixel (2, 2), all four texels on another surface. Printed, they weigh 2.25, -0.75, -0.75, 0.25.
  const std::array<double, 4> printed{2.25, -0.75, -0.75, 0.25}, corrected{0.0625, 0.1875, 0.1875, 0.5625};
  for (int tap = 0; tap < 4; ++tap)
    for (const bool literal : {true, false}) {
      Plane values(3, 3, 0.5F);
      const int first = literal ? 1 : 0;  // the corrected form takes the blocks around the pixel: 0 and 1
      values(first + (tap & 1), first + (tap >> 1)) += 0.125F;
      const float out = at_pixel(literal ? UpsampleWeights::additive_literal : UpsampleWeights::additive, 2, 2,
                                 Plane(3, 3, 9.0F), values, 5);
      const auto& expected = literal ? printed : corrected;
      EXPECT_NEAR((out - 0.5F) / 0.125F, expected[static_cast<size_t>(tap)], 0.02) << tap << literal;
    }
  // Overshoot: a dark texel makes the pixel darker than any texel is.
  Plane values(3, 3, 0.9F);
  values(1, 1) = 0.6F;
  EXPECT_LT(at_pixel(UpsampleWeights::additive_literal, 2, 2, Plane(3, 3, 9.0F), values, 5), 0.3F);
  EXPECT_GE(at_pixel(UpsampleWeights::additive, 2, 2, Plane(3, 3, 9.0F), values, 5), 0.6F);
}

TEST(AdditiveUpsample, AddedWeightsLeakSixPercentAndFlattenWhatMultipliedOnesDoNot) {
  // The nearest texel, the pixel's own block's, is on another surface; the other three are on the pixel's.
  Plane depths(3, 3, 5.0F), values(3, 3, 0.0F);
  depths(1, 1) = 9;
  values(1, 1) = 1;
  EXPECT_NEAR(at_pixel(UpsampleWeights::additive, 2, 2, depths, values, 5), 0.5625 / 10, 1e-3);
  EXPECT_LT(at_pixel(UpsampleWeights::multiplicative, 2, 2, depths, values, 5), 1e-3F);
  // On one flat surface the four weigh 3.56, 3.19, 3.19, 3.06: nearly a mean of 2x2.
  const Plane flat(3, 3, 5.0F);
  EXPECT_NEAR(at_pixel(UpsampleWeights::additive, 2, 2, flat, values, 5), 3.5625 / 13, 1e-5);
}

TEST(AdditiveUpsample, PrintedPositionsShiftThePictureByAPixel) {
  // A ramp on a flat wall, one per pixel, known at the centres of the blocks.
  const Lens lens{80, 80, 30, 20};
  const Picture p = picture(64, 40, lens, slanted_plane(lens, {0, 0, -1}));
  const filter::SampleGrid grid = filter::half_grid(p.surface());
  const auto mean_shift = [&](UpsampleWeights weights, bool vertical) {
    Plane value(grid.width(), grid.height());
    for (int y = 0; y < value.height(); ++y)
      for (int x = 0; x < value.width(); ++x) value(x, y) = static_cast<float>(2 * (vertical ? y : x) + 1) / 64;
    const Plane out = filter::bilateral_upsample(with(weights), value, grid, p.surface());
    double sum = 0;
    for (int y = 8; y < 32; ++y)
      for (int x = 8; x < 56; ++x) sum += 64 * out(x, y) - ((vertical ? y : x) + 0.5);
    return sum / (24 * 48);
  };
  for (const bool vertical : {false, true}) {
    EXPECT_NEAR(mean_shift(UpsampleWeights::additive_literal, vertical), 1, 0.01);
    EXPECT_NEAR(mean_shift(UpsampleWeights::additive, vertical), 0, 0.01);
  }
}

TEST(AdditiveUpsample, AConstantStaysTheSameToTheBitAndNanDoesNotSpread) {
  for (const UpsampleWeights weights : {UpsampleWeights::additive, UpsampleWeights::additive_literal})
    for (const int origin : {-3, 0, 4}) {
      Picture p = scene(origin);
      p.depth(7, 7) = kNan;
      p.depth(20, 9) = -1;
      const filter::SampleGrid grid = filter::half_grid(p.surface());
      Plane value(grid.width(), grid.height(), 0.3771F);
      const Plane out = filter::bilateral_upsample(with(weights), value, grid, p.surface());
      for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 63; ++x) {
          const bool background = !(std::isfinite(p.depth(x, y)) && p.depth(x, y) > 0);
          ASSERT_EQ(out(x, y), background ? 1.0F : 0.3771F) << x << ' ' << y;
        }
      for (int i = 0; i < 40; ++i) value((i * 5) % grid.width(), (i * 3) % grid.height()) = i % 2 ? kNan : kInf;
      const Plane spoiled = filter::bilateral_upsample(with(weights), value, grid, p.surface());
      for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 63; ++x) ASSERT_TRUE(spoiled(x, y) >= 0.377F && spoiled(x, y) <= 1) << x << ' ' << y;
    }
}

TEST(AdditiveUpsample, IsTheSameToTheBitForAnyUnitOfLengthThreadsAndWindow) {
  const Picture p = scene(), far = scaled(p, 256);
  const filter::SampleGrid grid = filter::half_grid(p.surface()), far_grid = filter::half_grid(far.surface());
  const Plane value = noise_on(grid);
  for (BilateralUpsampleParams params : {with(UpsampleWeights::additive), with(UpsampleWeights::additive_literal)}) {
    set_thread_count(1);
    const Plane metres = filter::bilateral_upsample(params, value, grid, p.surface());
    params.additive_range_m *= 256;
    set_thread_count(7);
    EXPECT_EQ(differing_pixels(metres, filter::bilateral_upsample(params, value, far_grid, far.surface())), 0);
    set_thread_count(0);
  }
  // Windows at an even and at an odd place: pixels whose blocks both have whole.
  const Picture moved = scene(2);  // five pixels further
  const filter::SampleGrid moved_grid = filter::half_grid(moved.surface());
  Plane same(moved_grid.width(), moved_grid.height());
  for (int y = 0; y < same.height(); ++y)
    for (int x = 0; x < same.width(); ++x) same(x, y) = x + 3 < value.width() ? value(x + 3, y) : 0.5F;
  const Plane a = filter::bilateral_upsample(with(UpsampleWeights::additive), value, grid, p.surface());
  const Plane b = filter::bilateral_upsample(with(UpsampleWeights::additive), same, moved_grid, moved.surface());
  for (int y = 0; y < 41; ++y)
    for (int x = 4; x < 50; ++x) ASSERT_EQ(b(x, y), a(x + 5, y)) << x << ' ' << y;
}

}  // namespace
}  // namespace aftershade::tests
