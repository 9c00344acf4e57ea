#include "core/ao/growing_circle.h"

#include <gtest/gtest.h>

#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using ao::CircleGrowth;
using ao::GrowingCircleParams;

Plane occlude(const GrowingCircleParams& params, const Picture& picture, int frame_number = 1, int screen_px = 160) {
  const filter::Surface surface = picture.surface();
  const filter::SampleGrid grid =
      params.resolution == ao::Resolution::half ? filter::half_grid(surface) : filter::full_grid(surface);
  return ao::growing_circle(params, surface, grid, screen_px, frame_number);
}

GrowingCircleParams full(CircleGrowth growth = CircleGrowth::linear) {
  GrowingCircleParams params;
  params.resolution = ao::Resolution::full;
  params.growth = growth;
  return params;
}

int pixels_below(ConstPlaneView ao, float value) {
  int count = 0;
  for (int y = 0; y < ao.height; ++y)
    for (int x = 0; x < ao.width; ++x) count += !(ao(x, y) >= value);
  return count;
}

/// A floor, a wall and a ball.
View room(const Lens& lens) {
  return [=](double x, double y) {
    const Hit floor = meet_plane(lens, x, y, {0, 1, -0.3}, -1.5), wall = meet_plane(lens, x, y, {0.2, 0.1, -1}, -5);
    Hit best = floor.z > 0 && floor.z < wall.z ? floor : wall;
    const Vec3 centre(0.3, -0.7, 4), d = lens.ray(x, y);
    const double a = d.dot(d), b = d.dot(centre), c = centre.dot(centre) - 0.6 * 0.6, root = b * b - a * c;
    if (lens.orthographic || root < 0) return best;
    const double z = (b - std::sqrt(root)) / a;
    if (z < best.z) best = {z, (d * z - centre) / 0.6};
    return best;
  };
}

TEST(GrowingCircle, OfAPlaneIsExactlyOpen) {
  for (const bool orthographic : {false, true})
    for (const float fy : {200.0F, 130.0F})
      for (GrowingCircleParams params : {GrowingCircleParams{}, full(), full(CircleGrowth::sqrt)}) {
        const Lens lens{200, fy, 63.3F, 40.5F, orthographic};
        Picture p = picture(128, 81, lens, slanted_plane(lens));
        EXPECT_EQ(pixels_below(occlude(params, p), 1), 0) << "exact normals";
        p.normals = filter::normals_from_depth(p.depth, p.projection);
        EXPECT_EQ(pixels_below(occlude(params, p), 1), 0) << "derived normals";
      }
}

TEST(GrowingCircle, WithoutBiasOnlyRoundingOccludesAPlane) {
  // A float depth of 5 m is rounded by up to 2.4e-7 m, a pixel is 2.5 cm wide: that is the angle a plane may seem bent.
  for (const bool orthographic : {false, true})
    for (GrowingCircleParams params : {GrowingCircleParams{}, full(), full(CircleGrowth::sqrt)}) {
      const float focal = orthographic ? 40 : 200;
      const Lens lens{focal, focal, 64, 40, orthographic};
      params.bias = 0;
      EXPECT_EQ(pixels_below(occlude(params, picture(128, 80, lens, slanted_plane(lens))), 1 - 1e-5F), 0);
    }
}

TEST(GrowingCircle, DarkensTheFootOfTheWallAndLeavesTheMiddleOpen) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  for (const GrowingCircleParams& params : {full(), full(CircleGrowth::sqrt)}) {
    const Plane out = occlude(params, p);
    EXPECT_GT(pixels_below(out, 0.8F), 100);
    EXPECT_EQ(pixels_below(out, 0), 0);
    EXPECT_EQ(out(3, 3), 1.0F) << "on the wall, far from everything";
  }
}

