#include "core/ao/slice_ao.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/ao/pixel_filter.h"
#include "core/ao/reference_ao.h"
#include "core/ao/thickness.h"
#include "core/parallel/rows.h"
#include "core/simd/targets.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using ao::Border;
using ao::SliceAoParams;
using ao::ThicknessModel;

SliceAoParams sharp() {
  SliceAoParams p;
  p.pixel_filter_px = 0;
  return p;
}

Plane occlude(const SliceAoParams& params, const Picture& picture, int frame = 1, ConstPlaneView depth2 = {}) {
  const filter::Surface surface = picture.surface();
  const bool half = params.resolution == ao::Resolution::half;
  return ao::slice_ao(params, surface, half ? filter::half_grid(surface) : filter::full_grid(surface), frame, depth2);
}

float least(ConstPlaneView plane, int margin = 0) {
  float out = 2;
  for (int y = margin; y < plane.height - margin; ++y)
    for (int x = margin; x < plane.width - margin; ++x) out = plane(x, y) < out ? plane(x, y) : out;
  return out;
}

double mean(ConstPlaneView plane) {
  double sum = 0;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) sum += plane(x, y);
  return sum / plane.width / plane.height;
}

/// A floor, a wall and, half a metre before the wall, upright blades as wide as `blade_m`.
View blades(const Lens& lens, double blade_m) {
  return [=](double x, double y) {
    const Hit floor = meet_plane(lens, x, y, {0, 1, -0.1}, -1), wall = meet_plane(lens, x, y, {0, 0, -1}, -4);
    const Hit before = meet_plane(lens, x, y, {0, 0, -1}, -3.5);
    Hit best = floor.z > 0 && floor.z < wall.z ? floor : wall;
    const double across = lens.point(x, y, before.z).x;
    if (before.z < best.z && std::abs(across - std::round(across * 2) / 2) < blade_m / 2) best = before;
    return best;
  };
}

TEST(SliceAo, OfAPlaneIsOpenToTheLastPixel) {
  const std::pair<Lens, Vec3> views[] = {
      {{200, 200, 64, 40}, {0.4, 0.6, -0.5}}, {{200, 130, 63.3F, 40.5F}, {0.4, 0.6, -0.5}},
      {{200, 200, -90, 160}, {0.1, 0.3, -1}}, {{200, 200, 64, -60}, {0, 1, -0.05}},
      {{60, 60, 64, 40}, {0, 0, -1}},         {{20, 26, 63, 41, true}, {0.4, 0.6, -0.5}},
      {{20, 20, 63, 41, true}, {0, 1, -0.1}}};
  for (const auto& [lens, normal] : views)
    for (const int steps : {0, 32})
      for (const Border border : {Border::open, Border::extend}) {
        Picture p = picture(128, 81, lens, slanted_plane(lens, normal));
        SliceAoParams params = sharp();
        params.slices = 2;
        params.steps = steps;
        params.border = border;
        EXPECT_GE(least(occlude(params, p)), 1 - 1e-5F) << "exact normals " << normal.x << ' ' << normal.z << steps;
        p.normals = filter::normals_from_depth(p.depth, p.projection);
        EXPECT_GE(least(occlude(params, p)), 1 - 1e-5F) << "derived normals " << normal.x << ' ' << normal.z << steps;
      }
}

TEST(SliceAo, ThinBladesLetLightThroughToTheWall) {
  const Lens lens{150, 150, 80, 60};
  SliceAoParams params = sharp();
  params.slices = 8;
  const double thin = mean(occlude(params, picture(160, 120, lens, blades(lens, 0.03)))),
               wide = mean(occlude(params, picture(160, 120, lens, blades(lens, 0.25)))),
               none = mean(occlude(params, picture(160, 120, lens, blades(lens, -1))));
  params.thickness = ThicknessModel::constant;
  params.max_thickness_m = 10;
  const double solid = mean(occlude(params, picture(160, 120, lens, blades(lens, 0.03))));
  std::printf("visibility: no blades %.4f, thin %.4f, wide %.4f, thin taken for endless %.4f\n", none, thin, wide,
              solid);
  EXPECT_LT(thin, none);
  EXPECT_LT(wide, thin - 0.01);
  EXPECT_LT(solid, thin - 0.03);
}

