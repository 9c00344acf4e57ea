#include "core/filter/bilateral_blur.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using filter::BilateralBlurParams;

/// Blur as it is at the reference height.
BilateralBlurParams blur_of(float radius, int height) {
  BilateralBlurParams p;
  p.radius_px = radius;
  p.reference_height_px = static_cast<float>(height);
  return p;
}

Plane noise(int width, int height) {
  Plane out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out(x, y) = unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
  return out;
}

/// One pass written from the header's formula.
Plane twin_pass(const BilateralBlurParams& params, const Plane& value, const filter::SampleGrid& grid, const Picture& p,
                const Lens& lens, int dx, int dy) {
  const double radius = params.radius_px * static_cast<float>(p.display_height) / params.reference_height_px;
  const double sigma = (radius + 1) / 2;
  Plane out(value.width(), value.height());
  const auto pixel = [&](int x, int y) {
    return grid.step == 1 ? std::pair(x, y)
                          : std::pair(static_cast<int>(grid.pixel_x(x, y)), static_cast<int>(grid.pixel_y(x, y)));
  };
  const auto point = [&](int x, int y) {
    const auto [px, py] = pixel(x, y);
    return lens.point(p.origin_x + px + 0.5, p.origin_y + py + 0.5, p.depth(px, py));
  };
  for (int y = 0; y < value.height(); ++y)
    for (int x = 0; x < value.width(); ++x) {
      const auto [px, py] = pixel(x, y);
      const Vec3 n(p.normals[0](px, py), p.normals[1](px, py), p.normals[2](px, py));
      const double footprint =
          grid.step * (lens.orthographic ? 1.0 : static_cast<double>(grid.depth(x, y))) / std::min(lens.fx, lens.fy);
      const double tolerance = std::max<double>(params.edge_distance_m, params.edge_footprints * footprint);
      double sum = 0, weights = 0;
      for (int t = -64; t <= 64; ++t) {
        const int tx = x + t * dx, ty = y + t * dy;
        const double share = std::clamp(radius - std::abs(t) + 1, 0.0, 1.0);  // of the texel that the radius covers
        if (tx < 0 || ty < 0 || tx >= value.width() || ty >= value.height() || !std::isfinite(grid.depth(tx, ty)))
          continue;
        const double d = (point(tx, ty) - point(x, y)).dot(n) / tolerance;
        const double w = share * std::exp2(-t * t / (2 * sigma * sigma) - d * d);
        sum += w * value(tx, ty);
        weights += w;
      }
      out(x, y) = std::isfinite(grid.depth(x, y)) ? static_cast<float>(sum / weights) : value(x, y);
    }
  return out;
}

TEST(BilateralBlur, AgreesWithTheTwin) {
  for (const bool half : {false, true})
    for (const bool orthographic : {false, true})
      for (const float radius : {0.4F, 2.0F, 4.5F}) {
        const Lens lens{80, 60, 30, 20, orthographic};
        const Picture p = picture(
            63, 41, lens,
            [&](double x, double y) {
              if (x > 40 && y > 30) return Hit{};
              Hit hit = meet_plane(lens, x, y, {0.3, 0.5, -0.8}, -3);
              if (x > 25 && x < 40) hit.z += 0.12 * std::sin(y);
              return hit;
            },
            -3, 5);
        const filter::SampleGrid grid = half ? filter::half_grid(p.surface()) : filter::full_grid(p.surface());
        const Plane value = noise(grid.width(), grid.height());
        BilateralBlurParams params = blur_of(radius, 41);
        params.edge_distance_m = radius < 3 ? 0.05F : 0.3F;  // less, and more, than two footprints
        const Plane fast = filter::bilateral_blur(params, value, grid, p.surface());
        const Plane slow = twin_pass(params, twin_pass(params, value, grid, p, lens, 1, 0), grid, p, lens, 0, 1);
        for (int y = 0; y < fast.height(); ++y)
          for (int x = 0; x < fast.width(); ++x)
            ASSERT_NEAR(fast(x, y), slow(x, y), 2e-4) << half << orthographic << radius;
      }
}

