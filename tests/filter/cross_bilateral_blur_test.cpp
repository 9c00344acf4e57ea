#include "core/filter/cross_bilateral_blur.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using filter::AoFetch;
using filter::CrossBilateralBlurParams;
using filter::KernelSampling;
using filter::SampleGrid;

constexpr auto kSamplings = {KernelSampling::adaptive, KernelSampling::adaptive_exact_weights,
                             KernelSampling::brute_force};

/// Radius in pixels, whatever the height of the test's image.
CrossBilateralBlurParams blur_of(float radius, int height, KernelSampling sampling = KernelSampling::adaptive) {
  CrossBilateralBlurParams p;
  p.radius_px = radius;
  p.reference_height_px = static_cast<float>(height);
  p.sampling = sampling;
  return p;
}

Plane noise(int width, int height) {
  Plane out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out(x, y) = unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
  return out;
}

/// Shares of the pixels at offsets -8 to 8 in BlurX of a wall that faces the camera.
std::array<double, 17> kernel_of(const CrossBilateralBlurParams& params) {
  const Plane depth(33, 1, 5.0F);
  std::array<double, 17> shares{};
  for (int r = -8; r <= 8; ++r) {
    Plane impulse(33, 1);
    impulse(16 + r, 0) = 1;
    shares[static_cast<size_t>(r + 8)] = filter::cross_bilateral_blur_x(params, impulse, {}, depth, 1).ao(16, 0);
  }
  return shares;
}

struct KernelFigures {
  double std_px = 0, noise_gain = 0;
};
KernelFigures figures(const std::array<double, 17>& shares) {
  KernelFigures out;
  for (int r = -8; r <= 8; ++r) {
    const double share = shares[static_cast<size_t>(r + 8)];
    out.std_px += share * r * r;
    out.noise_gain += share * share;
  }
  return {std::sqrt(out.std_px), std::sqrt(out.noise_gain)};
}

TEST(CrossBilateralBlur, HasTheKernelOfTheListing) {
  // Weights, deviation and noise gain of algorithms 10, from the listing's formula by hand.
  const auto row = [](KernelSampling sampling, std::array<double, 9> weights, double std_px, double noise_gain) {
    const auto shares = kernel_of(blur_of(8, 1, sampling));
    for (int r = 0; r <= 8; ++r)
      for (const int side : {-1, 1})
        EXPECT_NEAR(shares[static_cast<size_t>(8 + side * r)] / shares[8], weights[static_cast<size_t>(r)], 6e-4) << r;
    EXPECT_NEAR(figures(shares).std_px, std_px, 6e-4);
    EXPECT_NEAR(figures(shares).noise_gain, noise_gain, 6e-4);
  };
  row(KernelSampling::brute_force, {1, .983, .934, .857, .760, .652, .540, .432, .334}, 4.144, .255);
  row(KernelSampling::adaptive, {1, .983, .934, .857, .760, .326, .326, .216, .216}, 3.669, .275);
  row(KernelSampling::adaptive_exact_weights, {1, .983, .934, .857, .760, .596, .596, .382, .382}, 4.169, .255);
}

TEST(CrossBilateralBlur, NeverReachesPastItsRadius) {
  for (const KernelSampling sampling : kSamplings)
    for (const float radius : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F}) {
      const auto shares = kernel_of(blur_of(radius, 1, sampling));
      double sum = 0;
      for (int r = -8; r <= 8; ++r) {
        const double share = shares[static_cast<size_t>(r + 8)];
        EXPECT_EQ(share > 0, std::abs(r) <= static_cast<int>(radius)) << radius << ' ' << r;
        sum += share;
      }
      EXPECT_NEAR(sum, 1, 1e-6);
    }
}

/// The listing in double, one pass: a function of the offset along (dx, dy), clamped to the image.
class Twin {
 public:
  Twin(const CrossBilateralBlurParams& params, ConstPlaneView depth) : params_(params), depth_(depth) {}

  Plane pass(const Plane& ao, int dx, int dy) const {
    Plane out(ao.width(), ao.height(), 1.0F);
    for (int y = 0; y < ao.height(); ++y)
      for (int x = 0; x < ao.width(); ++x)
        if (std::isfinite(z(x, y)) && std::isfinite(ao(x, y))) out(x, y) = static_cast<float>(pixel(ao, x, y, dx, dy));
    return out;
  }