TEST(SliceAo, ThickerThingsHideMore) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, blades(lens, 0.1));
  SliceAoParams params = sharp();
  for (const ThicknessModel model : {ThicknessModel::width, ThicknessModel::constant}) {
    params.thickness = model;
    Plane before(160, 120, 1.0F);
    for (const float more : {0.02F, 0.1F, 0.5F, 2.0F}) {
      (model == ThicknessModel::width ? params.thickness_ratio : params.max_thickness_m) = more;
      Plane now = occlude(params, p);
      double sum = 0;
      for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x) {
          ASSERT_LE(now(x, y), before(x, y) + 1e-5F);
          sum += before(x, y) - now(x, y);
        }
      EXPECT_GT(sum, 1) << more;
      before = std::move(now);
    }
  }
  params.thickness = ThicknessModel::width;
  params.thickness_ratio = 0;
  params.min_thickness_m = 0.3F;
  const double least_thick = mean(occlude(params, p));
  params.min_thickness_m = 0;
  EXPECT_LT(least_thick, mean(occlude(params, p)) - 1e-3);
}

TEST(SliceAo, WidthsAreMeasuredBetweenSilhouettes) {
  const Lens lens{100, 100, 80, 60, true};
  const Picture p = picture(160, 120, lens, [](double x, double y) {
    const bool post = x >= 40 && x < 50 && y >= 20, beam = x >= 100 && x < 140 && y >= 30 && y < 50;
    return Hit{post || beam ? 3.0 : (x < 150 ? 4.0 + 0.1 * x : INFINITY), Vec3(0, 0, -1)};
  });
  const Plane widths = ao::object_widths(p.depth, p.projection);
  EXPECT_NEAR(widths(45, 80), 0.10F, 1e-5F) << "the post leaves the image below: its row counts";
  EXPECT_NEAR(widths(120, 40), 0.20F, 1e-5F) << "the beam's column";
  EXPECT_NEAR(widths(101, 31), 0.03F * std::sqrt(2.0F), 1e-5F) << "a diagonal cuts the corner";
  EXPECT_EQ(widths(70, 80), kInf) << "the slanted wall goes on behind everything";
  EXPECT_EQ(widths(155, 80), 0) << "background";
}

TEST(SliceAo, BorderGoesOnAsAPlane) {
  // A corner along x: every column sees the same in the limit, also those at the border.
  const Lens lens{60, 60, 0, 40, true};
  const View view = [](double, double y) {
    const double h = (40 - y) / 60;
    return Hit{5 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
  };
  SliceAoParams params = sharp();
  params.slices = 64;
  params.steps = 0;
  const Picture p = picture(160, 80, lens, view);
  const Plane extended = occlude(params, p);
  params.border = Border::open;
  const Plane open = occlude(params, p);
  for (const int y : {34, 41, 45}) {
    EXPECT_LT(extended(80, y), 0.85F);
    for (const int x : {0, 1, 20, 159}) EXPECT_NEAR(extended(x, y), extended(80, y), 0.01) << x << ' ' << y;
    EXPECT_GT(open(0, y), open(80, y) + 0.05F);
  }
}

TEST(SliceAo, IsOpenOnBackgroundAndUnmovedByNanAndInf) {
  const Lens lens{150, 150, 80, 60};
  Picture p = picture(160, 120, lens, blades(lens, 0.1));
  const float bad[] = {kNan, kInf, -kInf, 0.0F, -3.0F};
  for (int i = 0; i < 200; ++i) p.depth((i * 37) % 160, (i * 53) % 120) = bad[i % 5];
  for (int i = 0; i < 200; ++i)
    p.normals[static_cast<size_t>(i % 3)]((i * 41) % 160, (i * 59) % 120) = i % 2 != 0 ? kNan : kInf;
  const Plane second(160, 120, kNan);
  for (SliceAoParams params : {sharp(), SliceAoParams{}})
    for (const ConstPlaneView depth2 : {ConstPlaneView(), second.view()}) {
      const Plane out = occlude(params, p, 1, depth2);
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) ASSERT_TRUE(out(x, y) >= 0 && out(x, y) <= 1) << x << ' ' << y;
      for (int i = 0; i < 200; ++i) EXPECT_EQ(out((i * 37) % 160, (i * 53) % 120), 1.0F);
    }
}

