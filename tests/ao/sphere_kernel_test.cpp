#include "core/ao/sphere_kernel.h"

#include <gtest/gtest.h>

#include "core/ao/ball_samples.h"
#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using ao::SampleRange;
using ao::SphereSamples;
using ao::SphereVolume;

Plane occlude(const SphereSamples& params, const Picture& picture, const SampleRange& range) {
  return ao::sphere_kernel(params, picture.surface(), filter::full_grid(picture.surface()), range);
}
Plane occlude(const SphereSamples& params, const Picture& picture) {
  return occlude(params, picture, {0, params.samples, {}, {}});
}

int pixels_below(ConstPlaneView ao, float value) {
  int count = 0;
  for (int y = 0; y < ao.height; ++y)
    for (int x = 0; x < ao.width; ++x) count += !(ao(x, y) >= value);
  return count;
}

double mean(ConstPlaneView plane) {
  double sum = 0;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) sum += plane(x, y);
  return sum / plane.width / plane.height;
}

SphereSamples whole_sphere() {
  SphereSamples params;
  params.volume = SphereVolume::sphere;
  return params;
}

/// A floor, a wall and a ball.
View room(const Lens& lens, double size = 1) {
  return [=](double x, double y) {
    const Hit floor = meet_plane(lens, x, y, {0, 1, -0.3}, -1.5 * size),
              wall = meet_plane(lens, x, y, {0.2, 0.1, -1}, -5 * size);
    Hit best = floor.z > 0 && floor.z < wall.z ? floor : wall;
    const Vec3 centre = Vec3(0.3, -0.7, 4) * size, d = lens.ray(x, y);
    const double radius = 0.6 * size, a = d.dot(d), b = d.dot(centre);
    const double root = b * b - a * (centre.dot(centre) - radius * radius);
    if (lens.orthographic || root < 0) return best;
    const double z = (b - std::sqrt(root)) / a;
    if (z < best.z) best = {z, (d * z - centre) / radius};
    return best;
  };
}

TEST(SphereKernel, OfAPlaneIsExactlyOpen) {
  for (const bool orthographic : {false, true})
    for (const float fy : {200.0F, 130.0F})
      for (const float radius_m : {0.02F, 1.0F, 30.0F}) {
        const Lens lens{200, fy, 63.3F, 40.5F, orthographic};
        Picture p = picture(128, 81, lens, slanted_plane(lens));
        SphereSamples params;
        params.radius_m = radius_m;
        EXPECT_EQ(pixels_below(occlude(params, p), 1), 0) << "exact normals, " << radius_m;
        p.normals = filter::normals_from_depth(p.depth, p.projection);
        EXPECT_EQ(pixels_below(occlude(params, p), 1), 0) << "derived normals, " << radius_m;
      }
}

TEST(SphereKernel, WholeSphereLeavesAPlaneAtThreeQuarters) {
  const Lens lens{200, 200, 64, 40, true};
  SphereSamples params = whole_sphere();
  params.samples = ao::kSequenceLength;
  params.radius_m = 0.05F;
  const Plane out = occlude(params, picture(128, 80, lens, slanted_plane(lens, {0, 0, -1})));
  EXPECT_NEAR(mean(out), 0.75, 0.002);
}

TEST(SphereKernel, DarkensTheFootOfTheWallAndLeavesTheMiddleOpen) {
  const Lens lens{150, 150, 80, 60};
  const Plane out = occlude({}, picture(160, 120, lens, room(lens)));
  EXPECT_GT(pixels_below(out, 0.9F), 100);
  EXPECT_EQ(pixels_below(out, 0), 0);
  EXPECT_EQ(out(3, 3), 1.0F) << "on the wall, far from everything";
}

TEST(SphereKernel, WhatIsFarInFrontFades) {
  // A screen over the left half, `gap` radii in front of a wall that is beside it a pixel wide.
  const Lens lens{100, 100, 50, 20, true};
  SphereSamples params;
  params.samples = ao::kSequenceLength;
  params.radius_m = 0.1F;
  const auto visibility_beside = [&](float gap) {
    const Picture p = picture(100, 40, lens, [&](double x, double) {
      return Hit{x < 50 ? 5.0 - static_cast<double>(gap * params.radius_m) : 5.0, Vec3(0, 0, -1)};
    });
    return occlude(params, p)(50, 20);
  };
  const float near = 1 - visibility_beside(1), far = 1 - visibility_beside(4);
  EXPECT_GT(near, 0.4F);  // nearly half of the half ball
  EXPECT_NEAR(far / near, 0.25F * 0.25F * (3 - 0.5F), 1e-3) << "smoothstep(R / distance)";
}

