#include "core/temporal/selective_temporal.h"

#include "core/base/error.h"
#include "tests/temporal/temporal_helpers.h"

namespace aftershade::tests {
namespace {

using temporal::Reprojected;
using temporal::selective_temporal_filter;
using temporal::SelectiveTemporalParams;
using temporal::TemporalHistory;

constexpr int kWidth = 47, kHeight = 31;

struct Step {
  double ao, count;
};

/// The seed's listing with algorithms 7.3's fetch, in double, one pixel at absolute position (x, y).
Step reference_step(const SelectiveTemporalParams& params, double ao, bool stable, double x, double y, double w,
                    const TemporalHistory& before) {
  if (params.selective && stable) return {ao, 1};
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
  double sum = 0, old_ao = 0, old_count = 0;
  for (const int dy : {0, 1})
    for (const int dx : {0, 1}) {
      const double column = left + dx, row = top + dy;
      if (!(std::abs(column) < 1e6 && std::abs(row) < 1e6)) continue;  // also NaN
      if (!before.window.contains(static_cast<int>(column), static_cast<int>(row))) continue;
      const int i = static_cast<int>(column) - before.window.min_x, j = static_cast<int>(row) - before.window.min_y;
      const double z = before.depth(i, j), n = before.count(i, j);
      if (!(std::abs(1 - w / z) < params.epsilon) || n <= 0 || z <= 0) continue;
      const double weight = (1 - std::abs(x - 0.5 - column)) * (1 - std::abs(y - 0.5 - row));
      sum += weight;
      old_ao += weight * before.ao(i, j);
      old_count += weight * n;
    }
  if (sum < 0.25) return {ao, 1};
  const double n = old_count / sum;
  return {(n * old_ao / sum + ao) / (n + 1), std::fmin(n + 1, params.max_frames)};
}

struct Random {
  Plane ao, depth, mask;
  Reprojected before;
  TemporalHistory history;
};

/// A frame whose history lies elsewhere, has another size, fractional counts, layers of depth and unknown pixels.
Random random_frame(Window window) {
  Random r;
  r.ao = plane_of(kWidth, kHeight, [](int x, int y) { return noise(x, y, 1); });
  r.depth = plane_of(kWidth, kHeight, [](int x, int y) { return noise(x, y, 2) < 0.1F ? kInf : 4 + noise(x, y, 3); });
  r.mask = plane_of(kWidth, kHeight, [](int x, int y) { return noise(x, y, 4) < 0.3F ? 1.0F : 0.0F; });
  const auto moved = [&](int x, int y, int centre, int seed) {
    const float at = static_cast<float>(centre) + 0.5F + 9 * noise(x, y, seed) - 4.5F;
    return noise(x, y, 5) < 0.05F ? kNaN : at;
  };
  r.before = {
      plane_of(kWidth, kHeight, [&](int x, int y) { return moved(x, y, window.min_x + x, 6); }),
      plane_of(kWidth, kHeight, [&](int x, int y) { return moved(x, y, window.min_y + y, 7); }),
      plane_of(kWidth, kHeight, [&](int x, int y) { return noise(x, y, 5) < 0.05F ? kNaN : 4 + noise(x, y, 3); })};
  const Window old{window.min_x + 3, window.min_y - 4, window.max_x + 8, window.max_y - 2};
  r.history.window = old;
  r.history.ao = plane_of(old.width(), old.height(), [](int x, int y) { return noise(x, y, 8); });
  r.history.depth = plane_of(old.width(), old.height(),
                             [](int x, int y) { return noise(x, y, 9) < 0.1F ? 0.0F : 4 + noise(x, y, 10); });
  r.history.count = plane_of(old.width(), old.height(), [](int x, int y) { return 1 + 7 * noise(x, y, 11); });
  return r;
}

TEST(SelectiveTemporal, EqualsTheReference) {
  const Window window = window_of(kWidth, kHeight, -9, 1000);
  for (const bool selective : {true, false}) {
    Random r = random_frame(window);
    const Random same = random_frame(window);
    SelectiveTemporalParams params;
    params.selective = selective;
    const Plane got = selective_temporal_filter(params, r.ao, r.depth, r.mask, r.before, window, r.history);
    int blended = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const Step want = reference_step(params, r.ao(x, y), r.mask(x, y) > 0.5F, r.before.x(x, y), r.before.y(x, y),
                                         r.before.depth(x, y), same.history);
        ASSERT_NEAR(got(x, y), want.ao, 1e-6) << x << " " << y;
        ASSERT_NEAR(r.history.count(x, y), want.count, 1e-5) << x << " " << y;
        ASSERT_EQ(r.history.depth(x, y), std::isfinite(r.depth(x, y)) ? r.depth(x, y) : 0.0F);
        blended += want.count > 1 ? 1 : 0;
      }
    EXPECT_GT(blended, kWidth * kHeight / 4);
    EXPECT_LT(blended, kWidth * kHeight * 9 / 10);
    EXPECT_EQ(r.history.window, window);
    EXPECT_EQ(different_pixels(r.history.ao, got), 0);
  }
}

TEST(SelectiveTemporal, DoesNotDependOnThreads) {
  const Window window = window_of(kWidth, kHeight);
  Random a = random_frame(window), b = random_frame(window);
  const Plane many = selective_temporal_filter({}, a.ao, a.depth, a.mask, a.before, window, a.history);
  const ThreadLimit one(1);
  const Plane single = selective_temporal_filter({}, b.ao, b.depth, b.mask, b.before, window, b.history);
  EXPECT_EQ(different_pixels(many, single) + different_pixels(a.history.count, b.history.count), 0);
}

TEST(SelectiveTemporal, StillCameraCountsToEightAndForgetsTheFirstFrame) {
  const Window window = window_of(3, 3);
  const Plane depth(3, 3, 5.0F), unstable(3, 3, 0.0F);
  const Reprojected still = standing_still(depth, window);
  TemporalHistory history;
  double mean = 0;
  for (int frame = 0; frame <= 60; ++frame) {
    const float value = frame == 0 ? 1.0F : 0.0F;  // the first frame's weight is what is left
    const Plane out = selective_temporal_filter({}, Plane(3, 3, value), depth, unstable, still, window, history);
    const double n = std::fmin(frame, 8);  // N before this frame: an exact running mean, then 8/9 and 1/9
    mean = (n * mean + value) / (n + 1);
    ASSERT_NEAR(out(1, 1), mean, 1e-6) << frame;
    ASSERT_EQ(history.count(1, 1), std::fmin(static_cast<float>(frame) + 1, 8.0F)) << frame;
    // 9 frames averaged, then (8/9) per frame: 40 frames after the 9th, 0.9 % of the first mean is left (DESIGN 4).
    if (frame == 48) {
      EXPECT_NEAR(out(1, 1) * 9, std::pow(8.0 / 9, 40), 1e-6);
      EXPECT_NEAR(out(1, 1) * 9, 0.009, 2e-4);
    }
  }
}

TEST(SelectiveTemporal, StablePixelsAreUntouchedBitForBitAndRestart) {
  const Window window = window_of(kWidth, kHeight);
  const Plane depth(kWidth, kHeight, 5.0F), unstable(kWidth, kHeight);
  const Reprojected still = standing_still(depth, window);
  const Plane mask = plane_of(kWidth, kHeight, [](int x, int) { return x < 20 ? 1.0F : 0.0F; });
  TemporalHistory history;
  for (int frame = 0; frame < 3; ++frame) {
    const Plane ao = plane_of(kWidth, kHeight, [&](int x, int y) { return noise(x, y, frame); });
    const Plane out = selective_temporal_filter({}, ao, depth, frame == 2 ? mask : unstable, still, window, history);
    if (frame < 2) continue;
    int changed = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool same = std::bit_cast<uint32_t>(out(x, y)) == std::bit_cast<uint32_t>(ao(x, y));
        if (x < 20) {
          ASSERT_TRUE(same);
        }
        ASSERT_EQ(history.count(x, y), x < 20 ? 1.0F : 3.0F);
        changed += same ? 0 : 1;
      }
    EXPECT_GT(changed, 26 * kHeight);
  }
}

