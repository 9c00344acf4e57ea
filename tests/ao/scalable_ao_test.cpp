#include "core/ao/scalable_ao.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/metrics/image_metrics.h"
#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using ao::Resolution;
using ao::ScalableAoParams;
using ao::TapPattern;

ScalableAoParams current_gen() {
  ScalableAoParams p;
  p.resolution = Resolution::full;
  p.pattern = TapPattern::mirrored;
  p.taps = 4;
  p.max_radius_px = 20;
  p.depth_mips = false;
  return p;
}

Plane occlude(const ScalableAoParams& params, const Picture& picture, int frame_number = 1) {
  const filter::Surface surface = picture.surface();
  const filter::DepthPyramid pyramid(picture.depth, 6, picture.origin_x, picture.origin_y);
  const filter::SampleGrid grid =
      params.resolution == Resolution::half ? filter::half_grid(surface) : filter::full_grid(surface);
  return ao::scalable_ao(params, surface, pyramid, grid, frame_number);
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

TEST(ScalableAo, OfAPlaneIsExactlyOpen) {
  for (const bool orthographic : {false, true})
    for (const float fy : {200.0F, 130.0F})
      for (ScalableAoParams params : {ScalableAoParams{}, current_gen()}) {
        const Lens lens{200, fy, 63.3F, 40.5F, orthographic};
        Picture p = picture(128, 81, lens, slanted_plane(lens));
        EXPECT_EQ(pixels_below(occlude(params, p), 1), 0) << "exact normals";
        p.normals = filter::normals_from_depth(p.depth, p.projection);
        EXPECT_EQ(pixels_below(occlude(params, p), 1), 0) << "derived normals";
      }
}

TEST(ScalableAo, WithoutBiasOnlyRoundingOccludesAPlane) {
  for (const bool mips : {false, true}) {
    const Lens lens{200, 200, 64, 40};
    ScalableAoParams params;
    params.resolution = Resolution::full;
    params.bias = 0;
    params.depth_mips = mips;
    EXPECT_EQ(pixels_below(occlude(params, picture(128, 80, lens, slanted_plane(lens))), 1 - 1e-6F), 0) << mips;
  }
}

TEST(ScalableAo, DarkensTheFootOfTheWallAndLeavesTheMiddleOpen) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  for (ScalableAoParams params : {ScalableAoParams{}, current_gen()}) {
    params.resolution = Resolution::full;
    const Plane out = occlude(params, p);
    EXPECT_GT(pixels_below(out, 0.9F), 100);
    EXPECT_EQ(pixels_below(out, 0), 0);
    EXPECT_EQ(out(3, 3), 1.0F) << "on the wall, far from everything";
  }
}

TEST(ScalableAo, IsOpenOnBackgroundAndUnmovedByNanAndInf) {
  const Lens lens{150, 150, 80, 60};
  Picture p = picture(160, 120, lens, room(lens));
  const float bad[] = {kNan, kInf, -kInf, 0.0F, -3.0F};
  for (int i = 0; i < 200; ++i) p.depth((i * 37) % 160, (i * 53) % 120) = bad[i % 5];
  for (int i = 0; i < 200; ++i)
    p.normals[static_cast<size_t>(i % 3)]((i * 41) % 160, (i * 59) % 120) = i % 2 != 0 ? kNan : kInf;
  for (ScalableAoParams params : {ScalableAoParams{}, current_gen()}) {
    const Plane out = occlude(params, p);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) ASSERT_TRUE(out(x, y) >= 0 && out(x, y) <= 1) << x << ' ' << y;
    if (params.resolution == Resolution::half) continue;
    for (int i = 0; i < 200; ++i) EXPECT_EQ(out((i * 37) % 160, (i * 53) % 120), 1.0F);
  }
}

TEST(ScalableAo, BackgroundDoesNotOcclude) {
  const Lens lens{150, 150, 30, 20};
  const Picture p = picture(60, 40, lens, [&](double x, double y) {
    return x < 30 ? meet_plane(lens, x, y, {0.1, 0.2, -1}, -4) : Hit{};
  });
  for (const ScalableAoParams& params : {ScalableAoParams{}, current_gen()})
    EXPECT_EQ(pixels_below(occlude(params, p), 1), 0);
}