TEST(SliceAo, SecondLayerEndsTheFirstAndHidesToo) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, blades(lens, 0.2));
  Plane behind(160, 120, kInf), empty(160, 120, kInf);
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) behind(x, y) = p.depth(x, y) * 1.002F;
  SliceAoParams params = sharp();
  params.thickness = ThicknessModel::constant;
  EXPECT_EQ(differing_pixels(occlude(params, p), occlude(params, p, 1, empty)), 0);
  EXPECT_EQ(differing_pixels(occlude(params, p), occlude(params, p, 1, p.depth)), 0) << "not behind the first";
  // The wall behind the blades at 4 m, seen by nothing but the second layer: thick, so it hides as a wall does.
  params.max_thickness_m = 0.05F;
  const double alone = mean(occlude(params, p)), both = mean(occlude(params, p, 1, behind));
  EXPECT_LT(both, alone);
  // Two sheets of no thickness hide less than the filled space between them.
  params.max_thickness_m = 0.4F;
  const double filled = mean(occlude(params, p));
  params.thickness = ThicknessModel::width;
  params.thickness_ratio = 1e-3F;
  EXPECT_GT(mean(occlude(params, p, 1, behind)), filled);
}

TEST(SliceAo, IsTheSameToTheBitOnAnyNumberOfThreads) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(161, 121, lens, blades(lens, 0.1));
  set_thread_count(1);
  const Plane one = occlude({}, p);
  for (const int threads : {2, 7}) {
    set_thread_count(threads);
    EXPECT_EQ(differing_pixels(one, occlude({}, p)), 0) << threads;
  }
  set_thread_count(0);
}

TEST(SliceAo, IsTheSameToTheBitOnEverySimdTarget) {
  const Lens lens{150, 140, 70, 50};
  Picture p = picture(141, 93, lens, blades(lens, 0.1), -5, 3);
  const float bad[] = {kNan, kInf, -kInf, 0.0F, -3.0F, 1e-38F};
  for (int i = 0; i < 120; ++i) p.depth((i * 37) % 141, (i * 53) % 93) = bad[i % 6];
  for (int i = 0; i < 60; ++i) p.normals[static_cast<size_t>(i % 3)]((i * 41) % 141, (i * 59) % 93) = bad[i % 3];
  Plane behind(141, 93, kInf);
  for (int y = 0; y < 93; ++y)
    for (int x = 0; x < 141; ++x) behind(x, y) = (x + y) % 5 == 0 ? kNan : p.depth(x, y) * 1.05F;
  SliceAoParams fast = sharp();
  fast.slices = fast.steps = 3;
  fast.thickness = ThicknessModel::constant;
  fast.noise_tile = ao::NoiseTile::three;
  fast.depth_mips = true;
  SliceAoParams open = fast, half = SliceAoParams{}, every = sharp();
  open.border = Border::open;
  open.radius_m = 20;
  half.resolution = ao::Resolution::half;
  half.depth_mips = true;
  every.slices = 1;
  every.steps = 0;
  for (const SliceAoParams& params : {fast, open, half, every})
    for (const ConstPlaneView depth2 : {ConstPlaneView(), ConstPlaneView(behind)}) {
      lanes::force_target("scalar");
      const Plane twin = occlude(params, p, 7, depth2);
      for (const std::string& target : lanes::targets()) {
        lanes::force_target(target);
        EXPECT_EQ(differing_pixels(twin, occlude(params, p, 7, depth2)), 0) << target << params.steps;
      }
      lanes::force_target(lanes::targets().front());
    }
}

TEST(SliceAo, DepthMipsKeepAPlaneOpenAndOtherwiseHardlyMatter) {
  const Lens lens{600, 600, 160, 120};
  SliceAoParams params = sharp();
  params.slices = 4;
  params.depth_mips = true;
  EXPECT_GE(least(occlude(params, picture(320, 240, lens, slanted_plane(lens), 5, -3))), 1 - 1e-5F);
  const Picture p = picture(320, 240, lens, blades(lens, 0.25));
  const double reduced = mean(occlude(params, p));
  params.depth_mips = false;
  const double full = mean(occlude(params, p));
  EXPECT_NE(reduced, full);
  EXPECT_NEAR(reduced, full, 0.01);
}