 private:
  double z(int x, int y) const {
    const float d = depth_(x, y);
    return std::isfinite(d) && d > 0 ? static_cast<double>(d) * params_.sharpness_per_m : kInf;
  }
  /// Weighted by w at `weigh_at`, fetched linearly between pixels where `at` is between them.
  void sample(const Plane& ao, int x, int y, int dx, int dy, double at, double weigh_at, double factor, double& sum,
              double& weights) const {
    const auto at_offset = [&](int r, auto&& value) {
      return value(std::clamp(x + r * dx, 0, ao.width() - 1), std::clamp(y + r * dy, 0, ao.height() - 1));
    };
    const auto linear = [&](auto&& value) {
      const int below = static_cast<int>(std::floor(at)), above = static_cast<int>(std::ceil(at));
      return (at_offset(below, value) + at_offset(above, value)) / 2;
    };
    const double sigma = (params_.radius_px + 1) / 2.0, z0 = z(x, y);
    double slope = at_offset(at < 0 ? -1 : 1, [&](int i, int j) { return z(i, j); }) - z0;
    if (!params_.depth_slope || !std::isfinite(slope)) slope = 0;
    const double dz = linear([&](int i, int j) { return z(i, j); }) - z0 - slope * std::abs(at);
    const double w = factor * std::exp2(-weigh_at * weigh_at / (2 * sigma * sigma) - dz * dz);
    if (!(w > 0)) return;
    sum += w * linear([&](int i, int j) { return static_cast<double>(ao(i, j)); });
    weights += w;
  }
  double pixel(const Plane& ao, int x, int y, int dx, int dy) const {
    const double radius = params_.radius_px;
    double sum = 0, weights = 0;
    sample(ao, x, y, dx, dy, 0, 0, 1, sum, weights);
    for (const int side : {-1, 1}) {
      double r = 1;
      const bool brute = params_.sampling == KernelSampling::brute_force;
      for (; r <= (brute ? radius : radius / 2); r += 1) sample(ao, x, y, dx, dy, side * r, r, 1, sum, weights);
      for (; r <= radius; r += 2) {
        const bool exact = params_.sampling == KernelSampling::adaptive_exact_weights;
        sample(ao, x, y, dx, dy, side * (r + 0.5), exact ? r + 0.5 : r, exact ? 2 : 1, sum, weights);
      }
    }
    return sum / weights;
  }
  const CrossBilateralBlurParams& params_;
  ConstPlaneView depth_;
};

/// A slope, a step in depth and a patch of background.
Picture slopes_and_edges(const Lens& lens, int origin_x = 0, int origin_y = 0) {
  return picture(
      63, 41, lens,
      [&lens](double x, double y) {
        if (x > 40 && y > 30) return Hit{};
        Hit hit = meet_plane(lens, x, y, {0.1, 0.3, -0.9}, -3);
        if (x > 25 && x < 40) hit.z += 0.12 * std::sin(y);
        return hit;
      },
      origin_x, origin_y);
}

TEST(CrossBilateralBlur, AgreesWithTheTwin) {
  const Picture p = slopes_and_edges({80, 60, 30, 20});
  for (const KernelSampling sampling : kSamplings)
    for (const bool slope : {false, true})
      for (const float radius : {4.0F, 8.0F}) {
        CrossBilateralBlurParams params = blur_of(radius, 41, sampling);
        params.depth_slope = slope;
        const Plane ao = noise(63, 41);
        const Plane fast = filter::cross_bilateral_blur(params, ao, {}, p.depth, 41);
        const Twin twin(params, p.depth);
        const Plane slow = twin.pass(twin.pass(ao, 1, 0), 0, 1);
        for (int y = 0; y < 41; ++y)
          for (int x = 0; x < 63; ++x) ASSERT_NEAR(fast(x, y), slow(x, y), 2e-5) << x << ' ' << y << ' ' << radius;
      }
}

TEST(CrossBilateralBlur, FetchesHalfResolutionAoByItsBlock) {
  for (const auto& [origin_x, origin_y] : {std::pair(0, 0), {-3, 5}}) {
    const Picture p = slopes_and_edges({80, 60, 30, 20}, origin_x, origin_y);
    const SampleGrid half = filter::half_grid(p.surface());
    const Plane texels = noise(half.width(), half.height());
    const Plane pixels = filter::values_at_pixels(texels, half, p.surface());
    const auto params = blur_of(8, 41);
    EXPECT_EQ(differing_pixels(filter::cross_bilateral_blur(params, texels, half, p.depth, 41),
                               filter::cross_bilateral_blur(params, pixels, {}, p.depth, 41)),
              0);
  }
}