TEST(SphereKernel, IsOpenOnBackgroundAndUnmovedByNanAndInf) {
  const Lens lens{150, 150, 80, 60};
  Picture p = picture(160, 120, lens, room(lens));
  const float bad[] = {kNan, kInf, -kInf, 0.0F, -3.0F};
  for (int i = 0; i < 200; ++i) p.depth((i * 37) % 160, (i * 53) % 120) = bad[i % 5];
  for (int i = 0; i < 200; ++i)
    p.normals[static_cast<size_t>(i % 3)]((i * 41) % 160, (i * 59) % 120) = i % 2 != 0 ? kNan : kInf;
  for (const SphereSamples& params : {SphereSamples{}, whole_sphere()}) {
    const Plane out = occlude(params, p);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) ASSERT_TRUE(out(x, y) >= 0 && out(x, y) <= 1) << x << ' ' << y;
    for (int i = 0; i < 200; ++i) EXPECT_EQ(out((i * 37) % 160, (i * 53) % 120), 1.0F);
  }
}

TEST(SphereKernel, SkyIsBehindEverything) {
  const Lens lens{150, 150, 30, 20};
  const Picture p = picture(60, 40, lens, [&](double x, double y) {
    return x < 30 ? meet_plane(lens, x, y, {0.1, 0.2, -1}, -4) : Hit{};
  });
  EXPECT_EQ(pixels_below(occlude({}, p), 1), 0);
}

TEST(SphereKernel, PointsOutsideTheImageAreLeftOutOfTheMean) {
  // A corner along x: every column sees the same, so columns at the border must not differ from those in the middle.
  const Lens lens{60, 60, 0, 40, true};
  const View view = [](double, double y) {
    const double h = (40 - y) / 60;
    return Hit{5 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
  };
  SphereSamples params;
  params.samples = ao::kSequenceLength;
  const Plane wide = occlude(params, picture(160, 160, lens, view));
  for (const int y : {34, 38, 41, 45}) {
    EXPECT_LT(wide(80, y), 0.8F);
    for (const int x : {0, 1, 20, 159}) EXPECT_NEAR(wide(x, y), wide(80, y), 0.02) << x << ' ' << y;
  }
}

TEST(SphereKernel, NearTheCameraPointsBehindItAreLeftOut) {
  const Lens lens{150, 150, 80, 60};
  // The room at a twentieth of its size, under a ball that reaches far behind the camera.
  const Picture p = picture(160, 120, lens, room(lens, 0.05));
  for (const SphereSamples& params : {SphereSamples{}, whole_sphere()}) {
    const Plane out = occlude(params, p);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) ASSERT_TRUE(out(x, y) >= 0 && out(x, y) <= 1) << x << ' ' << y;
  }
  EXPECT_GT(pixels_below(occlude({}, p), 0.9F), 1000);
  const Picture plane = picture(160, 120, lens, [&](double x, double y) {
    return meet_plane(lens, x, y, {0.1, 0.2, -1}, -0.01);  // 1 cm in front of the lens
  });
  EXPECT_EQ(pixels_below(occlude({}, plane), 1), 0);
}

TEST(SphereKernel, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(161, 121, lens, room(lens));
  set_thread_count(1);
  const Plane one = occlude({}, p);
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    EXPECT_EQ(differing_pixels(one, occlude({}, p)), 0) << threads;
  }
  set_thread_count(0);
}

TEST(SphereKernel, IsTheSameToTheBitWhenTheUnitOfLengthChanges) {
  for (const bool orthographic : {false, true})
    for (const SphereSamples& params : {SphereSamples{}, whole_sphere()}) {
      const Lens lens{150, 130, 80, 60, orthographic};
      const Picture p = picture(160, 120, lens, room(lens));
      const Plane metres = occlude(params, p);
      EXPECT_GT(pixels_below(metres, 0.9F), 0);
      for (const float factor : {1024.0F, 1 / 4096.0F}) {
        SphereSamples other = params;
        other.radius_m *= factor;
        EXPECT_EQ(differing_pixels(metres, occlude(other, scaled(p, factor))), 0) << factor << orthographic;
      }
    }
}

