#include "core/temporal/temporal_blur.h"

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "tests/temporal/blur_frames.h"

namespace aftershade::tests {
namespace {

using temporal::BlurTaps;
using temporal::temporal_blur;
using temporal::TemporalBlurHistory;
using temporal::TemporalBlurParams;

TEST(TemporalBlur, WhatStandsStillMeetsItsOwnTexel) {
  // Only the second blur follows the blend: with a history weight near 1 and blurs that skip everything, out = out'.
  const Lens lens{80, 80, 30, 20};
  for (const int step : {1, 2}) {
    const BlurFrame source(picture(61, 47, lens, slope_with_bars(lens)), step);
    BlurFrame frame(picture(61, 47, lens, slope_with_bars(lens)), step);
    TemporalBlurParams params;
    params.cut_m = 1e-6F;
    params.cut_footprints = 0;
    params.literal = true;  // no two neighbours of this slope have one depth
    params.difference_scale = 0;
    params.history_weight = 0.5F;
    TemporalBlurHistory history;
    frame.set_value([](int x, int) { return x % 2 ? 1.0F : 0.0F; });
    const Plane one = frame.run(params, history);
    frame.set_value([](int x, int) { return x % 2 ? 0.0F : 1.0F; });
    const Plane two = frame.run(params, history);
    for (int y = 0; y < one.height(); ++y)
      for (int x = 0; x < one.width(); ++x) {
        if (!std::isfinite(frame.grid.depth(x, y))) continue;
        ASSERT_TRUE(one(x, y) == 0 || one(x, y) == 1);
        ASSERT_EQ(two(x, y), 0.5F) << x << ' ' << y;
      }
  }
}

TEST(TemporalBlur, AConstantStaysTheSameToTheBit) {
  const Lens lens{80, 80, 30, 20};
  BlurFrame frame(picture(61, 41, lens, slope_with_bars(lens), 5, -1), 2);
  frame.set_value([](int, int) { return 0.3771F; });
  disturb(frame, 2, 0.05F);
  for (const bool warm : {false, true}) {
    TemporalBlurParams params;
    params.warm_start = warm;
    TemporalBlurHistory history;
    for (int i = 0; i < 4; ++i) EXPECT_EQ(differing_pixels(frame.run(params, history), frame.value), 0) << i;
  }
}

TEST(TemporalBlur, DoesNotDependOnThreads) {
  const Lens lens{80, 80, 30, 20};
  const auto run = [&] {
    BlurFrame frame(picture(61, 47, lens, slope_with_bars(lens)), 2);
    frame.set_value(noise);
    TemporalBlurHistory history;
    frame.run({}, history);
    disturb(frame, 1, 0.05F);
    TemporalBlurParams warm;
    warm.warm_start = true;
    return frame.run(warm, history);
  };
  const Plane many = run();
  set_thread_count(1);
  const Plane one = run();
  set_thread_count(0);
  EXPECT_EQ(differing_pixels(many, one), 0);
}

/// Two frames of a scene with every length times `factor`.
Plane in_unit(float factor, bool orthographic) {
  const Lens lens{80, 60, 30, 20, orthographic};
  TemporalBlurParams params;
  for (float* length : {&params.cut_m, &params.near_m, &params.far_m}) *length *= factor;
  TemporalBlurHistory history;
  BlurFrame frame(scaled(picture(61, 47, lens, slope_with_bars(lens)), factor), 2);
  frame.set_value(noise);
  frame.run(params, history);
  disturb(frame, 2, 0.07F * factor);
  return frame.run(params, history);
}

TEST(TemporalBlur, DoesNotKnowTheUnitOfLength) {
  for (const bool orthographic : {false, true}) {
    const Plane metres = in_unit(1, orthographic);
    for (const float factor : {256.0F, 1 / 1024.0F})
      EXPECT_EQ(differing_pixels(metres, in_unit(factor, orthographic)), 0) << factor << orthographic;
    const Plane feet = in_unit(3.2808F, orthographic);
    for (int y = 0; y < feet.height(); ++y)
      for (int x = 0; x < feet.width(); ++x) ASSERT_NEAR(feet(x, y), metres(x, y), 1e-5) << x << ' ' << y;
  }
}

TEST(TemporalBlur, AWindowThatMovesChangesNothing) {
  // What lies in both windows, far enough from borders, is the same to the bit, wherever the history's window was.
  const Lens lens{100, 100, 60, 50};
  for (const int step : {1, 2}) {
    const auto run = [&](int x0, int y0, int x1, int y1) {
      TemporalBlurHistory history;
      BlurFrame first(picture(120, 100, lens, slope_with_bars(lens), x0, y0), step);
      first.set_value(noise);
      first.run({}, history);
      BlurFrame second(picture(121, 99, lens, slope_with_bars(lens), x1, y1), step);
      second.set_value([](int x, int y) { return random_at(x, y, 10); });
      for (int y = 0; y < second.height(); ++y)
        for (int x = 0; x < second.width(); ++x) second.where.x(x, y) += 1.375F;
      return second.run({}, history);
    };
    const Plane a = run(0, 0, 0, 0), b = run(7, -3, -5, 9);
    const int shift_x = -5 >> (step - 1), shift_y = 9 >> (step - 1);
    int compared = 0;
    for (int y = 12; y + shift_y < a.height() - 12 && y < b.height() - 12; ++y)
      for (int x = 12; x + shift_x < a.width() - 12 && x < b.width() - 12; ++x) {
        if (x + shift_x < 12 || y + shift_y < 12) continue;
        ASSERT_EQ(b(x, y), a(x + shift_x, y + shift_y)) << x << ' ' << y << ' ' << step;
        ++compared;
      }
    EXPECT_GT(compared, 500);
  }
}

TEST(TemporalBlur, WhatWasHiddenOrOutsideHasNoHistory) {
  // A wall at 5 m; in frame 1 a post at 3 m covered columns 20 to 39, in frame 2 it is gone; the camera stands still.
  // Columns from 60 on were outside the window.
  const Lens lens{80, 80, 40, 20};
  const auto wall = [](double, double) { return Hit{5, Vec3(0, 0, -1)}; };
  const auto post = [](double x, double) { return Hit{x > 20 && x < 40 ? 3.0 : 5.0, Vec3(0, 0, -1)}; };
  for (const int step : {1, 2})
    for (const bool literal : {false, true}) {
      TemporalBlurParams params;
      params.literal = literal;
      TemporalBlurHistory history;
      BlurFrame before(picture(60, 40, lens, post), step), now(picture(80, 40, lens, wall), step);
      before.set_value([](int x, int) { return x >= 20 && x < 40 ? 0.25F : 0.75F; });
      now.set_value([](int, int) { return 0.75F; });
      before.run(params, history);
      EXPECT_EQ(differing_pixels(history.weight, Plane(before.grid.width(), before.grid.height())), 0);
      const Plane out = now.run(params, history);
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
          const int px = now.pixel_x(x, y);
          EXPECT_EQ(history.weight(x, y) > 0, px < 60 && !(px >= 20 && px < 40)) << px;
          EXPECT_EQ(out(x, y), 0.75F) << "no ghost of the post, no cut that leaks: " << px;
        }
    }
}

TEST(TemporalBlur, TheHistoryFadesBetweenNearAndFar) {
  const Lens lens{80, 80, 20, 10};
  const auto wall = [](double, double) { return Hit{2, Vec3(0, 0, -1)}; };
  TemporalBlurParams params;
  params.cut_footprints = 0;
  params.history_weight = 0.8F;
  for (const auto& [d, geometry] : {std::pair(0.04F, 1.0), {0.06F, 0.5}, {0.065F, 0.15625}, {0.071F, 0.0}}) {
    BlurFrame frame(picture(40, 20, lens, wall), 2);
    TemporalBlurHistory history;
    frame.run(params, history);
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 40; ++x) frame.where.depth(x, y) = 2 + d;
    frame.run(params, history);
    EXPECT_NEAR(history.weight(10, 5), 0.8 * geometry, 1e-4) << d;
    params.literal = true;  // the same, but along the ray of the pixel
    BlurFrame far_right(picture(40, 20, Lens{20, 20, 0, 0}, wall, 12, 0), 1);
    TemporalBlurHistory other;
    far_right.run(params, other);
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 40; ++x) far_right.where.depth(x, y) = 2 + d;
    far_right.run(params, other);
    const double u = (12 + 8 + 0.5) / 20, v = 0.5 / 20, along = static_cast<double>(d) * std::sqrt(1 + u * u + v * v);
    const double t = std::clamp((along - 0.05) / 0.02, 0.0, 1.0);
    EXPECT_NEAR(other.weight(8, 0), 0.8 * (1 - t * t * (3 - 2 * t)), 1e-4) << d;
    params.literal = false;
  }
}