TEST(SliceAo, DoesNotDependOnTheUnitOfLength) {
  for (const bool orthographic : {false, true}) {
    const Lens lens{150, 130, 80, 60, orthographic};
    const Picture p = picture(160, 120, lens, blades(lens, 0.1));
    const Plane metres = occlude({}, p);
    EXPECT_LT(least(metres), 0.9F);
    const auto times = [&](float factor) {
      SliceAoParams other;
      other.radius_m *= factor;
      other.min_thickness_m *= factor;
      other.max_thickness_m *= factor;
      return occlude(other, scaled(p, factor));
    };
    for (const float factor : {1024.0F, 1 / 4096.0F})
      EXPECT_EQ(differing_pixels(metres, times(factor)), 0) << factor << orthographic;
    const Plane feet = times(3.2808F);
    int off = 0;  // pixels at which a sample's position rounds the other way
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 160; ++x) off += !(std::abs(feet(x, y) - metres(x, y)) <= 1e-5F);
    EXPECT_LT(off, 160 * 120 / 200) << orthographic;
  }
}

TEST(SliceAo, IsTheSameToTheBitWhenTheWindowMoves) {
  const Lens lens{100, 100, 100, 80};
  SliceAoParams params;
  params.radius_m = 0.6F;
  params.thickness = ThicknessModel::constant;  // widths end at the border, which moves
  const Picture whole = picture(200, 160, lens, blades(lens, 0.1)),
                part = picture(160, 120, lens, blades(lens, 0.1), 21, 19);
  const Plane a = occlude(params, whole), b = occlude(params, part);
  int dark = 0;
  for (int y = 45; y < 75; ++y)
    for (int x = 45; x < 115; ++x) {
      EXPECT_NEAR(b(x, y), a(x + 21, y + 19), 1e-6);
      dark += b(x, y) < 0.95F;
    }
  EXPECT_GT(dark, 10);
}

TEST(SliceAo, OfAMirroredPictureIsMirroredOnAverageOverTheRotations) {
  const Lens lens{150, 150, 80, 60};
  const View view = blades(lens, 0.1);
  const Picture p = picture(160, 120, lens, view), q = picture(160, 120, lens, [&](double x, double y) {
                                                     Hit hit = view(160 - x, y);
                                                     hit.normal.x = -hit.normal.x;
                                                     return hit;
                                                   });
  SliceAoParams params = sharp();
  params.slices = 32;
  params.steps = 0;
  const Plane one = occlude(params, p), other = occlude(params, q);
  double squares = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) squares += std::pow(one(x, y) - other(159 - x, y), 2);
  EXPECT_LT(std::sqrt(squares / (160 * 120)), 3e-3);
}

TEST(SliceAo, DependsOnTheFrameOnlyWhenAskedTo) {
  const Lens lens{150, 150, 80, 60};
  const Picture p = picture(160, 120, lens, blades(lens, 0.1));
  SliceAoParams params;
  EXPECT_EQ(differing_pixels(occlude(params, p, 1), occlude(params, p, 2)), 0);
  params.per_frame_noise = true;
  EXPECT_GT(differing_pixels(occlude(params, p, 1), occlude(params, p, 2)), 100);
  EXPECT_GE(least(occlude(params, p, -5)), 0);
}

TEST(SliceAo, WorksForEverySmallSizeAndCrossedExtremes) {
  const Lens lens{10, 10, 1, 1};
  for (int height = 1; height <= 4; ++height)
    for (int width = 1; width <= 4; ++width)
      for (const auto resolution : {ao::Resolution::full, ao::Resolution::half}) {
        Picture p = picture(width, height, lens, slanted_plane(lens), -1, 3);
        SliceAoParams params;
        params.resolution = resolution;
        EXPECT_GE(least(occlude(params, p)), 1 - 1e-5F);
        p.depth(0, 0) = 1e-38F;
        params.radius_m = 1e6F;
        const float lowest = least(occlude(params, p));
        EXPECT_TRUE(lowest >= 0 && lowest <= 1) << lowest;
      }
}

TEST(SliceAo, PixelFilterIsAGaussianOverTheSurface) {
  Plane values(9, 9, 0.0F), depth(9, 9, 2.0F);
  values(4, 4) = 1;
  const Plane out = ao::pixel_filtered(values, depth, 0.5F);
  EXPECT_NEAR(out(5, 4) / out(4, 4), std::exp(-2.0F), 1e-5);
  EXPECT_NEAR(out(5, 5) / out(4, 4), std::exp(-4.0F), 1e-5);
  EXPECT_NEAR(mean(out), mean(values), 1e-6);
  depth(4, 4) = kInf;
  const Plane cut = ao::pixel_filtered(values, depth, 0.5F);
  EXPECT_EQ(cut(4, 4), 1.0F) << "background stays";
  EXPECT_EQ(cut(5, 4), 0.0F) << "and does not spread";
}

}  // namespace
}  // namespace aftershade::tests
