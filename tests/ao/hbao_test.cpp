#include "core/ao/hbao.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using ao::HbaoBorder;
using ao::HbaoParams;
using ao::Resolution;
using ao::Tangents;

Plane occlude(const HbaoParams& params, const Picture& picture, int frame_number = 1) {
  const filter::Surface surface = picture.surface();
  const filter::SampleGrid grid =
      params.resolution == Resolution::full ? filter::full_grid(surface) : filter::half_grid(surface);
  const bool dual = params.resolution == Resolution::dual;
  return dual ? ao::dual_resolution_hbao(params, surface, grid, frame_number)
              : ao::hbao(params, surface, grid, frame_number);
}

HbaoParams full() {
  HbaoParams p;
  p.resolution = Resolution::full;
  return p;
}

/// Every choice at least once.
std::vector<HbaoParams> variants() {
  HbaoParams normals = full(), dual, literal, border;
  normals.tangents = Tangents::normals;
  dual.resolution = Resolution::dual;
  literal.literal = true;
  border.border = HbaoBorder::renormalise;
  border.power_exponent = 2;
  border.max_footprint = 0;
  return {HbaoParams{}, full(), normals, dual, literal, border};
}

int pixels_below(ConstPlaneView ao, float value, int margin = 0) {
  int count = 0;
  for (int y = margin; y < ao.height - margin; ++y)
    for (int x = margin; x < ao.width - margin; ++x) count += !(ao(x, y) >= value);
  return count;
}

double mean(ConstPlaneView ao) {
  double sum = 0;
  for (int y = 0; y < ao.height; ++y)
    for (int x = 0; x < ao.width; ++x) sum += ao(x, y);
  return sum / ao.width / ao.height;
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

/// A plane with a depth clamped at the border bends there: without taps outside, it stays a plane.
HbaoParams without_border(HbaoParams params) {
  if (params.border == HbaoBorder::clamp) params.border = HbaoBorder::open;
  return params;
}

TEST(Hbao, OfAPlaneIsExactlyOpen) {
  for (const bool orthographic : {false, true})
    for (const float fy : {200.0F, 130.0F})
      for (const Resolution resolution : {Resolution::full, Resolution::half, Resolution::dual})
        for (const Tangents tangents : {Tangents::shorter_difference, Tangents::normals}) {
          const Lens lens{200, fy, 63.3F, 40.5F, orthographic};
          Picture p = picture(128, 81, lens, slanted_plane(lens));
          HbaoParams params;
          params.resolution = resolution;
          params.tangents = tangents;
          const int reach_px = 17 * 200 / 130, margin = resolution == Resolution::half ? reach_px / 2 : reach_px;
          EXPECT_EQ(pixels_below(occlude(params, p), 1, margin), 0) << "away from the border";
          for (const HbaoBorder border : {HbaoBorder::open, HbaoBorder::renormalise}) {
            params.border = border;
            EXPECT_EQ(pixels_below(occlude(params, p), 1), 0) << "exact normals";
          }
          p.normals = filter::normals_from_depth(p.depth, p.projection);
          EXPECT_EQ(pixels_below(occlude(params, p), 1), 0) << "derived normals";
        }
}

TEST(Hbao, WithoutBiasOnlyRoundingOccludesAPlane) {
  for (const bool orthographic : {false, true})
    for (const Tangents tangents : {Tangents::shorter_difference, Tangents::normals}) {
      // A pixel of 3 cm: 5 m away, float depth is spaced by 1.5e-5 of it.
      const float focal = orthographic ? 32 : 200;
      const Lens lens{focal, focal, 32, 20, orthographic};
      HbaoParams params = full();
      params.tangents = tangents;
      params.bias_deg = 0;
      params.border = HbaoBorder::open;
      const Plane out = occlude(params, picture(64, 40, lens, slanted_plane(lens)));
      float least = 1;
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 64; ++x) least = std::min(least, out(x, y));
      std::printf("least AO of a plane without bias: 1 - %.2g\n", 1.0 - static_cast<double>(least));
      EXPECT_GE(least, 1 - 1e-5F) << orthographic << static_cast<int>(tangents);
    }
}