TEST(TemporalBlur, BadValuesNeverSpread) {
  const Lens lens{80, 80, 30, 20};
  const std::array bad{kNan, kInf, -kInf};
  for (const int step : {1, 2}) {
    TemporalBlurHistory history;
    TemporalBlurParams params;
    params.warm_start = true;
    for (int frame_number = 0; frame_number < 3; ++frame_number) {
      Picture p = picture(61, 41, lens, slope_with_bars(lens));
      for (int i = 0; i < 150; ++i) {
        p.depth((i * 37) % 61, (i * 53) % 41) = std::array{kNan, kInf, -kInf, 0.0F, -2.0F}[static_cast<size_t>(i % 5)];
        p.normals[static_cast<size_t>(i % 3)]((i * 41) % 61, (i * 29) % 41) = bad[static_cast<size_t>(i % 3)];
      }
      BlurFrame frame(std::move(p), step);
      frame.set_value([&](int x, int y) {
        return random_at(x, y, frame_number, 7) < 0.2F ? bad[static_cast<size_t>((x + y) % 3)] : 0.5F;
      });
      for (int i = 0; i < 200; ++i) {
        Plane& plane = *std::array{&frame.where.x, &frame.where.y, &frame.where.depth}[static_cast<size_t>(i % 3)];
        plane((i * 31) % 61, (i * 43) % 41) = std::array{kNan, kInf, -kInf, 0.0F, -1.0F}[static_cast<size_t>(i % 5)];
      }
      const Plane out = frame.run(params, history);
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
          ASSERT_TRUE(out(x, y) >= 0.5F && out(x, y) <= 1.0F) << out(x, y);  // 0.5, or 1 for what was bad
          ASSERT_TRUE(history.weight(x, y) >= 0 && history.weight(x, y) <= params.history_weight);
          ASSERT_TRUE(std::isfinite(history.variance(x, y)));
        }
    }
  }
}

