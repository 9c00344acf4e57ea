#include <array>
#include <utility>

#include "core/temporal/selective_temporal.h"
#include "tests/temporal/temporal_helpers.h"

namespace aftershade::tests {
namespace {

using temporal::continuity_mask;
using temporal::dilate_discontinuities;
using filter::values_at_pixels;
using temporal::SelectiveTemporalParams;

const Projection kLens{160, 150, 20.5F, 14, false};

/// The seed's test straight from the slide, in double: 1, 0, or -1 where rounding may decide (distance within 1e-5 of
/// L).
int reference_continuity(const SelectiveTemporalParams& params, const filter::SampleGrid& grid, Projection lens, int x,
                         int y) {
  const auto depth = [&](int i, int j) { return static_cast<double>(grid.depth(i, j)); };
  const auto is_surface = [&](int i, int j) { return std::isfinite(depth(i, j)) && depth(i, j) > 0; };
  const auto point = [&](int i, int j) {
    const double px = grid.pixel_x.empty() ? i : static_cast<double>(grid.pixel_x(i, j));
    const double py = grid.pixel_y.empty() ? j : static_cast<double>(grid.pixel_y(i, j));
    const double scale = lens.orthographic ? 1 : depth(i, j);
    return Vec3((px + 0.5 - lens.cx) / lens.fx * scale, (py + 0.5 - lens.cy) / lens.fy * scale, depth(i, j));
  };
  if (!is_surface(x, y)) return 0;
  const double footprint = (lens.orthographic ? 1 : depth(x, y)) / std::fmin(lens.fx, lens.fy) * grid.step;
  const double limit = std::fmax(params.distance_m, params.distance_footprints * footprint);
  bool close = true, unsure = false;
  for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)}) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const int side : {-1, 1}) {
      const int i = x + side * dx, j = y + side * dy;
      if (i < 0 || j < 0 || i >= grid.width() || j >= grid.height() || !is_surface(i, j)) continue;
      nearest = std::fmin(nearest, (point(i, j) - point(x, y)).length());
    }
    close = close && nearest < limit;
    unsure = unsure || std::abs(nearest / limit - 1) < 1e-5;
  }
  return unsure ? -1 : (close ? 1 : 0);
}

/// Slopes, steps, noise, background and bad values.
Plane rough_depth(int width, int height) {
  return plane_of(width, height, [](int x, int y) {
    if (noise(x, y, 0, 1) < 0.04F) return std::array{kInf, kNaN, 0.0F, -1.0F}[static_cast<size_t>((x + y) % 4)];
    const float step = (x / 7 + y / 5) % 2 == 0 ? 4.0F : 6.0F;
    return step + 0.02F * static_cast<float>(x) + 0.3F * noise(x, y, 0, 2) * noise(x, y, 0, 3);
  });
}

void expect_reference(const SelectiveTemporalParams& params, const filter::SampleGrid& grid, ConstPlaneView depth,
                      Projection lens) {
  const Plane mask = continuity_mask(params, grid, surface_of(depth, lens));
  int ones = 0, unsure = 0;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const int want = reference_continuity(params, grid, lens, x, y);
      if (want >= 0) {
        ASSERT_EQ(mask(x, y), static_cast<float>(want)) << x << " " << y << " step " << grid.step;
      }
      ones += want == 1 ? 1 : 0;
      unsure += want < 0 ? 1 : 0;
    }
  const int texels = grid.width() * grid.height();
  EXPECT_LE(unsure, 2);
  EXPECT_GT(ones, texels / 40);
  EXPECT_LT(ones, texels * 39 / 40);
}

TEST(Continuity, EqualsTheReferenceOnFullAndHalfGrids) {
  const Plane depth = rough_depth(141, 129);
  for (const bool orthographic : {false, true})
    for (const float footprints : {0.0F, 1.2F}) {
      SelectiveTemporalParams params;
      params.distance_footprints = footprints;
      Projection lens = kLens, wide{12, 11, 20.5F, 14, orthographic};
      lens.orthographic = orthographic;
      const filter::SampleGrid grids[] = {hand_grid(depth), hand_half_grid(depth, 0, 0), hand_half_grid(depth, -1, -1)};
      for (const filter::SampleGrid& grid : grids) {
        params.distance_m = 0.1F;
        expect_reference(params, grid, depth, lens);
        params.distance_m = orthographic ? 0.2F : 0.9F;
        expect_reference(params, grid, depth, wide);
      }
    }
}

