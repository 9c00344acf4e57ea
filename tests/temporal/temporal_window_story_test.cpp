#include <numbers>

#include "core/temporal/moving_surfaces.h"
#include "tests/temporal/window_helpers.h"

/// What the two-sided window is for: no lag, no tail, no resampling blur, nothing from where something else was seen.
namespace aftershade::tests {
namespace {

using temporal::ChangeTest;

constexpr int kWidth = 64, kHeight = 48;
const Window kWindow = window_of(kWidth, kHeight);

TEST(WindowStory, APanOverAPatternLosesAtMostOneBilinearFetch) {
  // Orthographic camera, 0.5 px a frame: the worst fraction at every second frame. AO is a sine of the wall.
  constexpr double kPeriod_px = 12;
  std::vector<WindowFrame> frames;
  const auto pattern = [](int x, int frame) {
    return 0.5 + 0.4 * std::sin(2 * std::numbers::pi * (x + 0.5 + 0.5 * frame) / kPeriod_px);
  };
  for (int f = 0; f < 15; ++f) {
    frames.push_back(window_frame(f, kWindow, camera_at({0.05 * f, 0, 0}, 10, true)));
    frames.back().ao = plane_of(kWidth, kHeight, [&](int x, int) { return static_cast<float>(pattern(x, f)); });
  }
  TemporalWindowParams params;
  params.change_test = ChangeTest::never;
  const WindowedAo got = windowed(params, frames, 7);
  const double fetch = 0.4 * (1 - std::cos(std::numbers::pi / kPeriod_px));  // loss of a fetch between two pixels
  double worst = 0;
  for (int x = 8; x < kWidth - 8; ++x) worst = std::max(worst, std::abs(got.ao(x, 20) - pattern(x, 7)));
  EXPECT_LT(worst, fetch);
  EXPECT_GT(worst, fetch / 8) << "half of the frames are fetched between pixels";
}

TEST(WindowStory, NothingIsTakenFromBehindACut) {
  // From frame 8 on another shot: it matches in one fifth of the picture, by chance.
  std::vector<WindowFrame> frames;
  for (int f = 0; f < 15; ++f) {
    frames.push_back(window_frame(f, kWindow, camera_at({0, 0, 0})));
    if (f < 8) continue;
    frames.back().ao = Plane(kWidth, kHeight, 0.3F);
    frames.back().depth = plane_of(kWidth, kHeight, [](int x, int) { return x % 5 == 0 ? 5.0F : 11.0F; });
  }
  TemporalWindowParams params;
  params.change_test = ChangeTest::never;
  for (const size_t f : {size_t{5}, size_t{7}, size_t{8}, size_t{9}})
    EXPECT_EQ(different_pixels(windowed(params, frames, f).ao, frames[f].ao), 0) << f;
}

/// A card of 12x12 px at depth 4.5 before the floor at 5. The floor's AO falls to 0.4 around where the card is.
struct Card {
  double left;
  bool covers(int x, int y) const { return x + 0.5 >= left && x + 0.5 < left + 12 && y >= 18 && y < 30; }
  float ao(int x, int y) const {
    if (covers(x, y)) return 0.9F;
    const double dx = std::max({left - x - 0.5, x + 0.5 - left - 12, 0.0}), dy = std::max({18.0 - y, y - 29.0, 0.0});
    return static_cast<float>(std::min(1.0, 0.4 + 0.06 * std::hypot(dx, dy)));
  }
};

/// `left(f)` is where the card is in frame f; its vectors tell the truth. `noisy`: flicker of that amplitude.
std::vector<WindowFrame> card_frames(int count, const std::function<double(int)>& left, float noisy = 0) {
  std::vector<WindowFrame> frames;
  for (int f = 0; f < count; ++f) {
    WindowFrame frame = window_frame(f, kWindow, camera_at({0, 0, 0}));
    add_still_vectors(frame);
    const Card card{left(f)};
    frame.ao = plane_of(kWidth, kHeight, [&](int x, int y) { return card.ao(x, y) + noisy * (noise(x, y, f) - 0.5F); });
    for (int y = 18; y < 30; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (!card.covers(x, y)) continue;
        frame.depth(x, y) = 4.5F;
        frame.mv_prev.x(x, y) = static_cast<float>(left(f - 1) - left(f));
        frame.mv_next.x(x, y) = static_cast<float>(left(f + 1) - left(f));
      }
    frames.push_back(std::move(frame));
  }
  return frames;
}

struct Error {
  double most = 0, mean = 0;
};
/// Of the floor's AO against the frame's own, which has no noise in it.
Error floor_error(const WindowedAo& got, const Card& card) {
  Error error;
  int count = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (card.covers(x, y)) continue;
      const double e = std::abs(got.ao(x, y) - card.ao(x, y));
      error.most = std::max(error.most, e);
      error.mean += e;
      ++count;
    }
  error.mean /= count;
  return error;
}

TEST(WindowStory, AnOccluderThatTeleportsLeavesNeitherLagNorTail) {
  const auto left = [](int frame) { return frame < 10 ? 6.0 : 40.0; };
  const std::vector<WindowFrame> frames = card_frames(20, left);
  TemporalWindowParams never;
  never.change_test = ChangeTest::never;
  for (size_t f = 3; f < 17; ++f) {
    const Card card{left(static_cast<int>(f))};
    const Error error = floor_error(windowed({}, frames, f), card);
    EXPECT_LT(error.most, 0.002) << f;
    EXPECT_GT(floor_error(windowed(never, frames, f), card).most, 0.01) << f << ": what the test is for";
  }
}

TEST(WindowStory, ASlidingOccluderLeavesNoTrailAndKeepsTheFiltersGain) {
  const auto left = [](int frame) { return 3.0 * frame - 12; };
  const Card card{left(10)};
  TemporalWindowParams never;
  never.change_test = ChangeTest::never;
  const std::vector<WindowFrame> clean = card_frames(20, left), noisy = card_frames(20, left, 0.1F);
  const Error tested = floor_error(windowed({}, clean, 10), card),
              untested = floor_error(windowed(never, clean, 10), card);
  EXPECT_LT(tested.most, 0.06);  // 3 px a frame before a shadow of 10 px
  EXPECT_LT(tested.mean, untested.mean / 8);
  EXPECT_GT(untested.most, 0.15);
  const WindowedAo raw = windowed(
      [] {
        TemporalWindowParams p;
        p.frames = 0;
        return p;
      }(),
      noisy, 10);
  EXPECT_LT(floor_error(windowed({}, noisy, 10), card).mean, 0.6 * floor_error(raw, card).mean);
}

TEST(WindowStory, AnAoThatChangesEvenlyKeepsItsWholeWindow) {
  std::vector<WindowFrame> frames;
  for (int f = 0; f < 15; ++f) {
    frames.push_back(window_frame(f, kWindow, camera_at({0, 0, 0})));
    frames.back().ao = Plane(kWidth, kHeight, 0.2F + 0.03F * static_cast<float>(f));
  }
  TemporalWindowParams params;
  params.change_test = ChangeTest::everywhere;
  params.frames = 7;
  const WindowedAo got = windowed(params, frames, 7);
  EXPECT_NEAR(got.ao(30, 20), 0.2 + 0.03 * 7, 1e-6);
  EXPECT_NEAR(got.weight(30, 20), 1, 1e-4);
  const WindowedAo end = windowed(params, frames, 0);  // nothing on the other side: only what differs little counts
  EXPECT_NEAR(end.ao(30, 20), 0.2, 2e-4);
}

TEST(WindowStory, AMovingCardIsFollowed) {
  // The card's own AO flickers and travels with it: its mean along the way, not the place's.
  std::vector<WindowFrame> frames = card_frames(20, [](int frame) { return 2.25 * frame; });
  for (int f = 0; f < 20; ++f)
    for (int y = 18; y < 30; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (Card{2.25 * f}.covers(x, y)) frames[static_cast<size_t>(f)].ao(x, y) = f % 2 == 0 ? 0.5F : 0.6F;
  TemporalWindowParams params;
  params.change_test = ChangeTest::never;
  params.frames = 7;
  const WindowedAo got = windowed(params, frames, 10);
  double even = 0, all = 0;
  for (int d = -7; d <= 7; ++d) {
    all += window_weight(d, 7);
    even += d % 2 == 0 ? window_weight(d, 7) : 0;
  }
  for (int y = 19; y < 29; ++y)
    for (int x = 26; x < 32; ++x) {
      EXPECT_NEAR(got.weight(x, y), 1, 1e-5) << x << " " << y;
      EXPECT_NEAR(got.ao(x, y), 0.6 - 0.1 * even / all, 1e-5);
    }
}

TEST(WindowStory, WhatWasHiddenUsesOnlyTheFramesThatSeeIt) {
  const auto left = [](int frame) { return frame < 6 ? 20.0 : 40.0; };
  std::vector<WindowFrame> frames = card_frames(15, left);
  for (WindowFrame& frame : frames)
    for (int y = 18; y < 30; ++y)
      for (int x = 20; x < 32; ++x) frame.ao(x, y) = frame.number < 6 ? 0.1F : 0.8F;
  TemporalWindowParams params;
  params.change_test = ChangeTest::never;
  const WindowedAo got = windowed(params, frames, 7);
  double seen = 0, all = 0;
  for (int d = -7; d <= 7; ++d) {
    all += window_weight(d, 7);
    seen += 7 + d >= 6 ? window_weight(d, 7) : 0;
  }
  EXPECT_EQ(got.ao(25, 22), 0.8F);
  EXPECT_NEAR(got.weight(25, 22), seen / all, 1e-6);
}

TEST(NearMoving, CoversWhatIsWithinTheRadiusAndNothingFarBeyond) {
  const std::vector<WindowFrame> frames = card_frames(3, [](int frame) { return 24.0 + 2 * frame; });
  const std::vector<const WindowFrame*> list = pointers(frames);
  constexpr float kRadius = 1.5F;  // 18 px on the floor; 0.5 m lies between it and the card
  const auto near = temporal::near_moving_surfaces(list, kRadius, 0.25F);
  ASSERT_EQ(near.size(), 3U);
  const Card card{26};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double dx = std::max({card.left - x - 0.5, x + 0.5 - card.left - 12, 0.0}),
                   dy = std::max({18.0 - y, y - 29.0, 0.0});
      const double metres = std::hypot(std::hypot(dx, dy) * 5 / 60, card.covers(x, y) ? 0.0 : 0.5);
      const float got = near[1].at(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      if (metres < 0.75 * kRadius) {
        ASSERT_EQ(got, 1) << x << " " << y;
      }
      if (std::hypot(dx, dy) > 18 + 2 + 2 * 8 * std::numbers::sqrt2) {
        ASSERT_EQ(got, 0) << x << " " << y;
      }
    }
  EXPECT_EQ(near[1].at(-100, 20), 0);
  EXPECT_EQ(near[1].at(kNaN, 20), 0);
}

TEST(NearMoving, CannotTellWithoutVectorsOrPositions) {
  std::vector<WindowFrame> frames = card_frames(3, [](int) { return 24.0; });
  const std::vector<const WindowFrame*> list = pointers(frames);
  EXPECT_EQ(temporal::near_moving_surfaces(list, 1, 0.25F).size(), 3U);
  EXPECT_EQ(temporal::near_moving_surfaces(list, 1, 0.25F)[1].at(30, 20), 0) << "nothing moves";
  frames[1].mv_prev = {};
  EXPECT_EQ(temporal::near_moving_surfaces(list, 1, 0.25F).size(), 3U) << "frame 0 still knows the way to frame 1";
  frames[0].mv_next = {};
  EXPECT_TRUE(temporal::near_moving_surfaces(list, 1, 0.25F).empty());
  std::vector<WindowFrame> nowhere = card_frames(3, [](int) { return 24.0; });
  nowhere[1].camera.world_to_camera.reset();
  EXPECT_TRUE(temporal::near_moving_surfaces(pointers(nowhere), 1, 0.25F).empty());
}

TEST(NearMoving, UnknownVectorsCountAsMoving) {
  std::vector<WindowFrame> frames = card_frames(3, [](int) { return 24.0; });
  for (WindowFrame& frame : frames) frame.mv_prev.x(30, 20) = frame.mv_next.x(30, 20) = kNaN;
  const std::vector<const WindowFrame*> list = pointers(frames);
  EXPECT_EQ(temporal::near_moving_surfaces(list, 1, 0.25F)[1].at(30, 20), 1);
  EXPECT_EQ(temporal::near_moving_surfaces(list, 1, 0.25F)[1].at(60, 44), 0);
}

}  // namespace
}  // namespace aftershade::tests