TEST(SphereKernel, IsTheSameToTheBitWhenTheWindowMoves) {
  const Lens lens{100, 100, 100, 80};
  SphereSamples params;
  params.radius_m = 0.2F;
  const Picture whole = picture(200, 160, lens, room(lens)), part = picture(160, 120, lens, room(lens), 21, 19);
  for (const bool half : {false, true}) {
    const auto run = [&](const Picture& p) {
      const auto grid = half ? filter::half_grid(p.surface()) : filter::full_grid(p.surface());
      return ao::sphere_kernel(params, p.surface(), grid, {0, 16, {}, {}});
    };
    const Plane a = run(whole), b = run(part);
    const int step = half ? 2 : 1, margin = 40 / step;
    const int shift_x = 21 >> (step - 1), shift_y = 19 >> (step - 1);
    int dark = 0;
    for (int y = margin; y < b.height() - margin; ++y)
      for (int x = margin; x < b.width() - margin; ++x) {
        EXPECT_EQ(b(x, y), a(x + shift_x, y + shift_y));
        dark += b(x, y) < 0.95F;
      }
    EXPECT_GT(dark, 10);
  }
}

TEST(SphereKernel, TakesTheRangeOfSamplesThatEachPixelNames) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  const Plane early = occlude({}, p, {7, 16, {}, {}}), late = occlude({}, p, {23, 32, {}, {}});
  EXPECT_GT(differing_pixels(early, late), 1000);
  Plane first(160, 120, 7), count(160, 120, 16);
  for (int y = 0; y < 120; ++y)
    for (int x = 80; x < 160; ++x) first(x, y) = 23 + ao::kSequenceLength, count(x, y) = 32;
  const Plane mixed = occlude({}, p, {0, 0, first, count});
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) ASSERT_EQ(mixed(x, y), x < 80 ? early(x, y) : late(x, y)) << x << ' ' << y;
}

TEST(SphereKernel, RunsOfSamplesAddUpToTheWholeSequence) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  SphereSamples params;
  params.radius_m = 0.3F;
  const Plane all = occlude(params, p, {0, 64, {}, {}});
  Plane sum(160, 120);
  for (int run = 0; run < 4; ++run) {
    const Plane part = occlude(params, p, {ao::first_of_frame(run, 16), 16, {}, {}});
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) sum(x, y) += part(x, y) / 4;
  }
  for (int y = 40; y < 80; ++y)  // no point leaves the image
    for (int x = 40; x < 120; ++x) ASSERT_NEAR(sum(x, y), all(x, y), 1e-6) << x << ' ' << y;
}

TEST(SphereKernel, FramesTakeOneRunAfterTheOther) {
  EXPECT_EQ(ao::first_of_frame(0, 16), 0);
  EXPECT_EQ(ao::first_of_frame(3, 16), 48);
  EXPECT_EQ(ao::first_of_frame(ao::kSequenceLength / 16, 16), 0);
  EXPECT_EQ(ao::first_of_frame(-1, 16), ao::kSequenceLength - 16);
  EXPECT_EQ(ao::first_of_frame(2000000000, 1024) % 1024, 0);
}

TEST(SphereKernel, DitherMirrorsThePointsPixelByPixel) {
  const Lens lens{150, 150, 80, 60, true};
  const Picture p = picture(160, 120, lens, [](double, double y) {
    const double h = (60 - y) / 150;
    return Hit{5 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
  });
  SphereSamples params;
  params.radius_m = 0.2F;
  const auto varying = [&] {
    const Plane out = occlude(params, p);
    int count = 0;
    for (int x = 61; x < 100; ++x) count += out(x, 64) != out(60, 64) ? 1 : 0;
    return count;
  };
  EXPECT_GT(varying(), 10);
  params.dither = false;
  EXPECT_EQ(varying(), 0) << "along an edge all pixels test the same points";
}

TEST(SphereKernel, WorksForEverySmallSizeAndCrossedExtremes) {
  const Lens lens{10, 10, 1, 1};
  for (int height = 1; height <= 4; ++height)
    for (int width = 1; width <= 4; ++width) {
      SphereSamples params;
      Picture p = picture(width, height, lens, slanted_plane(lens), -1, 3);
      EXPECT_EQ(pixels_below(occlude(params, p), 1), 0);
      p.depth(0, 0) = 1e-38F;
      params.radius_m = 1e6F;
      EXPECT_EQ(pixels_below(occlude(params, p), 0), 0);
    }
}

}  // namespace
}  // namespace aftershade::tests
