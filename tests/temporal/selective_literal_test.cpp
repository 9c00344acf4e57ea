#include "core/temporal/selective_temporal.h"
#include "tests/temporal/temporal_helpers.h"

/// The filter's other ways in and its literal reading.
namespace aftershade::tests {
namespace {

using temporal::Reprojected;
using temporal::Reprojection;
using temporal::selective_temporal_filter;
using temporal::SelectiveTemporalParams;
using temporal::StabilityMask;
using temporal::TemporalHistory;

constexpr int kWidth = 46, kHeight = 30;

TemporalHistory random_history(Window window) {
  const auto values = [&](float low, float high, int seed) {
    return plane_of(window.width(), window.height(),
                    [=](int x, int y) { return low + (high - low) * noise(x, y, seed); });
  };
  return {window, values(0, 1, 1), values(4, 6, 2), values(1, 8, 3), {}, {}, {}};
}

Reprojected random_past(Window window) {
  const auto around = [&](int first, bool along_x, int seed) {
    return plane_of(kWidth, kHeight, [=](int x, int y) {
      return static_cast<float>(first + (along_x ? x : y)) + 5 * noise(x, y, seed) - 2;
    });
  };
  return {around(window.min_x, true, 4), around(window.min_y, false, 5),
          plane_of(kWidth, kHeight, [](int x, int y) { return 4 + 2 * noise(x, y, 6); })};
}

Plane random_ao() {
  return plane_of(kWidth, kHeight, [](int x, int y) { return noise(x, y, 7); });
}

TEST(SelectiveLiteral, IsTheListing) {
  const Window window = window_of(kWidth, kHeight, -3, 40), old = window_of(kWidth - 5, kHeight + 4, -1, 41);
  SelectiveTemporalParams params;
  params.literal = true;
  params.selective = false;
  const Reprojected past = random_past(window);
  const Plane ao = random_ao(), depth(kWidth, kHeight, 5.5F);
  TemporalHistory history = random_history(old);
  const TemporalHistory before = random_history(old);
  const Plane got = selective_temporal_filter(params, ao, depth, ConstPlaneView(), past, window, history);
  int blended = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      // z and N of the nearest pixel, border 0; AO bilinear, clamped to the border.
      const double px = past.x(x, y), py = past.y(x, y), w = past.depth(x, y);
      const int i = static_cast<int>(std::floor(px)) - old.min_x, j = static_cast<int>(std::floor(py)) - old.min_y;
      const bool inside = i >= 0 && j >= 0 && i < old.width() && j < old.height();
      const double z = inside ? before.depth(i, j) : 0;
      const auto ao_at = [&](double column, double row) {
        return before.ao(std::clamp(static_cast<int>(column) - old.min_x, 0, old.width() - 1),
                         std::clamp(static_cast<int>(row) - old.min_y, 0, old.height() - 1));
      };
      const double u = std::floor(px - 0.5), v = std::floor(py - 0.5), fx = px - 0.5 - u, fy = py - 0.5 - v;
      const double old_ao = (ao_at(u, v) * (1 - fx) + ao_at(u + 1, v) * fx) * (1 - fy) +
                            (ao_at(u, v + 1) * (1 - fx) + ao_at(u + 1, v + 1) * fx) * fy;
      const bool same = std::abs(1 - w / z) < params.epsilon;
      const double n = same ? before.count(i, j) : 0;
      ASSERT_NEAR(got(x, y), (n * (same ? old_ao : 0) + ao(x, y)) / (n + 1), 2e-6) << x << ' ' << y;
      ASSERT_NEAR(history.count(x, y), std::fmin(n + 1, 8), 1e-6);
      ASSERT_EQ(history.depth(x, y), past.depth(x, y)) << "w_i, not z_i";
      blended += same ? 1 : 0;
    }
  EXPECT_GT(blended, 300);
}

TEST(SelectiveLiteral, StoresTheDepthInTheViewBeforeEvenWhereThePixelIsStable) {
  const Window window = window_of(2, 1);
  const Plane depth(2, 1, 5.0F);
  const Reprojected past{plane_of(2, 1, [](int x, int) { return x == 0 ? 0.5F : kNaN; }), Plane(2, 1, 0.5F),
                         plane_of(2, 1, [](int x, int) { return x == 0 ? 4.9F : kNaN; })};
  for (const bool literal : {false, true}) {
    SelectiveTemporalParams params;
    params.literal = literal;
    TemporalHistory history;
    selective_temporal_filter(params, Plane(2, 1, 0.5F), depth, Plane(2, 1, 1.0F), past, window, history);
    EXPECT_EQ(history.depth(0, 0), literal ? 4.9F : 5.0F);
    EXPECT_EQ(history.depth(1, 0), 5.0F) << "without a past its own";
  }
}

TEST(SelectiveLiteral, IsTheSameThingForAStillCamera) {
  const Window window = window_of(kWidth, kHeight);
  const Plane depth(kWidth, kHeight, 5.0F), unstable(kWidth, kHeight);
  SelectiveTemporalParams literal;
  literal.literal = true;
  TemporalHistory a, b;
  for (int frame = 0; frame < 4; ++frame) {
    const Plane ao = plane_of(kWidth, kHeight, [&](int x, int y) { return noise(x, y, frame); });
    const auto still = standing_still(depth, window);
    EXPECT_EQ(different_pixels(selective_temporal_filter({}, ao, depth, unstable, still, window, a),
                               selective_temporal_filter(literal, ao, depth, unstable, still, window, b)),
              0);
  }
}

TEST(SelectiveLiteral, LetsAoOfAnotherSurfaceLeakIn) {
  // As FewerThanAQuarterOfTheWeightIsNoHistory, half way between two surfaces.
  const Window window = window_of(2, 1);
  for (const bool literal : {false, true}) {
    TemporalHistory history{window,
                            plane_of(2, 1, [](int i, int) { return i == 0 ? 0.2F : 0.9F; }),
                            plane_of(2, 1, [](int i, int) { return i == 0 ? 5.0F : 9.0F; }),
                            Plane(2, 1, 1.0F),
                            {},
                            {},
                            {}};
    SelectiveTemporalParams params;
    params.literal = literal;
    const Reprojected past{Plane(2, 1, 0.9F), Plane(2, 1, 0.5F), Plane(2, 1, 5.0F)};
    const Plane out =
        selective_temporal_filter(params, Plane(2, 1, 0.8F), Plane(2, 1, 5.0F), Plane(2, 1), past, window, history);
    EXPECT_NEAR(out(0, 0), literal ? (0.2 * 0.6 + 0.9 * 0.4 + 0.8) / 2 : 0.5, 1e-6);
  }
}

TEST(SelectiveTemporal, TakesAMaskOnTheGridAndAPastInRows) {
  for (const auto& [min_x, min_y] : {std::pair(0, 0), {-3, 41}}) {
    const Window window = window_of(kWidth, kHeight, min_x, min_y), old = window_of(kWidth + 3, kHeight, min_x, min_y + 2);
    const Plane depth = plane_of(kWidth, kHeight, [](int x, int y) { return 4 + 2 * noise(x, y, 8); });
    const filter::SampleGrid grid = hand_half_grid(depth, -(min_x & 1), -(min_y & 1));
    const Plane texels = plane_of(grid.width(), grid.height(), [](int x, int y) { return noise(x, y, 9) < 0.5F; });
    Camera now, before;
    now.fx = now.fy = before.fx = before.fy = 60;
    now.world_to_camera = Mat4();
    before.world_to_camera = Mat4().setTranslation(Vec3(0.04, 0.02, 0.1));
    const temporal::ReprojectionInput input{depth, window, CameraReprojection::create(now, before), {}, {}};
    const auto source = temporal::ReprojectionSource::camera;
    TemporalHistory a = random_history(old), b = random_history(old);
    const Plane at_pixels = values_at_pixels(texels, grid, surface_of(depth, {}));
    const Plane rows =
        selective_temporal_filter({}, random_ao(), depth, {texels, grid}, Reprojection(input, source, 0.5F), window, a);
    const Plane planes =
        selective_temporal_filter({}, random_ao(), depth, at_pixels, reproject(input, source, 0.5F), window, b);
    EXPECT_EQ(different_pixels(rows, planes) + different_pixels(a.count, b.count) + different_pixels(a.depth, b.depth),
              0);
    EXPECT_GT(different_pixels(rows, random_ao()), 20);
  }
}

}  // namespace
}  // namespace aftershade::tests