TEST(Continuity, TheThresholdIsExactAndStrict) {
  // Orthographic, 8 px per metre: neighbours of a plane facing the camera are exactly 0.125 m apart.
  const Plane depth(5, 5, 3.0F);
  const filter::SampleGrid grid = hand_grid(depth);
  const filter::Surface surface = surface_of(depth, {8, 8, 2.5F, 2.5F, true});
  const filter::Surface columns = surface_of(depth, {8, 100, 2.5F, 2.5F, true});  // only x decides
  const filter::Surface rows = surface_of(depth, {100, 8, 2.5F, 2.5F, true});     // only y decides
  SelectiveTemporalParams params;
  params.distance_footprints = 0;
  for (const auto& [limit, want] : {std::pair(0.125F, 0.0F), {std::nextafter(0.125F, 1.0F), 1.0F}}) {
    params.distance_m = limit;
    for (const filter::Surface& seen : {surface, columns, rows})
      EXPECT_EQ(different_pixels(continuity_mask(params, grid, seen), Plane(5, 5, want)), 0) << limit;
  }
  params.distance_m = 0;
  params.distance_footprints = 1;  // the footprint is the same 0.125 m
  EXPECT_EQ(continuity_mask(params, grid, surface)(2, 2), 0.0F);
  params.distance_footprints = 1.001F;
  EXPECT_EQ(continuity_mask(params, grid, surface)(2, 2), 1.0F);
}

TEST(Continuity, FarSurfacesAreStableOnlyWithFootprints) {
  // algorithms 14, item 7: with L = 0.1 m a wall facing the camera is unstable beyond 0.1 fx.
  SelectiveTemporalParams literal, scaled;
  literal.distance_footprints = 0;
  for (const auto& [z, want] : {std::pair(5.9F, 1.0F), {6.1F, 0.0F}, {500.0F, 0.0F}}) {
    const Plane depth(5, 5, z);
    const Projection lens{60, 60, 2.5F, 2.5F, false};
    EXPECT_EQ(continuity_mask(literal, hand_grid(depth), surface_of(depth, lens))(2, 2), want) << z;
    EXPECT_EQ(continuity_mask(scaled, hand_grid(depth), surface_of(depth, lens))(2, 2), 1.0F) << z;
  }
}

TEST(Continuity, AStepIsContinuousOnBothSidesAndABladeIsNot) {
  // The nearer neighbour decides, so both sides of a step pass; a blade one pixel wide has no near neighbour.
  const Plane depth = plane_of(12, 6, [](int x, int) { return x == 3 ? 2.0F : (x < 7 ? 5.0F : 8.0F); });
  const Projection lens{100, 100, 6, 3, false};
  const Plane mask = continuity_mask({}, hand_grid(depth), surface_of(depth, lens));
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 12; ++x) EXPECT_EQ(mask(x, y), x == 3 ? 0.0F : 1.0F) << x << " " << y;
}

TEST(Continuity, BackgroundIsUnstableAndOneLineImagesWork) {
  const Plane depth = plane_of(5, 1, [](int x, int) { return x == 1 ? kInf : (x == 4 ? kNaN : 3.0F); });
  const Plane mask = continuity_mask({}, hand_grid(depth), surface_of(depth, kLens));
  const float want[] = {0, 0, 1, 1, 0};  // pixel 0 has only background beside it
  for (int x = 0; x < 5; ++x) EXPECT_EQ(mask(x, 0), want[x]) << x;
  const Plane at_eye = plane_of(3, 3, [](int x, int y) { return x == 1 && y == 1 ? 0.0F : 0.05F; });
  EXPECT_EQ(continuity_mask({}, hand_grid(at_eye), surface_of(at_eye, kLens))(1, 1), 0.0F) << "depth 0 is no surface";
  const Plane single(1, 1, 3.0F);
  EXPECT_EQ(continuity_mask({}, hand_grid(single), surface_of(single, kLens))(0, 0), 1.0F);
}