TEST(CrossBilateralBlur, FetchesHalfResolutionAoBetweenBlocks) {
  for (const int origin_x : {0, -1}) {
    SampleGrid grid;
    grid.step = 2;
    grid.origin_x = grid.origin_y = origin_x;
    CrossBilateralBlurParams params = blur_of(0, 8);
    params.ao_fetch = AoFetch::bilinear;
    Plane ramp(6, 6);  // each texel the centre of its block, in pixels: a linear fetch gives each pixel its own centre
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 6; ++x) ramp(x, y) = static_cast<float>(2 * x + 1 + origin_x + 100 * (2 * y + 1 + origin_x));
    const Plane out = filter::cross_bilateral_blur(params, ramp, grid, Plane(10, 10, 3.0F), 8);
    for (int y = 1; y < 9; ++y)
      for (int x = 1; x < 9; ++x)
        ASSERT_NEAR(out(x, y), static_cast<float>(x) + 0.5F + 100 * (static_cast<float>(y) + 0.5F), 1e-3);
    params.ao_fetch = AoFetch::block;
    EXPECT_EQ(filter::cross_bilateral_blur(params, ramp, grid, Plane(10, 10, 3.0F), 8)(4, 4),
              ramp((4 - origin_x) / 2, (4 - origin_x) / 2));
  }
}

TEST(CrossBilateralBlur, AConstantStaysTheSameToTheBit) {
  const Picture p = slopes_and_edges({80, 60, 30, 20});
  const SampleGrid half = filter::half_grid(p.surface());
  for (const KernelSampling sampling : kSamplings)
    for (const AoFetch fetch : {AoFetch::block, AoFetch::bilinear}) {
      CrossBilateralBlurParams params = blur_of(8, 41, sampling);
      params.ao_fetch = fetch;
      const Plane constant(half.width(), half.height(), 0.7123F);
      const Plane out = filter::cross_bilateral_blur(params, constant, half, p.depth, 41);
      for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 63; ++x) ASSERT_EQ(out(x, y), std::isfinite(p.depth(x, y)) ? 0.7123F : 1.0F);
    }
}

TEST(CrossBilateralBlur, KeepsADepthEdgeExceptInsideAPairOfPixels) {
  // Left half near, right half 1 m behind; the AO differs by side.
  Plane ao(64, 24), depth(64, 24, 4.0F);
  for (int y = 0; y < 24; ++y)
    for (int x = 32; x < 64; ++x) ao(x, y) = 1, depth(x, y) = 5;
  CrossBilateralBlurParams params = blur_of(8, 24, KernelSampling::brute_force);
  EXPECT_EQ(differing_pixels(filter::cross_bilateral_blur(params, ao, {}, depth, 24), ao), 0);
  // dz = 3 between two pixels of a pair: the mean is 1.5 away, weighed as one pixel (algorithms 10).
  params.sampling = KernelSampling::adaptive;
  params.sharpness_per_m = 3;
  const Plane leaked = filter::cross_bilateral_blur_x(params, ao, {}, depth, 24).ao;
  EXPECT_GT(
      leaked(26, 12), 10 * [&] {
        params.sampling = KernelSampling::brute_force;
        return filter::cross_bilateral_blur_x(params, ao, {}, depth, 24).ao(26, 12);
      }());
  EXPECT_LT(leaked(26, 12), 0.02F);
}

TEST(CrossBilateralBlur, TheSlopeOptionBlursASlopeLikeAWall) {
  Plane ao(64, 1), wall(64, 1, 4.0F), slope(64, 1);
  for (int x = 0; x < 64; ++x) {
    ao(x, 0) = x < 32 ? 0.0F : 1.0F;
    slope(x, 0) = 4 + 0.125F * static_cast<float>(x);
  }
  CrossBilateralBlurParams params = blur_of(8, 1);
  const auto at_edge = [&](const Plane& depth) {
    return filter::cross_bilateral_blur(params, ao, {}, depth, 1)(31, 0);
  };
  const float on_wall = at_edge(wall);
  EXPECT_GT(on_wall, 0.3F);
  EXPECT_LT(at_edge(slope), 0.1F) << "the seed leaves steep slopes unblurred";
  params.depth_slope = true;
  EXPECT_EQ(at_edge(wall), on_wall);
  EXPECT_NEAR(at_edge(slope), on_wall, 1e-5);
}