TEST(Hbao, LiteralTangentsOccludeSlopesUntilTheBiasHidesIt) {
  const Lens lens{200, 200, 64, 40};
  const Picture p = picture(128, 80, lens, slanted_plane(lens));
  HbaoParams params = without_border(full());
  params.literal = true;
  params.bias_deg = 0;
  const double without = 1 - mean(occlude(params, p));
  params.bias_deg = 10;
  const double with = 1 - mean(occlude(params, p));
  std::printf("literal occlusion of a slope: %.4f without bias, %.5f with 10 degrees\n", without, with);
  EXPECT_GT(without, 1e-3);
  EXPECT_LT(with, without / 5);
}

TEST(Hbao, DarkensTheFootOfTheWallAndLeavesTheMiddleOpen) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  for (HbaoParams params : variants()) {
    params.resolution = Resolution::full;
    const Plane out = occlude(params, p);
    EXPECT_GT(pixels_below(out, 0.9F), 100);
    EXPECT_EQ(pixels_below(out, 0), 0);
    EXPECT_EQ(out(20, 20), 1.0F) << "on the wall, far from everything";
  }
}

TEST(Hbao, IsOpenOnBackgroundAndUnmovedByNanAndInf) {
  const Lens lens{150, 150, 80, 60};
  Picture p = picture(160, 120, lens, room(lens));
  const float bad[] = {kNan, kInf, -kInf, 0.0F, -3.0F};
  for (int i = 0; i < 200; ++i) p.depth((i * 37) % 160, (i * 53) % 120) = bad[i % 5];
  for (int i = 0; i < 200; ++i)
    p.normals[static_cast<size_t>(i % 3)]((i * 41) % 160, (i * 59) % 120) = i % 2 != 0 ? kNan : kInf;
  for (const HbaoParams& params : variants()) {
    const Plane out = occlude(params, p);
    for (int y = 0; y < out.height(); ++y)
      for (int x = 0; x < out.width(); ++x) ASSERT_TRUE(out(x, y) >= 0 && out(x, y) <= 1) << x << ' ' << y;
    if (params.resolution == Resolution::half) continue;
    for (int i = 0; i < 200; ++i) EXPECT_EQ(out((i * 37) % 160, (i * 53) % 120), 1.0F);
  }
}

TEST(Hbao, BackgroundNeitherOccludesNorBendsTangents) {
  const Lens lens{150, 150, 30, 20};
  const Picture p = picture(60, 41, lens, [&](double x, double y) {
    return x < 30 && (y < 5 || std::fmod(y, 3) > 1) ? meet_plane(lens, x, y, {0.1, 0.2, -1}, -4) : Hit{};
  });
  for (const HbaoParams& params : variants())
    if (!params.literal) {
      EXPECT_EQ(pixels_below(occlude(without_border(params), p), 1), 0);
    }
}