TEST(GrowingCircle, IsOpenOnBackgroundAndUnmovedByNanAndInf) {
  const Lens lens{150, 150, 80, 60};
  Picture p = picture(160, 120, lens, room(lens));
  const float bad[] = {kNan, kInf, -kInf, 0.0F, -3.0F};
  for (int i = 0; i < 200; ++i) p.depth((i * 37) % 160, (i * 53) % 120) = bad[i % 5];
  for (int i = 0; i < 200; ++i)
    p.normals[static_cast<size_t>(i % 3)]((i * 41) % 160, (i * 59) % 120) = i % 2 != 0 ? kNan : kInf;
  for (const GrowingCircleParams& params : {GrowingCircleParams{}, full()}) {
    const Plane out = occlude(params, p);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) ASSERT_TRUE(out(x, y) >= 0 && out(x, y) <= 1) << x << ' ' << y;
    if (params.resolution == ao::Resolution::half) continue;
    for (int i = 0; i < 200; ++i) EXPECT_EQ(out((i * 37) % 160, (i * 53) % 120), 1.0F);
  }
}

TEST(GrowingCircle, BackgroundDoesNotOcclude) {
  const Lens lens{150, 150, 30, 20};
  const Picture p = picture(60, 40, lens, [&](double x, double y) {
    return x < 30 ? meet_plane(lens, x, y, {0.1, 0.2, -1}, -4) : Hit{};
  });
  for (const GrowingCircleParams& params : {GrowingCircleParams{}, full()})
    EXPECT_EQ(pixels_below(occlude(params, p), 1), 0);
}