TEST(SelectiveTemporal, FirstFrameAndUnknownPixelsKeepTheirAo) {
  const Window window = window_of(kWidth, kHeight, 7, 7);
  const Random r = random_frame(window);
  TemporalHistory history;
  SelectiveTemporalParams params;
  params.epsilon = 1e9F;  // even then a cleared history is no history
  const Plane out = selective_temporal_filter(params, r.ao, r.depth, Plane(kWidth, kHeight), r.before, window, history);
  EXPECT_EQ(different_pixels(out, r.ao), 0);
  EXPECT_EQ(different_pixels(history.count, Plane(kWidth, kHeight, 1.0F)), 0);
}

TEST(SelectiveTemporal, DisocclusionResetsTheCountUnlessEpsilonIsInfinite) {
  const Window window = window_of(1, 1);
  for (const auto& [expected, epsilon, count] : {std::tuple(5.49F, 0.1F, 3.0F),
                                                 {5.51F, 0.1F, 1.0F},
                                                 {4.51F, 0.1F, 3.0F},
                                                 {4.49F, 0.1F, 1.0F},
                                                 {500.0F, 1e9F, 3.0F}}) {
    TemporalHistory history{window, Plane(1, 1, 0.2F), Plane(1, 1, 5.0F), Plane(1, 1, 2.0F), {}, {}, {}};
    SelectiveTemporalParams params;
    params.epsilon = epsilon;
    const Reprojected before{Plane(1, 1, 0.5F), Plane(1, 1, 0.5F), Plane(1, 1, expected)};
    const Plane out =
        selective_temporal_filter(params, Plane(1, 1, 0.8F), Plane(1, 1, 7.0F), Plane(1, 1), before, window, history);
    EXPECT_EQ(history.count(0, 0), count) << expected;
    EXPECT_FLOAT_EQ(out(0, 0), count == 1 ? 0.8F : 0.4F);
    EXPECT_EQ(history.depth(0, 0), 7.0F) << "z_i is stored, not w_i (algorithms 14, item 1)";
  }
}

