#include "core/filter/bilateral_upsample.h"

#include <gtest/gtest.h>

#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using filter::BilateralUpsampleParams;

using Value = double (*)(double x, double y);

/// `value` at the picked pixels.
Plane on_grid(const filter::SampleGrid& grid, Value value) {
  Plane out(grid.width(), grid.height());
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x)
      out(x, y) =
          static_cast<float>(value(static_cast<double>(grid.pixel_x(x, y)), static_cast<double>(grid.pixel_y(x, y))));
  return out;
}

/// Written from the header: tent and plane distance over the 3x3 blocks around the pixel's.
double twin(const BilateralUpsampleParams& params, const Plane& value, const filter::SampleGrid& grid, const Picture& p,
            const Lens& lens, int x, int y) {
  const auto point = [&](int px, int py) {
    return lens.point(p.origin_x + px + 0.5, p.origin_y + py + 0.5, p.depth(px, py));
  };
  const Vec3 centre = point(x, y), n(p.normals[0](x, y), p.normals[1](x, y), p.normals[2](x, y));
  const double footprint = 2 * (lens.orthographic ? 1.0 : centre.z) / std::min(lens.fx, lens.fy);
  const double tolerance = std::max<double>(params.edge_distance_m, params.edge_footprints * footprint);
  const int bx = (x - grid.origin_x) / 2, by = (y - grid.origin_y) / 2;
  double sum = 0, weights = 0, nearest = kInf, fallback = 1;
  for (int ty = std::max(0, by - 1); ty <= std::min(grid.height() - 1, by + 1); ++ty)
    for (int tx = std::max(0, bx - 1); tx <= std::min(grid.width() - 1, bx + 1); ++tx) {
      if (!std::isfinite(grid.depth(tx, ty))) continue;
      const int px = static_cast<int>(grid.pixel_x(tx, ty)), py = static_cast<int>(grid.pixel_y(tx, ty));
      const double d = (point(px, py) - centre).dot(n) / tolerance;
      const double w =
          std::max(0.0, 1 - std::abs(px - x) / 3.0) * std::max(0.0, 1 - std::abs(py - y) / 3.0) * std::exp2(-d * d);
      sum += w * value(tx, ty);
      weights += w;
      const double gap = std::abs(static_cast<double>(p.depth(px, py)) - centre.z);
      if (gap < nearest) fallback = value(tx, ty);
      nearest = std::min(nearest, gap);
    }
  return weights < 1e-3 ? fallback : sum / weights;
}

TEST(BilateralUpsample, AgreesWithTheTwin) {
  for (const bool orthographic : {false, true})
    for (const float distance : {0.05F, 0.4F}) {  // less, and more, than two footprints
      const Lens lens{80, 60, 30, 20, orthographic};
      const Picture p = picture(
          63, 41, lens,
          [&](double x, double y) {
            if (x > 40 && y > 30) return Hit{};
            Hit hit = meet_plane(lens, x, y, {0.3, 0.5, -0.8}, -3);
            if (std::fmod(x + 2 * y, 7) < 2) hit.z -= 0.9;  // thin things in front
            return hit;
          },
          -3, 5);
      const filter::SampleGrid grid = filter::half_grid(p.surface());
      const Plane value = on_grid(grid, [](double x, double y) { return 0.5 + 0.5 * std::sin(x * 1.3 + y * y); });
      BilateralUpsampleParams params;
      params.edge_distance_m = distance;
      const Plane fast = filter::bilateral_upsample(params, value, grid, p.surface());
      for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 63; ++x) {
          const double exact = std::isfinite(p.depth(x, y)) ? twin(params, value, grid, p, lens, x, y) : 1;
          ASSERT_NEAR(fast(x, y), exact, 1e-4) << x << ' ' << y << ' ' << orthographic;
        }
    }
}

double ramp(double x, double y) { return 0.2 + 0.004 * x + 0.006 * y; }

TEST(BilateralUpsample, ReconstructsARampOnAPlane) {
  // Facing the camera, the first pixel of every block is picked: inside, the ramp comes back exactly.
  const Lens lens{80, 80, 30, 20};
  const Picture flat = picture(61, 41, lens, slanted_plane(lens, {0, 0, -1}));
  const filter::SampleGrid grid = filter::half_grid(flat.surface());
  const Plane out = filter::bilateral_upsample({}, on_grid(grid, ramp), grid, flat.surface());
  for (int y = 4; y < 36; ++y)
    for (int x = 4; x < 56; ++x) EXPECT_NEAR(out(x, y), ramp(x, y), 1e-5) << x << ' ' << y;
  // On a slope picks alternate between corners of the blocks: within a pixel's worth of the ramp, and half on average.
  const Picture slope = picture(61, 41, lens, slanted_plane(lens));
  const filter::SampleGrid picks = filter::half_grid(slope.surface());
  const Plane sloped = filter::bilateral_upsample({}, on_grid(picks, ramp), picks, slope.surface());
  double sum = 0;
  for (int y = 4; y < 36; ++y)
    for (int x = 4; x < 56; ++x) {
      EXPECT_NEAR(sloped(x, y), ramp(x, y), 0.010) << x << ' ' << y;
      sum += std::abs(sloped(x, y) - ramp(x, y));
    }
  EXPECT_LT(sum / (32 * 52), 0.005);
}