TEST(Continuity, IsScaleInvariantWhenTheDistanceScalesToo) {
  const Plane depth = rough_depth(41, 29);
  const Plane larger = plane_of(41, 29, [&](int x, int y) { return 64 * depth(x, y); });
  SelectiveTemporalParams params;
  const Plane mask = continuity_mask(params, hand_grid(depth), surface_of(depth, kLens));
  params.distance_m *= 64;
  EXPECT_EQ(different_pixels(mask, continuity_mask(params, hand_grid(larger), surface_of(larger, kLens))), 0);
}

TEST(Dilation, EqualsTheReferenceForEverySize) {
  const Plane mask = plane_of(23, 17, [](int x, int y) { return noise(x, y) < 0.03F ? 0.0F : 1.0F; });
  for (const int n : {1, 2, 3, 4, 5, 40}) {
    const Plane got = dilate_discontinuities(mask, n);
    const Plane want = plane_of(23, 17, [&](int x, int y) {
      for (int dy = -(n / 2); dy < n - n / 2; ++dy)
        for (int dx = -(n / 2); dx < n - n / 2; ++dx)
          if (window_of(23, 17).contains(x + dx, y + dy) && mask(x + dx, y + dy) == 0) return 0.0F;
      return 1.0F;
    });
    EXPECT_EQ(different_pixels(got, want), 0) << n;
  }
  EXPECT_EQ(different_pixels(dilate_discontinuities(mask, 1), mask), 0);
}

TEST(Dilation, FourByFourLooksFromMinusTwoToPlusOne) {
  Plane mask(9, 9, 1.0F);
  mask(4, 4) = 0;
  const Plane got = dilate_discontinuities(mask, 4);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x)
      EXPECT_EQ(got(x, y), x >= 3 && x <= 6 && y >= 3 && y <= 6 ? 0.0F : 1.0F) << x << " " << y;
}

TEST(Continuity, ASlantedFloorIsStableOnTheLibrarysHalfGrid) {
  // 1 m under the eye, 12 to 40 degrees of slant, picked nearest and farthest in turn; blades stand at columns 28
  // to 35.
  const auto blade = [](int x) { return x >= 28 && x < 36 && x % 4 == 0; };
  const Plane depth =
      plane_of(64, 48, [&](int x, int y) { return blade(x) ? 0.5F : 60 / (28.5F + static_cast<float>(y)); });
  for (const int origin : {0, 1}) {
    filter::Surface surface = surface_of(depth, {60, 60, 32, -28, false});
    surface.origin_x = surface.origin_y = origin;
    const filter::SampleGrid grid = filter::half_grid(surface);
    const Plane mask = values_at_pixels(dilate_discontinuities(continuity_mask({}, grid, surface), 4), grid, surface);
    int stable_blades = 0, unstable_floor = 0;
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 64; ++x) {
        stable_blades += blade(x) && mask(x, y) == 1 ? 1 : 0;
        unstable_floor += (x < 22 || x >= 42) && y >= 8 && mask(x, y) == 0 ? 1 : 0;
      }
    EXPECT_EQ(unstable_floor, 0) << origin;
    EXPECT_EQ(stable_blades, 0) << origin;
  }
}

TEST(MaskAtPixels, EveryPixelTakesItsParentTexel) {
  const Plane depth(11, 8, 2.0F);
  const filter::Surface surface = surface_of(depth, kLens);
  for (const int origin : {0, -1}) {
    const filter::SampleGrid grid = hand_half_grid(depth, origin, origin);
    const Plane mask =
        plane_of(grid.width(), grid.height(), [](int x, int y) { return noise(x, y) < 0.5F ? 0.0F : 1.0F; });
    const Plane want = plane_of(11, 8, [&](int x, int y) { return mask((x - origin) / 2, (y - origin) / 2); });
    EXPECT_EQ(different_pixels(values_at_pixels(mask, grid, surface), want), 0) << origin;
  }
  const Plane full = plane_of(11, 8, [](int x, int y) { return noise(x, y) < 0.5F ? 0.0F : 1.0F; });
  EXPECT_EQ(different_pixels(values_at_pixels(full, hand_grid(depth), surface), full), 0);
}

}  // namespace
}  // namespace aftershade::tests