TEST(BilateralBlur, AConstantStaysTheSameToTheBit) {
  const Lens lens{80, 80, 30, 20};
  const Picture p = picture(61, 41, lens, slanted_plane(lens));
  const Plane constant(61, 41, 0.7123F);
  EXPECT_EQ(differing_pixels(constant, filter::bilateral_blur(blur_of(6, 41), constant, filter::full_grid(p.surface()),
                                                              p.surface())),
            0);
}

TEST(BilateralBlur, KeepsADepthEdgeAndCrossesASlope) {
  // Left half near, right half far; the value differs by side.
  const Lens lens{80, 80, 32, 20};
  const auto view = [&](double step) {
    return [=](double x, double y) {
      return x < 32 ? meet_plane(lens, x, y, {0, 0, -1}, -3) : meet_plane(lens, x, y, {0, 0, -1}, -3 - step);
    };
  };
  Plane value(64, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 32; x < 64; ++x) value(x, y) = 1;
  const Picture edge = picture(64, 40, lens, view(1.0)), flat = picture(64, 40, lens, view(0.0));
  const Plane kept = filter::bilateral_blur(blur_of(4, 40), value, filter::full_grid(edge.surface()), edge.surface());
  EXPECT_EQ(differing_pixels(kept, value), 0);
  const Plane mixed = filter::bilateral_blur(blur_of(4, 40), value, filter::full_grid(flat.surface()), flat.surface());
  EXPECT_NEAR(mixed(31, 20) + mixed(32, 20), 1, 1e-5);
  EXPECT_GT(mixed(31, 20), 0.35F);
  // A slope as steep as the edge's step within the blur is one surface all the same.
  const Picture slope = picture(64, 40, lens, [&](double x, double y) {
    return meet_plane(lens, x, y, {0.98, 0, -0.2}, -1.0);
  });
  EXPECT_GT(std::abs(slope.depth(36, 20) - slope.depth(32, 20)), 0.3F);
  const Plane crossed =
      filter::bilateral_blur(blur_of(4, 40), value, filter::full_grid(slope.surface()), slope.surface());
  EXPECT_NEAR(crossed(31, 20), mixed(31, 20), 1e-3);
}

TEST(BilateralBlur, WithoutNormalsComparesDepths) {
  const Lens lens{80, 80, 16, 10};
  Picture p = picture(32, 20, lens, slanted_plane(lens, {0.98, 0, -0.2}));
  const Plane value = noise(32, 20);
  const Plane with = filter::bilateral_blur(blur_of(4, 20), value, filter::full_grid(p.surface()), p.surface());
  for (Plane& plane : p.normals) plane = Plane(32, 20, kNan);
  const Plane without = filter::bilateral_blur(blur_of(4, 20), value, filter::full_grid(p.surface()), p.surface());
  EXPECT_GT(differing_pixels(with, without), 500) << "a slope cannot be told from an edge";
  const Picture frontal = picture(32, 20, lens, slanted_plane(lens, {0, 0, -1}));
  p.depth = copy_of(frontal.depth);
  EXPECT_EQ(differing_pixels(
                filter::bilateral_blur(blur_of(4, 20), value, filter::full_grid(p.surface()), p.surface()),
                filter::bilateral_blur(blur_of(4, 20), value, filter::full_grid(frontal.surface()), frontal.surface())),
            0);
}

TEST(BilateralBlur, BackgroundAndUnknownValuesNeitherGiveNorTake) {
  const Lens lens{80, 80, 16, 10};
  Picture p = picture(32, 20, lens, slanted_plane(lens));
  Plane value(32, 20, 0.5F);
  const float bad[] = {kNan, kInf, 0.0F, -1.0F};
  for (int i = 0; i < 40; ++i) {
    p.depth((i * 7) % 32, (i * 3) % 20) = bad[i % 4];
    value((i * 7) % 32, (i * 3) % 20) = 0.9F;
    value((i * 5 + 1) % 32, (i * 11) % 20) = i % 2 != 0 ? kNan : kInf;
  }
  const Plane out = filter::bilateral_blur(blur_of(4, 20), value, filter::full_grid(p.surface()), p.surface());
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool background = !(std::isfinite(p.depth(x, y)) && p.depth(x, y) > 0);
      if (background)
        EXPECT_EQ(out(x, y), std::isfinite(value(x, y)) ? value(x, y) : 1.0F);
      else
        EXPECT_NEAR(out(x, y), 0.5F, 1e-6) << x << ' ' << y;
    }
}