TEST(ScalableAo, TapsOutsideTheImageDoNotBrightenTheBorder) {
  // A corner along x: every column sees the same, so columns at the border must not differ from those in the middle,
  // nor may a narrow image differ from a wide one.
  const Lens lens{60, 60, 0, 40, true};
  const View view = [](double, double y) {
    const double h = (40 - y) / 60;
    return Hit{5 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
  };
  ScalableAoParams params;
  params.resolution = Resolution::full;
  params.taps = 1024;
  params.scale = 3;
  params.depth_mips = false;
  const Plane wide = occlude(params, picture(160, 160, lens, view)),
              narrow = occlude(params, picture(40, 80, lens, view));
  for (const int y : {34, 38, 41, 45}) {
    EXPECT_LT(wide(80, y), 0.85F);
    for (const int x : {0, 1, 20, 159}) EXPECT_NEAR(wide(x, y), wide(80, y), 0.05) << x << ' ' << y;
    for (const int x : {0, 20, 39}) EXPECT_NEAR(narrow(x, y), wide(80, y), 0.12) << x << ' ' << y;
  }
}

TEST(ScalableAo, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(161, 121, lens, room(lens));
  for (const ScalableAoParams& params : {ScalableAoParams{}, current_gen()}) {
    set_thread_count(1);
    const Plane one = occlude(params, p);
    for (const int threads : {2, 7}) {
      set_thread_count(threads);
      EXPECT_EQ(differing_pixels(one, occlude(params, p)), 0) << threads;
    }
    set_thread_count(0);
  }
}

TEST(ScalableAo, IsTheSameToTheBitWhenTheUnitOfLengthChanges) {
  for (const bool orthographic : {false, true}) {
    const Lens lens{150, 130, 80, 60, orthographic};
    const Picture p = picture(160, 120, lens, room(lens));
    for (ScalableAoParams params : {ScalableAoParams{}, current_gen()}) {
      params.bias_m = 0.001F;
      const Plane metres = occlude(params, p);
      EXPECT_GT(pixels_below(metres, 0.9F), 0);
      for (const float factor : {1024.0F, 1 / 4096.0F}) {
        ScalableAoParams other = params;
        other.radius_m *= factor;
        other.bias_m *= factor;
        EXPECT_EQ(differing_pixels(metres, occlude(other, scaled(p, factor))), 0) << factor << orthographic;
      }
    }
  }
}

TEST(ScalableAo, IsTheSameToTheBitWhenTheWindowMoves) {
  const Lens lens{100, 100, 100, 80};
  for (ScalableAoParams params : {ScalableAoParams{}, current_gen()}) {
    params.radius_m = 0.2F;
    Picture whole = picture(200, 160, lens, room(lens)), part = picture(160, 120, lens, room(lens), 21, 19);
    whole.display_height = part.display_height;
    const Plane a = occlude(params, whole), b = occlude(params, part);
    const int step = params.resolution == Resolution::half ? 2 : 1;
    const int margin = 48 / step, shift_x = (21 >> (step - 1)), shift_y = (19 >> (step - 1));
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

TEST(ScalableAo, OfAMirroredPictureIsMirroredOnAverageOverTheRotations) {
  const Lens lens{150, 150, 80, 60};
  const View view = room(lens);
  const Picture p = picture(160, 120, lens, view);
  const Picture q = picture(160, 120, lens, [&](double x, double y) {
    Hit hit = view(160 - x, y);
    hit.normal.x = -hit.normal.x;
    return hit;
  });
  ScalableAoParams params;
  params.resolution = Resolution::full;
  params.taps = 64;
  params.depth_mips = false;
  params.per_frame_noise = true;
  // The spiral turns one way, so single rotations differ; the difference must vanish as rotations are averaged.
  const auto difference = [&](int frames) {
    Plane sum(160, 120);
    for (int frame = 0; frame < frames; ++frame) {
      const Plane one = occlude(params, p, frame), other = occlude(params, q, frame);
      for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) sum(x, y) += (one(x, y) - other(159 - x, y)) / static_cast<float>(frames);
    }
    double squares = 0, worst = 0;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) {
        squares += std::pow(sum(x, y), 2);
        worst = std::max<double>(worst, std::abs(sum(x, y)));
      }
    std::printf("%d rotations: RMS %.5f, worst %.4f\n", frames, std::sqrt(squares / (160 * 120)), worst);
    return std::sqrt(squares / (160 * 120));
  };
  const double one = difference(1), many = difference(34);
  EXPECT_LT(many, one / 10);
  EXPECT_LT(many, 1e-3);
}

TEST(ScalableAo, DependsOnTheFrameOnlyWhenAskedTo) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  ScalableAoParams params;
  EXPECT_EQ(differing_pixels(occlude(params, p, 1), occlude(params, p, 2)), 0);
  params.per_frame_noise = true;
  EXPECT_GT(differing_pixels(occlude(params, p, 1), occlude(params, p, 2)), 100);
  EXPECT_EQ(pixels_below(occlude(params, p, -5), 0), 0);
}

