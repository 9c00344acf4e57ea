#include "core/filter/convergence_blur.h"

#include <gtest/gtest.h>

#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using filter::BilateralBlurParams;

constexpr int kWidth = 60, kHeight = 44;

BilateralBlurParams blur_of(float radius_px) {
  BilateralBlurParams params;
  params.radius_px = radius_px;
  params.reference_height_px = kHeight;
  return params;
}

Plane noisy(float amplitude = 1) {
  Plane out(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      out(x, y) = amplitude * unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
  return out;
}

Picture wall() {
  const Lens lens{60, 60, 30, 22};
  return picture(kWidth, kHeight, lens, slanted_plane(lens, {0.1, 0.3, -1}));
}

/// Two planes 1 m apart.
Picture step() {
  const Lens lens{60, 60, 30, 22};
  return picture(kWidth, kHeight, lens, [](double x, double) { return Hit{x < 30 ? 4.0 : 5.0, Vec3(0, 0, -1)}; });
}

Plane blur(const BilateralBlurParams& params, ConstPlaneView value, ConstPlaneView convergence, const Picture& p) {
  return filter::convergence_blur(params, value, convergence, filter::full_grid(p.surface()), p.surface());
}

/// One pass of the formula, straight.
Plane twin_pass(double radius, const BilateralBlurParams& params, ConstPlaneView value, ConstPlaneView conv,
                const Picture& p, int dx, int dy) {
  Plane out(kWidth, kHeight);
  const Lens lens{p.projection.fx, p.projection.fy, p.projection.cx, p.projection.cy};
  const auto point = [&](int x, int y) { return lens.point(x + 0.5, y + 0.5, p.depth(x, y)); };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double r = radius * (1 - conv(x, y)), sigma = (r + 1) / 2;
      const Vec3 n(p.normals[0](x, y), p.normals[1](x, y), p.normals[2](x, y));
      const double tolerance =
          std::max<double>(params.edge_distance_m, params.edge_footprints / lens.fx * p.depth(x, y));
      double sum = 0, weights = 0;
      for (int t = -10; t <= 10; ++t) {
        const int i = x + t * dx, j = y + t * dy;
        if (i < 0 || j < 0 || i >= kWidth || j >= kHeight) continue;
        const double d = (point(i, j) - point(x, y)).dot(n) / tolerance;
        const double covered = std::clamp(r - std::abs(t) + 1, 0.0, 1.0);
        const double w = std::exp2(-(t * t) / (2 * sigma * sigma) - d * d) * covered * conv(i, j);
        sum += w * value(i, j), weights += w;
      }
      out(x, y) = static_cast<float>(sum / weights);
    }
  return out;
}

TEST(ConvergenceBlur, AgreesWithTheTwin) {
  for (const Picture& p : {wall(), step()}) {
    const Plane value = noisy();
    Plane conv(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) conv(x, y) = 0.05F + 0.95F * static_cast<float>(x * y % 50) / 50;
    const Plane fast = blur(blur_of(5.5F), value, conv, p);
    const Plane exact =
        twin_pass(5.5, blur_of(5.5F), twin_pass(5.5, blur_of(5.5F), value, conv, p, 1, 0), conv, p, 0, 1);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) ASSERT_NEAR(fast(x, y), exact(x, y), 5e-6) << x << ' ' << y;
  }
}

TEST(ConvergenceBlur, LeavesConvergedPixelsToTheBit) {
  const Plane value = noisy();
  EXPECT_EQ(differing_pixels(value, blur(blur_of(6), value, Plane(kWidth, kHeight, 1), wall())), 0);
  EXPECT_EQ(differing_pixels(value, blur(blur_of(0), value, Plane(kWidth, kHeight, 0.1F), wall())), 0);
}

TEST(ConvergenceBlur, SmoothsMoreTheLessHasConverged) {
  const Plane value = noisy();
  double last = 1;
  for (const float conv : {0.9F, 0.5F, 0.1F}) {
    const Plane out = blur(blur_of(6), value, Plane(kWidth, kHeight, conv), wall());
    double variance = 0;
    for (int y = 10; y < kHeight - 10; ++y)
      for (int x = 10; x < kWidth - 10; ++x) variance += std::pow(out(x, y) - 0.5, 2) / (40 * 24);
    EXPECT_LT(variance, last) << conv;
    last = variance;
  }
  EXPECT_LT(last, 0.004);
}

TEST(ConvergenceBlur, ConvergedNeighboursWeighMore) {
  // Left half: converged, AO 0.2; right half: not, AO 1. Pixels at the seam lean to the left.
  Plane value(kWidth, kHeight, 1), conv(kWidth, kHeight, 0.1F), even(kWidth, kHeight, 0.1F);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < 30; ++x) value(x, y) = 0.2F, conv(x, y) = 1;
  EXPECT_LT(blur(blur_of(6), value, conv, wall())(31, 20), blur(blur_of(6), value, even, wall())(31, 20) - 0.1F);
}

TEST(ConvergenceBlur, StopsAtEdgesKeepsAConstantAndIgnoresBackground) {
  Plane value(kWidth, kHeight, 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < 30; ++x) value(x, y) = 0.2F;
  Picture p = step();
  const Plane low(kWidth, kHeight, 0.1F), out = blur(blur_of(6), value, low, p);
  EXPECT_EQ(differing_pixels(value, out), 0);
  const Plane flat(kWidth, kHeight, 0.3333F);
  for (int i = 0; i < 100; ++i) p.depth((i * 37) % kWidth, (i * 13) % kHeight) = i % 2 != 0 ? kInf : kNan;
  EXPECT_EQ(differing_pixels(flat, blur(blur_of(6), flat, low, p)), 0);
  Plane holes = copy_of(flat);
  holes(20, 20) = kNan;
  EXPECT_FLOAT_EQ(blur(blur_of(6), holes, low, p)(22, 20), 0.3333F);
}

TEST(ConvergenceBlur, DoesNotDependOnThreads) {
  const Plane value = noisy(), conv(kWidth, kHeight, 0.3F);
  const Plane one = blur(blur_of(6), value, conv, wall());
  set_thread_count(3);
  EXPECT_EQ(differing_pixels(one, blur(blur_of(6), value, conv, wall())), 0);
  set_thread_count(0);
}

}  // namespace
}  // namespace aftershade::tests