/// A corner along x at y = 80, 60 px/m: every column sees the same.
View corner_along_x() {
  return [](double, double y) {
    const double h = (80 - y) / 60;
    return Hit{5 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
  };
}

TEST(Hbao, TheBorderIsAsTheChoiceSays) {
  const Lens lens{60, 60, 0, 80, true};
  HbaoParams params = full();
  params.directions = 32;
  params.steps = 32;
  params.max_footprint = 0;
  const auto columns = [&](HbaoBorder border) {
    params.border = border;
    return occlude(params, picture(160, 160, lens, corner_along_x()));
  };
  const Plane made_up = columns(HbaoBorder::renormalise), open = columns(HbaoBorder::open),
              clamped = columns(HbaoBorder::clamp);
  for (const int y : {74, 78, 81, 85}) {
    const float middle = made_up(80, y);
    EXPECT_LT(middle, 0.85F);
    EXPECT_EQ(open(80, y), middle);
    EXPECT_EQ(clamped(80, y), middle);
    for (const int x : {0, 1, 20, 159}) EXPECT_NEAR(made_up(x, y), middle, 0.03) << x << ' ' << y;
    for (const int x : {0, 159}) {
      EXPECT_GT(open(x, y), middle + 0.3F * (1 - middle)) << "half of the directions leave the image";
      EXPECT_NEAR(clamped(x, y), middle, 0.01) << "the corner goes on as it is";
    }
  }
}

TEST(Hbao, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(161, 121, lens, room(lens));
  for (const HbaoParams& params : variants()) {
    set_thread_count(1);
    const Plane one = occlude(params, p);
    for (const int threads : {2, 7}) {
      set_thread_count(threads);
      EXPECT_EQ(differing_pixels(one, occlude(params, p)), 0) << threads;
    }
    set_thread_count(0);
  }
}

HbaoParams with_unit(HbaoParams params, float factor) {
  params.radius_m *= factor;
  params.edge_distance_m *= factor;
  return params;
}

TEST(Hbao, IsTheSameToTheBitWhenTheUnitOfLengthChanges) {
  for (const bool orthographic : {false, true}) {
    const Lens lens{150, 130, 80, 60, orthographic};
    const Picture p = picture(160, 120, lens, room(lens));
    for (const HbaoParams& params : variants()) {
      const Plane metres = occlude(params, p);
      EXPECT_GT(pixels_below(metres, 0.9F), 0);
      for (const float factor : {1024.0F, 1 / 4096.0F})
        EXPECT_EQ(differing_pixels(metres, occlude(with_unit(params, factor), scaled(p, factor))), 0) << factor;
    }
  }
}

TEST(Hbao, AnyOtherUnitOfLengthOnlyRounds) {
  const Lens lens{150, 130, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  for (const HbaoParams& params : variants()) {
    const Plane metres = occlude(params, p);
    for (const float factor : {100.0F, 0.3048F}) {
      const Plane other = occlude(with_unit(params, factor), scaled(p, factor));
      int off = 0;
      for (int y = 0; y < other.height(); ++y)
        for (int x = 0; x < other.width(); ++x) off += !(std::abs(other(x, y) - metres(x, y)) <= 1e-5F);
      EXPECT_EQ(off, 0) << factor;
    }
  }
}

TEST(Hbao, IsTheSameToTheBitWhenTheWindowMoves) {
  const Lens lens{100, 100, 100, 80};
  for (HbaoParams params : variants()) {
    params.radius_m = 0.5F;
    Picture whole = picture(200, 160, lens, room(lens)), part = picture(160, 120, lens, room(lens), 21, 19);
    whole.display_height = part.display_height;
    const Plane a = occlude(params, whole), b = occlude(params, part);
    const bool half = params.resolution == Resolution::half;
    const int margin = half ? 24 : 48, shift_x = half ? 21 >> 1 : 21, shift_y = half ? 19 >> 1 : 19;
    int compared = 0, dark = 0, off = 0;
    for (int y = margin; y < b.height() - margin; ++y)
      for (int x = margin; x < b.width() - margin; ++x, ++compared) {
        off += b(x, y) != a(x + shift_x, y + shift_y);
        dark += b(x, y) < 0.95F;
      }
    EXPECT_EQ(off, 0);
    EXPECT_GT(compared, 300);
    EXPECT_GT(dark, 10);
  }
}

/// RMS difference between two AOs, pixel (x, y) of the one to `to(x, y)` of the other, averaged over many patterns.
double difference(const HbaoParams& params, const Picture& p, const Picture& q,
                  const std::function<float(const Plane&, int, int)>& of, int frames) {
  Plane sum(p.depth.width(), p.depth.height());
  for (int frame = 0; frame < frames; ++frame) {
    const Plane one = occlude(params, p, frame), other = occlude(params, q, frame);
    for (int y = 0; y < sum.height(); ++y)
      for (int x = 0; x < sum.width(); ++x) sum(x, y) += (one(x, y) - of(other, x, y)) / static_cast<float>(frames);
  }
  double squares = 0;
  for (int y = 0; y < sum.height(); ++y)
    for (int x = 0; x < sum.width(); ++x) squares += std::pow(sum(x, y), 2);
  return std::sqrt(squares / sum.width() / sum.height());
}

TEST(Hbao, OfAMirroredOrTransposedPictureIsSoOnAverageOverThePatterns) {
  const Lens lens{75, 75, 45, 45};
  const View view = room(lens);
  const Picture p = picture(90, 90, lens, view);
  const Picture mirrored = picture(90, 90, lens, [&](double x, double y) { return view(90 - x, y); });
  const Picture transposed = picture(90, 90, lens, [&](double x, double y) { return view(y, x); });
  HbaoParams params = full();
  params.per_frame_noise = true;
  for (const bool mirror : {true, false}) {
    const auto of = [&](const Plane& q, int x, int y) { return mirror ? q(89 - x, y) : q(y, x); };
    const double one = difference(params, p, mirror ? mirrored : transposed, of, 1),
                 many = difference(params, p, mirror ? mirrored : transposed, of, 32);
    std::printf("RMS difference of a %s picture: %.5f, over 32 patterns %.5f\n", mirror ? "mirrored" : "transposed",
                one, many);
    EXPECT_LT(many, one / 6);
    EXPECT_LT(many, 2e-3);
  }
}

TEST(Hbao, DependsOnTheFrameOnlyWhenAskedTo) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  HbaoParams params;
  EXPECT_EQ(differing_pixels(occlude(params, p, 1), occlude(params, p, 2)), 0);
  params.per_frame_noise = true;
  EXPECT_GT(differing_pixels(occlude(params, p, 1), occlude(params, p, 2)), 100);
  EXPECT_EQ(pixels_below(occlude(params, p, -5), 0), 0);
}

TEST(Hbao, WorksForEverySmallSizeAndCrossedExtremes) {
  const Lens lens{10, 10, 1, 1};
  for (int height = 1; height <= 4; ++height)
    for (int width = 1; width <= 4; ++width)
      for (HbaoParams params : variants()) {
        Picture p = picture(width, height, lens, slanted_plane(lens), -1, 3);
        if (!params.literal) {
          EXPECT_EQ(pixels_below(occlude(without_border(params), p), 1), 0);
        }
        p.depth(0, 0) = 1e-38F;
        params.radius_m = 1e6F;
        params.max_footprint = 0;
        EXPECT_EQ(pixels_below(occlude(params, p), 0), 0);
      }
}

TEST(Hbao, StrengthScalesTheOcclusionAndTheExponentShapesTheAo) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, room(lens));
  HbaoParams params = full(), half_strength = full(), squared = full();
  half_strength.strength = 0.5F;
  squared.power_exponent = 2;
  const Plane a = occlude(params, p), h = occlude(half_strength, p), s = occlude(squared, p);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      EXPECT_NEAR(1 - h(x, y), 0.5 * (1.0 - a(x, y)), 1e-6);
      EXPECT_NEAR(s(x, y), a(x, y) * a(x, y), 1e-6);
    }
}