TEST(CrossBilateralBlur, BackgroundAndUnknownValuesNeitherGiveNorTake) {
  Plane depth(32, 20, 4.0F), ao(32, 20, 0.5F);
  const float bad[] = {kNan, kInf, 0.0F, -1.0F};
  for (int i = 0; i < 40; ++i) {
    depth((i * 7) % 32, (i * 3) % 20) = bad[i % 4];
    ao((i * 7) % 32, (i * 3) % 20) = 0.9F;
    ao((i * 5 + 1) % 32, (i * 11) % 20) = i % 2 != 0 ? kNan : kInf;
  }
  for (const KernelSampling sampling : kSamplings)
    for (const bool slope : {false, true}) {
      CrossBilateralBlurParams params = blur_of(8, 20, sampling);
      params.depth_slope = slope;
      params.sharpness_per_m = 0;  // not even when all depths count as one
      const Plane out = filter::cross_bilateral_blur(params, ao, {}, depth, 20);
      for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 32; ++x) {
          const bool known = depth(x, y) > 0 && std::isfinite(depth(x, y)) && std::isfinite(ao(x, y));
          EXPECT_EQ(out(x, y), known ? 0.5F : 1.0F) << x << ' ' << y;
        }
    }
}

TEST(CrossBilateralBlur, RadiusScalesWithTheDisplayHeightDownToThePattern) {
  const Plane ao = noise(48, 48), depth(48, 48, 4.0F);
  const auto blurred = [&](float radius, int height) {
    return filter::cross_bilateral_blur(blur_of(radius, 1200), ao, {}, depth, height);
  };
  EXPECT_EQ(differing_pixels(blurred(8, 2400), blurred(16, 1200)), 0);
  EXPECT_EQ(differing_pixels(blurred(8, 1080), blurred(7, 1200)), 0);
  EXPECT_EQ(differing_pixels(blurred(8, 120), blurred(4, 1200)), 0);
  EXPECT_EQ(differing_pixels(blurred(2, 120), blurred(2, 1200)), 0) << "as small as asked for, no smaller";
  EXPECT_EQ(differing_pixels(blurred(0, 1200), ao), 0);
}

TEST(CrossBilateralBlur, IsTheSameToTheBitForAnyUnitOfLengthWindowAndThreads) {
  const Picture p = slopes_and_edges({80, 60, 30, 20}), far = scaled(p, 256);
  CrossBilateralBlurParams params = blur_of(8, 41);
  const Plane ao = noise(63, 41);
  const Plane metres = filter::cross_bilateral_blur(params, ao, {}, p.depth, 41);
  // A window 9 pixels smaller on each side: away from its border nothing changes.
  Plane part_ao(45, 23), part_depth(45, 23);
  copy_at(ao, part_ao, -9, -9);
  copy_at(p.depth, part_depth, -9, -9);
  const Plane part = filter::cross_bilateral_blur(params, part_ao, {}, part_depth, 41);
  for (int y = 8; y < 15; ++y)
    for (int x = 8; x < 37; ++x) ASSERT_EQ(part(x, y), metres(x + 9, y + 9));
  params.sharpness_per_m /= 256;
  set_thread_count(7);
  EXPECT_EQ(differing_pixels(metres, filter::cross_bilateral_blur(params, ao, {}, far.depth, 41)), 0);
  set_thread_count(0);
}

TEST(CrossBilateralBlurParams, TableCoversEveryMember) {
  CrossBilateralBlurParams params;
  params::read(CrossBilateralBlurParams::table(), &params,
               params::Json::parse(R"({"radius_px": 4, "reference_height_px": 720, "sharpness_per_m": 8,
                                       "sampling": "brute-force", "ao_fetch": "bilinear", "depth_slope": true})"),
               "test");
  const CrossBilateralBlurParams want{4, 720, 8, KernelSampling::brute_force, AoFetch::bilinear, true};
  EXPECT_EQ(params, want);
  EXPECT_EQ(CrossBilateralBlurParams::table().size(), 6U);
}

}  // namespace
}  // namespace aftershade::tests