TEST(SelectiveTemporal, FewerThanAQuarterOfTheWeightIsNoHistory) {
  // Two columns of history, the right one on another surface: the valid weight is 1 - f.
  const Window window = window_of(2, 1);
  for (const auto& [x, known] : {std::pair(1.25F, true), {1.2501F, false}}) {
    TemporalHistory history{window,
                            plane_of(2, 1, [](int i, int) { return i == 0 ? 0.2F : 0.9F; }),
                            plane_of(2, 1, [](int i, int) { return i == 0 ? 5.0F : 9.0F; }),
                            Plane(2, 1, 2.0F),
                            {},
                            {},
                            {}};
    const Reprojected before{Plane(2, 1, x), Plane(2, 1, 0.5F), Plane(2, 1, 5.0F)};
    const Plane out =
        selective_temporal_filter({}, Plane(2, 1, 0.8F), Plane(2, 1, 5.0F), Plane(2, 1), before, window, history);
    EXPECT_FLOAT_EQ(out(0, 0), known ? 0.4F : 0.8F) << "the other surface's AO never leaks in: " << x;
  }
}

TEST(SelectiveTemporal, BadValuesNeverSpread) {
  const Window window = window_of(kWidth, kHeight);
  const auto bad = [](int x, int y) { return std::array{kNaN, kInf, -kInf, -3.0F}[static_cast<size_t>((x + y) % 4)]; };
  TemporalHistory history;
  SelectiveTemporalParams params;
  params.epsilon = 1e9F;
  for (int frame = 0; frame < 4; ++frame) {
    const auto spoiled = [&](int seed, float good) {
      return plane_of(kWidth, kHeight, [&, seed, good](int x, int y) {
        return noise(x, y, frame, seed) < 0.2F ? (seed == 1 ? (x % 2 ? kNaN : kInf) : bad(x, y)) : good;
      });
    };
    const Plane depth = spoiled(2, 5.0F), ao = spoiled(1, 0.5F);
    const Reprojected before{spoiled(3, 11.25F), spoiled(4, 8.75F), spoiled(5, 5.0F)};
    const Plane out = selective_temporal_filter(params, ao, depth, Plane(kWidth, kHeight), before, window, history);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        ASSERT_TRUE(out(x, y) >= 0.5F && out(x, y) <= 1.0F) << out(x, y);  // 0.5, or 1 for what was bad
        ASSERT_TRUE(history.count(x, y) >= 1 && history.count(x, y) <= 8);
        ASSERT_TRUE(std::isfinite(history.depth(x, y)) && history.depth(x, y) >= 0);
      }
  }
}