double variance(ConstPlaneView plane, int margin) {
  double sum = 0, squares = 0, n = 0;
  for (int y = margin; y < plane.height - margin; ++y)
    for (int x = margin; x < plane.width - margin; ++x, ++n) {
      sum += plane(x, y);
      squares += std::pow(plane(x, y), 2);
    }
  return squares / n - std::pow(sum / n, 2);
}

TEST(BilateralBlur, HidesTheFourByFourPattern) {
  const Lens lens{80, 80, 32, 32};
  const Picture p = picture(64, 64, lens, slanted_plane(lens));
  Plane pattern(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) pattern(x, y) = kBayer4x4[static_cast<size_t>((y & 3) * 4 + (x & 3))];
  const Plane out = filter::bilateral_blur(blur_of(4, 64), pattern, filter::full_grid(p.surface()), p.surface());
  const double left = std::sqrt(variance(out, 8) / variance(pattern, 8));
  std::printf("4x4 pattern: %.4f of its deviation left at radius 4\n", left);
  EXPECT_LT(left, 0.03);
}

TEST(BilateralBlur, AFractionOfAPixelCountsAsMuch) {
  // Continuous in the radius: no jump where a new tap enters.
  const Lens lens{80, 80, 16, 16};
  const Picture p = picture(32, 32, lens, slanted_plane(lens));
  const Plane value = noise(32, 32);
  const auto centre = [&](float radius) {
    return filter::bilateral_blur(blur_of(radius, 32), value, filter::full_grid(p.surface()), p.surface())(16, 16);
  };
  for (const float radius : {1.0F, 2.0F, 5.0F}) {
    EXPECT_NEAR(centre(radius + 1e-3F), centre(radius), 2e-3);
    EXPECT_NEAR(centre(radius - 1e-3F), centre(radius), 2e-3);
  }
  EXPECT_EQ(centre(0), value(16, 16));
}

TEST(BilateralBlur, RadiusScalesWithTheDisplayHeight) {
  const Lens lens{80, 80, 16, 16};
  Picture p = picture(32, 32, lens, slanted_plane(lens));
  const Plane value = noise(32, 32);
  const Plane four = filter::bilateral_blur(blur_of(4, 32), value, filter::full_grid(p.surface()), p.surface());
  p.display_height = 64;
  EXPECT_EQ(differing_pixels(
                four, filter::bilateral_blur(blur_of(2, 32), value, filter::full_grid(p.surface()), p.surface())),
            0);
}

TEST(BilateralBlur, NeverShrinksBelowThePatternItHides) {
  const Lens lens{80, 80, 16, 16};
  Picture p = picture(32, 32, lens, slanted_plane(lens));
  const Plane value = noise(32, 32);
  const auto blurred = [&](float radius, int height) {
    p.display_height = height;
    return filter::bilateral_blur(blur_of(radius, 1080), value, filter::full_grid(p.surface()), p.surface());
  };
  EXPECT_EQ(differing_pixels(blurred(4, 135), blurred(2, 1080)), 0);
  EXPECT_EQ(differing_pixels(blurred(1, 135), blurred(1, 1080)), 0) << "as small as asked for, no smaller";
  EXPECT_GT(differing_pixels(blurred(1, 2160), blurred(1, 1080)), 0);
}

TEST(BilateralBlur, IsTheSameToTheBitForAnyUnitOfLengthAndThreads) {
  for (const bool orthographic : {false, true}) {
    const Lens lens{80, 70, 30, 20, orthographic};
    const Picture p = picture(63, 41, lens, slanted_plane(lens)), far = scaled(p, 256);
    BilateralBlurParams params = blur_of(3.3F, 41);
    const Plane value = noise(63, 41);
    set_thread_count(1);
    const Plane metres = filter::bilateral_blur(params, value, filter::full_grid(p.surface()), p.surface());
    params.edge_distance_m *= 256;
    set_thread_count(7);
    EXPECT_EQ(differing_pixels(metres,
                               filter::bilateral_blur(params, value, filter::full_grid(far.surface()), far.surface())),
              0);
    set_thread_count(0);
  }
}

}  // namespace
}  // namespace aftershade::tests