TEST(Hbao, SmallRadiiLeaveTheirPixelOpen) {
  const Lens lens{60, 60, 0, 80, true};
  const Picture p = picture(40, 160, lens, corner_along_x());
  HbaoParams params = full();
  params.radius_m = 0.99F / 60;  // metres of a texel
  EXPECT_EQ(pixels_below(occlude(params, p), 1), 0);
  params.radius_m = 3.0F / 60;
  EXPECT_GT(pixels_below(occlude(params, p), 1), 0);
  params.resolution = Resolution::half;
  params.radius_m = 1.98F / 60;
  EXPECT_EQ(pixels_below(occlude(params, p), 1), 0);
}

TEST(Hbao, TheFootprintIsAShareOfTheHeightWhateverTheResolution) {
  // A floor seen from above with a wall 30 px to the right: it is in the taps' reach or it is not.
  const Lens lens{60, 60, 0, 50, true};
  const Picture p = picture(200, 100, lens, [](double x, double) { return Hit{x < 100 ? 5.0 : 4.6, Vec3(0, 0, -1)}; });
  const auto ao_beside_wall = [&](Resolution resolution, float share, bool literal) {
    HbaoParams params;
    params.resolution = resolution;
    params.max_footprint = share;
    params.literal = literal;
    params.directions = 32;
    const Plane out = occlude(params, p);
    return resolution == Resolution::half ? out(35, 25) : out(70, 50);
  };
  for (const Resolution resolution : {Resolution::full, Resolution::half, Resolution::dual})
    for (const bool literal : {false, true}) {
      EXPECT_LT(ao_beside_wall(resolution, 0, literal), 0.99F);
      EXPECT_EQ(ao_beside_wall(resolution, 0.25F, literal), 1.0F);
      // The SDK counts its half share in texels: at full resolution it reaches half as far.
      const bool reaches = !literal || resolution != Resolution::full;
      EXPECT_EQ(ao_beside_wall(resolution, 0.45F, literal) < 1.0F, reaches) << static_cast<int>(resolution) << literal;
    }
}

}  // namespace
}  // namespace aftershade::tests