TEST(TemporalBlur, WorksForEverySmallSizeAndFromGridToGrid) {
  const Lens lens{10, 10, 1, 1};
  TemporalBlurHistory history;
  for (int height = 1; height <= 4; ++height)
    for (int width = 1; width <= 4; ++width)
      for (const int step : {1, 2}) {
        const BlurFrame frame(picture(width, height, lens, slanted_plane(lens), -1, 3), step);
        const Plane out = frame.run({}, history);  // the history before is of the other step: none
        EXPECT_EQ(differing_pixels(out, frame.value), 0);
        EXPECT_EQ(differing_pixels(history.weight, Plane(out.width(), out.height())), 0);
        EXPECT_EQ(history.step, step);
      }
}

TEST(TemporalBlur, PlanesOfAnotherSizeAreRefused) {
  const Lens lens{10, 10, 1, 1};
  BlurFrame frame(picture(8, 8, lens, slanted_plane(lens)), 2);
  TemporalBlurHistory history;
  EXPECT_THROW(temporal_blur({}, Plane(8, 8), frame.grid, frame.surface, frame.where, history), Error);
  frame.where.x = Plane(7, 8);
  EXPECT_THROW(frame.run({}, history), Error);
}

TEST(TemporalBlurParams, TableCoversEveryMember) {
  TemporalBlurParams params;
  params::read(TemporalBlurParams::table(), &params,
               params::Json::parse(R"({"cut_m": 0.5, "cut_footprints": 2, "weights": "binomial",
                 "history_weight": 0.5, "near_m": 1, "far_m": 2, "difference_scale": 3, "literal": true,
                 "warm_start": true, "reprojection": "camera", "agreement_px": 0.25, "channel": "Shadow"})"),
               "test");
  const TemporalBlurParams want{
      0.5F, 2, BlurTaps::binomial, 0.5F, 1, 2, 3, true, true, temporal::ReprojectionSource::camera, 0.25F, "Shadow"};
  EXPECT_EQ(params, want);
  EXPECT_EQ(TemporalBlurParams::table().size(), 12U);
}

}  // namespace
}  // namespace aftershade::tests