TEST(BilateralUpsample, AConstantStaysTheSameToTheBit) {
  for (const int origin : {0, -1, 3}) {
    const Lens lens{80, 80, 30, 20};
    const Picture p = picture(61, 41, lens, slanted_plane(lens), origin, origin);
    const filter::SampleGrid grid = filter::half_grid(p.surface());
    const Plane out = filter::bilateral_upsample({}, Plane(grid.width(), grid.height(), 0.3771F), grid, p.surface());
    EXPECT_EQ(differing_pixels(out, Plane(61, 41, 0.3771F)), 0) << origin;
  }
}

TEST(BilateralUpsample, KeepsASilhouetteSharp) {
  // A near strip three pixels wide, at an odd place, over a far wall: both layers keep their own value.
  const Lens lens{80, 80, 30, 20};
  const auto on_strip = [](double x) { return x > 21 && x < 24; };
  const Picture p = picture(60, 40, lens, [&](double x, double y) {
    return meet_plane(lens, x, y, {0.1, 0.2, -1}, on_strip(x) ? -2 : -4);
  });
  const filter::SampleGrid grid = filter::half_grid(p.surface());
  const Plane value = on_grid(grid, [](double x, double) { return x >= 21 && x < 24 ? 0.25 : 1.0; });
  const Plane out = filter::bilateral_upsample({}, value, grid, p.surface());
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x) EXPECT_NEAR(out(x, y), on_strip(x + 0.5) ? 0.25 : 1.0, 1e-3) << x << ' ' << y;
}

TEST(BilateralUpsample, TakesTheNearestInDepthWhereNoTexelLiesOnTheSurface) {
  const Lens lens{80, 80, 3, 3};
  Picture p = picture(6, 6, lens, slanted_plane(lens, {0, 0, -1}));
  p.depth(3, 2) = 9;  // of the middle block, whose pick is another pixel
  filter::SampleGrid grid = filter::half_grid(p.surface());
  Plane value(3, 3, 0.5F);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      grid.depth(x, y) = 5;
      grid.pixel_x(x, y) = static_cast<float>(2 * x);
      grid.pixel_y(x, y) = static_cast<float>(2 * y);
    }
  grid.depth(2, 2) = 7;
  p.depth(4, 4) = 7;
  value(2, 2) = 0.125F;
  const Plane out = filter::bilateral_upsample({}, value, grid, p.surface());
  EXPECT_EQ(out(3, 2), 0.125F);
}

TEST(BilateralUpsample, IsOpenOnBackgroundAndUnmovedByNan) {
  const Lens lens{80, 80, 16, 10};
  Picture p = picture(33, 21, lens, slanted_plane(lens), -1, 0);
  const float bad[] = {kNan, kInf, 0.0F, -1.0F};
  for (int i = 0; i < 60; ++i) p.depth((i * 7) % 33, (i * 3) % 21) = bad[i % 4];
  const filter::SampleGrid grid = filter::half_grid(p.surface());
  Plane value(grid.width(), grid.height(), 0.5F);
  for (int i = 0; i < 20; ++i) value((i * 5) % grid.width(), (i * 3) % grid.height()) = i % 2 != 0 ? kNan : kInf;
  const Plane out = filter::bilateral_upsample({}, value, grid, p.surface());
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 33; ++x) {
      const bool background = !(std::isfinite(p.depth(x, y)) && p.depth(x, y) > 0);
      EXPECT_TRUE(background ? out(x, y) == 1 : out(x, y) == 0.5F || out(x, y) == 1) << "1 only where nothing is known";
    }
}

TEST(BilateralUpsample, OfEveryPixelIsACopy) {
  const Picture p = picture(5, 4, Lens{}, slanted_plane(Lens{}));
  Plane value(5, 4, 0.25F);
  value(2, 1) = 0.5F;
  EXPECT_EQ(differing_pixels(filter::bilateral_upsample({}, value, filter::full_grid(p.surface()), p.surface()), value),
            0);
}

TEST(BilateralUpsample, WorksForEverySmallSizeAndOrigin) {
  const Lens lens{10, 10, 1, 1};
  for (int height = 1; height <= 4; ++height)
    for (int width = 1; width <= 4; ++width)
      for (const int origin : {-3, -2, 0, 1}) {
        const Picture p = picture(width, height, lens, slanted_plane(lens, {0, 0, -1}), origin, -origin);
        const filter::SampleGrid grid = filter::half_grid(p.surface());
        const Plane out = filter::bilateral_upsample({}, Plane(grid.width(), grid.height(), 0.5F), grid, p.surface());
        EXPECT_EQ(differing_pixels(out, Plane(width, height, 0.5F)), 0);
      }
}

TEST(BilateralUpsample, IsTheSameToTheBitForAnyUnitOfLengthAndThreads) {
  const Lens lens{80, 70, 30, 20};
  const Picture p = picture(63, 41, lens, slanted_plane(lens)), far = scaled(p, 256);
  const filter::SampleGrid grid = filter::half_grid(p.surface()), far_grid = filter::half_grid(far.surface());
  Plane value(grid.width(), grid.height());
  for (int y = 0; y < value.height(); ++y)
    for (int x = 0; x < value.width(); ++x)
      value(x, y) = unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
  BilateralUpsampleParams params;
  set_thread_count(1);
  const Plane metres = filter::bilateral_upsample(params, value, grid, p.surface());
  params.edge_distance_m *= 256;
  set_thread_count(7);
  EXPECT_EQ(differing_pixels(metres, filter::bilateral_upsample(params, value, far_grid, far.surface())), 0);
  set_thread_count(0);
}

}  // namespace
}  // namespace aftershade::tests