TEST(GrowingCircle, TapsOutsideTheImageDoNotBrightenTheBorder) {
  // A corner along x: every column sees the same, so columns at the border must not differ from those in the middle.
  const Lens lens{40, 40, 0, 40, true};
  const View view = [](double, double y) {
    const double h = (40 - y) / 40;
    return Hit{5 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
  };
  GrowingCircleParams params = full();
  params.taps = 1024;
  const Plane wide = occlude(params, picture(160, 160, lens, view), 1, 1000);
  const Plane narrow = occlude(params, picture(40, 80, lens, view), 1, 1000);
  for (const int y : {34, 38, 41, 45}) {
    EXPECT_LT(wide(80, y), 0.85F);
    for (const int x : {0, 1, 20, 159}) EXPECT_NEAR(wide(x, y), wide(80, y), 0.05) << x << ' ' << y;
    for (const int x : {0, 20, 39}) EXPECT_NEAR(narrow(x, y), wide(80, y), 0.12) << x << ' ' << y;
  }
}

TEST(GrowingCircle, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(161, 121, lens, room(lens));
  for (const GrowingCircleParams& params : {GrowingCircleParams{}, full()}) {
    set_thread_count(1);
    const Plane one = occlude(params, p);
    for (const int threads : {2, 7}) {
      set_thread_count(threads);
      EXPECT_EQ(differing_pixels(one, occlude(params, p)), 0) << threads;
    }
    set_thread_count(0);
  }
}

TEST(GrowingCircle, DoesNotKnowTheUnitOfLength) {
  for (const bool orthographic : {false, true}) {
    const Lens lens{150, 130, 80, 60, orthographic};
    const Picture p = picture(160, 120, lens, room(lens));
    for (GrowingCircleParams params : {GrowingCircleParams{}, full(CircleGrowth::sqrt)}) {
      const Plane metres = occlude(params, p);
      EXPECT_GT(pixels_below(metres, 0.9F), 0);
      const float radius_m = params.radius_m;
      for (const float factor : {1024.0F, 1 / 4096.0F}) {
        params.radius_m = radius_m * factor;
        EXPECT_EQ(differing_pixels(metres, occlude(params, scaled(p, factor))), 0) << factor << orthographic;
      }
      for (const float factor : {100.0F, 0.3048F}) {
        params.radius_m = radius_m * factor;
        const Plane other = occlude(params, scaled(p, factor));
        int off = 0;
        for (int y = 0; y < other.height(); ++y)
          for (int x = 0; x < other.width(); ++x) off += !(std::abs(other(x, y) - metres(x, y)) <= 1e-5F);
        // A tap within rounding of the border of two pixels may fall on the other one.
        EXPECT_LE(off, 160 * 120 / 5000) << factor << orthographic;
      }
    }
  }
}

TEST(GrowingCircle, IsTheSameToTheBitWhenTheWindowMoves) {
  const Lens lens{100, 100, 100, 80};
  for (GrowingCircleParams params : {GrowingCircleParams{}, full()}) {
    params.radius_m = 0.2F;
    const Picture whole = picture(200, 160, lens, room(lens)), part = picture(160, 120, lens, room(lens), 21, 19);
    const Plane a = occlude(params, whole, 1, 200), b = occlude(params, part, 1, 200);
    const int step = params.resolution == ao::Resolution::half ? 2 : 1;
    const int margin = 48 / step, shift_x = 21 >> (step - 1), shift_y = 19 >> (step - 1);
    int compared = 0, dark = 0;
    for (int y = margin; y < b.height() - margin; ++y)
      for (int x = margin; x < b.width() - margin; ++x, ++compared) {
        EXPECT_EQ(b(x, y), a(x + shift_x, y + shift_y));
        dark += b(x, y) < 0.95F;
      }
    EXPECT_GT(compared, 300);
    EXPECT_GT(dark, 10);
  }
}

TEST(GrowingCircle, RotationsAreWhatWasAskedFor) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  GrowingCircleParams params;
  const Plane still = occlude(params, p, 1);
  EXPECT_EQ(differing_pixels(still, occlude(params, p, 2)), 0);
  params.per_frame_noise = true;
  EXPECT_GT(differing_pixels(occlude(params, p, 1), occlude(params, p, 2)), 100);
  EXPECT_EQ(pixels_below(occlude(params, p, -5), 0), 0);
  // Along an edge every pixel sees the same: without a rotation of its own each has the same AO.
  const Lens flat{60, 60, 0, 40, true};
  const Picture corner = picture(120, 80, flat, [](double, double y) {
    const double h = (40 - y) / 60;
    return Hit{5 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
  });
  const auto range = [&](bool rotated) {
    GrowingCircleParams choice = full();
    choice.pixel_rotation = rotated;
    const Plane out = occlude(choice, corner, 1, 20);  // 10 px at most: no tap leaves the image
    float low = 1, high = 0;
    for (int x = 20; x < 100; ++x) {
      low = std::min(low, out(x, 43));
      high = std::max(high, out(x, 43));
    }
    return high - low;
  };
  EXPECT_LT(range(false), 1e-6F);
  EXPECT_GT(range(true), 0.03F);
}

TEST(GrowingCircle, CircleGrowsToAShareOfTheScreenAndNoFarther) {
  // Two steps rise from the floor 12 px left and right of the middle column; a circle of 10 px does not see them.
  const Lens lens{100, 100, 60, 40};
  const Picture p = picture(120, 80, lens, [](double x, double) {
    return Hit{std::abs(x - 60) > 12 ? 1.0 : 1.5, Vec3(0, 0, -1)};
  });
  GrowingCircleParams params = full();
  params.taps = 64;
  for (const auto& [screens, sees] : {std::pair(0.1F, false), {0.2F, true}}) {
    params.reach_screens = screens;
    EXPECT_EQ(occlude(params, p, 1, 100)(60, 40) < 1, sees) << screens;
  }
  EXPECT_EQ(occlude(params, p, 1, 50)(60, 40), 1.0F) << "the share of a smaller screen";
}

TEST(GrowingCircle, WorksForEverySmallSizeAndCrossedExtremes) {
  const Lens lens{10, 10, 1, 1};
  for (int height = 1; height <= 4; ++height)
    for (int width = 1; width <= 4; ++width)
      for (GrowingCircleParams params : {GrowingCircleParams{}, full()}) {
        Picture p = picture(width, height, lens, slanted_plane(lens), -1, 3);
        EXPECT_EQ(pixels_below(occlude(params, p), 1), 0);
        p.depth(0, 0) = 1e-38F;
        params.radius_m = 1e6F;
        EXPECT_EQ(pixels_below(occlude(params, p), 0), 0);
      }
}

}  // namespace
}  // namespace aftershade::tests