TEST(SelectiveTemporal, AWindowThatMovesOverStillContentChangesNothing) {
  const Window whole = window_of(80, 60, -10, -10);
  const auto depth_at = [](Window w) {
    return plane_of(w.width(), w.height(), [&](int x, int y) { return 5 + noise(w.min_x + x, w.min_y + y); });
  };
  TemporalHistory fixed, moving;
  Plane frames_inside(80, 60);
  for (int frame = 0; frame < 7; ++frame) {
    const Window part = window_of(40 + 2 * frame, 30 - frame, 3 * frame - 5, 4 * frame - 8);
    const auto filtered = [&](Window w, TemporalHistory& history) {
      const Plane depth = depth_at(w);
      const Plane ao =
          plane_of(w.width(), w.height(), [&](int x, int y) { return noise(w.min_x + x, w.min_y + y, frame); });
      return selective_temporal_filter({}, ao, depth, Plane(w.width(), w.height()), standing_still(depth, w), w,
                                       history);
    };
    const Plane want = filtered(whole, fixed), got = filtered(part, moving);
    int always_inside = 0;
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 80; ++x) {
        const int ax = x + whole.min_x, ay = y + whole.min_y, i = ax - part.min_x, j = ay - part.min_y;
        frames_inside(x, y) = part.contains(ax, ay) ? frames_inside(x, y) + 1 : 0.0F;
        if (!part.contains(ax, ay)) continue;
        ASSERT_EQ(moving.count(i, j), frames_inside(x, y));
        if (frames_inside(x, y) < static_cast<float>(frame) + 1) continue;
        ASSERT_EQ(got(i, j), want(x, y));
        ++always_inside;
      }
    EXPECT_GT(always_inside, frame == 6 ? 0 : 100);
  }
}

TEST(SelectiveTemporal, TheHistoryWindowsPlaceDoesNotChangeAFetch) {
  const Window window = window_of(kWidth, kHeight, -9, 1000);
  Random whole = random_frame(window), part = random_frame(window);
  const Window old = whole.history.window;
  const Window cut{old.min_x + 5, old.min_y + 3, old.max_x - 2, old.max_y - 6};
  const auto cropped = [&](const Plane& plane) {
    Plane out(cut.width(), cut.height());
    copy_at(plane, out, old.min_x - cut.min_x, old.min_y - cut.min_y);
    return out;
  };
  TemporalHistory crop{cut, cropped(part.history.ao), cropped(part.history.depth), cropped(part.history.count), {}, {},
                       {}};
  const Plane want =
      selective_temporal_filter({}, whole.ao, whole.depth, whole.mask, whole.before, window, whole.history);
  const Plane got = selective_temporal_filter({}, part.ao, part.depth, part.mask, part.before, window, crop);
  int blended = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const float left = std::floor(whole.before.x(x, y) - 0.5F), top = std::floor(whole.before.y(x, y) - 0.5F);
      if (!(left >= static_cast<float>(cut.min_x) && left < static_cast<float>(cut.max_x))) continue;
      if (!(top >= static_cast<float>(cut.min_y) && top < static_cast<float>(cut.max_y))) continue;
      ASSERT_EQ(got(x, y), want(x, y)) << x << " " << y;
      blended += crop.count(x, y) > 1 ? 1 : 0;
    }
  EXPECT_GT(blended, 300);
}

TEST(SelectiveTemporal, PlanesOfAnotherSizeAreRefused) {
  const Window window = window_of(4, 4);
  const Plane good(4, 4, 1.0F);
  TemporalHistory history;
  EXPECT_THROW(selective_temporal_filter({}, Plane(4, 3), good, good, standing_still(good, window), window, history),
               Error);
  EXPECT_THROW(
      selective_temporal_filter({}, good, good, ConstPlaneView(), standing_still(good, window), window, history),
      Error);
  SelectiveTemporalParams all;
  all.selective = false;
  EXPECT_NO_THROW(
      selective_temporal_filter(all, good, good, ConstPlaneView{}, standing_still(good, window), window, history));
}

TEST(SelectiveTemporalParams, TableCoversEveryMember) {
  SelectiveTemporalParams params;
  params::read(
      SelectiveTemporalParams::table(), &params,
      params::Json::parse(R"({"epsilon": 1e9, "distance_m": 0.5, "distance_footprints": 0, "dilation_texels": 5,
                 "max_frames": 16, "selective": false, "reprojection": "camera", "agreement_px": 0.25, "afr_lanes": 2,
                 "literal": true})"),
      "test");
  const SelectiveTemporalParams want{1e9F, 0.5F, 0, 5, 16, false, temporal::ReprojectionSource::camera, 0.25F, 2, true};
  EXPECT_EQ(params, want);
  EXPECT_EQ(SelectiveTemporalParams::table().size(), 10U);
}

}  // namespace
}  // namespace aftershade::tests