TEST(ScalableAo, WorksForEverySmallSizeAndCrossedExtremes) {
  const Lens lens{10, 10, 1, 1};
  for (int height = 1; height <= 4; ++height)
    for (int width = 1; width <= 4; ++width)
      for (ScalableAoParams params : {ScalableAoParams{}, current_gen()}) {
        Picture p = picture(width, height, lens, slanted_plane(lens), -1, 3);
        EXPECT_EQ(pixels_below(occlude(params, p), 1), 0);
        p.depth(0, 0) = 1e-38F;
        params.radius_m = 1e6F;
        EXPECT_EQ(pixels_below(occlude(params, p), 0), 0);
      }
}

TEST(ScalableAo, PassesAreRunsWithOtherRotationsAveraged) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  ScalableAoParams params = current_gen();
  params.per_frame_noise = true;
  const Plane first = occlude(params, p, 6), second = occlude(params, p, 7);
  params.passes = 2;
  const Plane both = occlude(params, p, 3);  // seeds 6 and 7
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) ASSERT_EQ(both(x, y), (first(x, y) + second(x, y)) / 2) << x << ' ' << y;
  // More passes: nearer to their limit, and as bright.
  params.per_frame_noise = false;
  params.passes = 64;
  const Plane limit = occlude(params, p);
  const auto score = [&](int passes) {
    params.passes = passes;
    const Plane out = occlude(params, p);
    return std::pair(metrics::rmse(out, limit), metrics::mean_error(out, limit));
  };
  const auto [noise_of_one, bias_of_one] = score(1);
  const auto [noise_of_many, bias_of_many] = score(16);
  std::printf("1 pass: RMS %.4f, bias %.5f; 16 passes: RMS %.4f, bias %.5f\n", noise_of_one, bias_of_one, noise_of_many,
              bias_of_many);
  EXPECT_LT(noise_of_many, noise_of_one / 6);
  EXPECT_LT(std::abs(bias_of_one), 5e-4);
}

TEST(ScalableAo, AClampOfTheTapsAloneOccludesMore) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  ScalableAoParams params = current_gen();
  params.max_radius_px = 8;
  params.reference_height_px = 120;
  const Plane shortened = occlude(params, p);
  params.radius_clamp = ao::RadiusClamp::taps;
  const Plane taps = occlude(params, p);
  EXPECT_GT(differing_pixels(taps, shortened), 100);
  for (int y = 0; y < 120; ++y)
    for (int x = 2; x < 158; ++x) ASSERT_LE(taps(x, y), shortened(x, y) + 1e-6F) << x << ' ' << y;
  params.max_radius_px = 0;
  const Plane unclamped = occlude(params, p);
  params.radius_clamp = ao::RadiusClamp::radius;
  EXPECT_EQ(differing_pixels(unclamped, occlude(params, p)), 0) << "without a clamp there is no difference";
}

TEST(ScalableAo, ClampIsMeantAtTheReferenceHeight) {
  const Lens small{100, 100, 80, 60};
  ScalableAoParams params = current_gen();
  params.radius_m = 0.5F;
  params.max_radius_px = 6;
  params.reference_height_px = 120;
  Picture p = picture(160, 120, small, room(small));
  const Plane at_120 = occlude(params, p);
  p.display_height = 240;  // the same picture, taken for a crop of one twice as high
  params.reference_height_px = 240;
  EXPECT_EQ(differing_pixels(at_120, occlude(params, p)), 0);
  params.reference_height_px = 120;
  EXPECT_GT(differing_pixels(at_120, occlude(params, p)), 100);
  params.max_radius_px = 3;
  EXPECT_EQ(differing_pixels(at_120, occlude(params, p)), 0);
}

}  // namespace
}  // namespace aftershade::tests
