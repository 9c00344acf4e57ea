#include "core/temporal/temporal_window.h"

#include "core/base/error.h"
#include "tests/temporal/window_helpers.h"

namespace aftershade::tests {
namespace {

using temporal::ChangeTest;

constexpr int kWidth = 64, kHeight = 48;
const Window kWindow = window_of(kWidth, kHeight);

TemporalWindowParams with(int frames, ChangeTest test) {
  TemporalWindowParams params;
  params.frames = frames;
  params.change_test = test;
  return params;
}

/// A still camera before a still wall whose AO is `ao`.
std::vector<WindowFrame> still_frames(int count, const std::function<float(int x, int y, int frame)>& ao) {
  std::vector<WindowFrame> frames;
  for (int f = 0; f < count; ++f) {
    frames.push_back(window_frame(10 + f, kWindow, camera_at({0, 0, 0})));
    add_still_vectors(frames.back());
    frames.back().ao = plane_of(kWidth, kHeight, [&](int x, int y) { return ao(x, y, f); });
  }
  return frames;
}
float white(int x, int y, int frame) { return noise(x, y, frame, 7); }

TEST(TemporalWindow, AConstantAoStaysTheSameToTheBit) {
  std::vector<WindowFrame> frames = busy_frames(9);
  for (WindowFrame& frame : frames) frame.ao = Plane(frame.window.width(), frame.window.height(), 0.7F);
  for (const ChangeTest test : {ChangeTest::near_moving, ChangeTest::everywhere, ChangeTest::never}) {
    const WindowedAo got = windowed(with(4, test), frames, 4);
    const Window w = frames[4].window;
    EXPECT_EQ(different_pixels(got.ao, Plane(w.width(), w.height(), 0.7F)), 0);
  }
}

TEST(TemporalWindow, AStillPictureIsTheMeanWithTheDocumentedWeights) {
  constexpr int kFrames = 3;
  const std::vector<WindowFrame> frames = still_frames(9, white);
  for (const size_t centre : {size_t{4}, size_t{0}, size_t{7}}) {  // a whole window, and one-sided at both ends
    const WindowedAo got = windowed(with(kFrames, ChangeTest::near_moving), frames, centre);
    double whole = 0, used = 0;
    for (int d = -kFrames; d <= kFrames; ++d) {
      whole += window_weight(d, kFrames);
      if (static_cast<int>(centre) + d >= 0 && static_cast<int>(centre) + d < 9) used += window_weight(d, kFrames);
    }
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        double sum = 0;
        for (int d = -kFrames; d <= kFrames; ++d) {
          const int f = static_cast<int>(centre) + d;
          if (f >= 0 && f < 9) sum += window_weight(d, kFrames) * white(x, y, f);
        }
        ASSERT_NEAR(got.ao(x, y), sum / used, 1e-6);
        ASSERT_NEAR(got.weight(x, y), used / whole, 1e-6);
      }
  }
}

TEST(TemporalWindow, NoiseFallsAsTheWeightsPredict) {
  constexpr int kFrames = 4;
  const std::vector<WindowFrame> frames = still_frames(20, white);
  double sum = 0, squares = 0, steps = 0;
  for (int d = -kFrames - 1; d <= kFrames; ++d) {
    sum += window_weight(d, kFrames);  // 0 at d = -k - 1
    squares += std::pow(window_weight(d, kFrames), 2);
    steps += std::pow(window_weight(d, kFrames) - window_weight(d + 1, kFrames), 2);
  }
  double variance = 0, flicker = 0, count = 0;
  for (size_t f = kFrames; f + kFrames + 1 < frames.size(); ++f) {
    const WindowedAo a = windowed(with(kFrames, ChangeTest::near_moving), frames, f);
    const WindowedAo b = windowed(with(kFrames, ChangeTest::near_moving), frames, f + 1);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        variance += std::pow(a.ao(x, y) - 0.5, 2);
        flicker += std::pow(a.ao(x, y) - b.ao(x, y), 2);
        ++count;
      }
  }
  constexpr double kUniform = 1.0 / 12;
  EXPECT_NEAR(variance / count / kUniform / (squares / (sum * sum)), 1, 0.03);
  EXPECT_NEAR(flicker / count / kUniform / (steps / (sum * sum)), 1, 0.03);
}

TEST(TemporalWindow, FramesBeyondTheWindowOrAGapDoNotMatter) {
  const std::vector<WindowFrame> frames = busy_frames(13);
  for (const ChangeTest test : {ChangeTest::near_moving, ChangeTest::everywhere}) {
    const TemporalWindowParams params = with(3, test);
    const WindowedAo whole = windowed(params, frames, 6);
    const std::vector<const WindowFrame*> all = pointers(frames), part(all.begin() + 3, all.begin() + 10);
    const WindowedAo chunk = temporal::temporal_window(params, part, 3);
    EXPECT_EQ(different_pixels(whole.ao, chunk.ao) + different_pixels(whole.weight, chunk.weight), 0);
    std::vector<const WindowFrame*> gap = all;
    gap.erase(gap.begin() + 4);  // frame 3, which then ends at 5, is as if there were none before 5
    const std::vector<const WindowFrame*> short_part(all.begin() + 5, all.end());
    EXPECT_EQ(different_pixels(temporal::temporal_window(params, gap, 5).ao,
                               temporal::temporal_window(params, short_part, 1).ao),
              0);
  }
}

TEST(TemporalWindow, AloneAFrameKeepsItsAo) {
  std::vector<WindowFrame> frames = busy_frames(1);
  EXPECT_EQ(different_pixels(windowed({}, frames, 0).ao, frames[0].ao), 0);
  frames = busy_frames(3);
  EXPECT_EQ(different_pixels(windowed(with(0, ChangeTest::everywhere), frames, 1).ao, frames[1].ao), 0);
}

TEST(TemporalWindow, DoesNotDependOnThreads) {
  const std::vector<WindowFrame> frames = busy_frames(9);
  const WindowedAo many = windowed({}, frames, 4);
  const ThreadLimit one(1);
  const WindowedAo single = windowed({}, frames, 4);
  EXPECT_EQ(different_pixels(many.ao, single.ao) + different_pixels(many.weight, single.weight), 0);
}

TEST(TemporalWindow, ASceneScaledByAPowerOfTwoGivesTheSameBits) {
  for (const ChangeTest test : {ChangeTest::near_moving, ChangeTest::everywhere}) {
    TemporalWindowParams params = with(4, test);
    params.occluder_radius_m = 0.7F;
    const WindowedAo metres = windowed(params, busy_frames(9), 4);
    params.distance_m *= 64;
    params.occluder_radius_m *= 64;
    const WindowedAo scaled = windowed(params, busy_frames(9, 64), 4);
    EXPECT_EQ(different_pixels(metres.ao, scaled.ao) + different_pixels(metres.weight, scaled.weight), 0);
  }
}

TEST(TemporalWindow, AWindowThatIsCutAndMovedChangesNothingInside) {
  // Still content in absolute coordinates; the parts move with the frames. Without the test of changes, whose
  // neighbourhood ends at the border.
  const std::vector<WindowFrame> whole = still_frames(7, white);
  std::vector<WindowFrame> parts;
  for (int f = 0; f < 7; ++f) {
    WindowFrame part = window_frame(10 + f, window_of(48 - f, 40, 2 * f, 7 - f), whole[0].camera);
    add_still_vectors(part);
    copy_at(whole[static_cast<size_t>(f)].ao, part.ao, -part.window.min_x, -part.window.min_y);
    parts.push_back(std::move(part));
  }
  const WindowedAo want = windowed(with(3, ChangeTest::never), whole, 3),
                   got = windowed(with(3, ChangeTest::never), parts, 3);
  const Window centre = parts[3].window;
  int inside = 0;
  for (int y = 8; y < 40; ++y)
    for (int x = 12; x < 40; ++x) {
      ASSERT_EQ(got.ao(x - centre.min_x, y - centre.min_y), want.ao(x, y));
      ASSERT_EQ(got.weight(x - centre.min_x, y - centre.min_y), want.weight(x, y));
      ++inside;
    }
  EXPECT_EQ(inside, 32 * 28);
  EXPECT_LT(got.weight(0, 16), 0.9F) << "the left column lies outside the later parts";
}

TEST(TemporalWindow, BadValuesNeverSpread) {
  std::vector<WindowFrame> frames = busy_frames(9);
  const float bad[] = {kNaN, kInf, -kInf, -3.0F, 1e38F};
  int seed = 20;
  for (WindowFrame& frame : frames) {
    frame.ao = Plane(frame.window.width(), frame.window.height(), 0.4F);
    for (Plane* plane : {&frame.depth, &frame.nx, &frame.ny, &frame.nz, &frame.mv_prev.x, &frame.mv_prev.y,
                         &frame.mv_next.x, &frame.mv_next.y}) {
      ++seed;
      for (int y = 0; y < plane->height(); ++y)
        for (int x = 0; x < plane->width(); ++x)
          if (noise(x, y, frame.number, seed) < 0.15F) (*plane)(x, y) = bad[(x + 3 * y) % 5];
    }
    for (int y = 0; y < frame.ao.height(); ++y)
      for (int x = 0; x < frame.ao.width(); ++x)
        if (noise(x, y, frame.number, seed) < 0.1F) frame.ao(x, y) = bad[x % 3];
  }
  for (const ChangeTest test : {ChangeTest::near_moving, ChangeTest::everywhere, ChangeTest::never}) {
    const WindowedAo got = windowed(with(4, test), frames, 4);
    for (int y = 0; y < got.ao.height(); ++y)
      for (int x = 0; x < got.ao.width(); ++x) {
        const bool good = std::isfinite(frames[4].ao(x, y));
        ASSERT_TRUE(good ? got.ao(x, y) == 0.4F : got.ao(x, y) >= 0.4F && got.ao(x, y) <= 1.0F) << got.ao(x, y);
        ASSERT_TRUE(got.weight(x, y) > 0 && got.weight(x, y) <= 1.000001F) << got.weight(x, y);
      }
  }
}

TEST(TemporalWindow, BackgroundKeepsItsAo) {
  std::vector<WindowFrame> frames = still_frames(5, white);
  for (WindowFrame& frame : frames) frame.depth(9, 9) = kInf;
  const WindowedAo got = windowed(with(2, ChangeTest::near_moving), frames, 2);
  EXPECT_EQ(got.ao(9, 9), white(9, 9, 2));
  EXPECT_NE(got.ao(10, 9), white(10, 9, 2));
}

TEST(TemporalWindow, PlanesOfAnotherSizeAreRefused) {
  std::vector<WindowFrame> frames = busy_frames(3);
  frames[2].mv_next.y = Plane(3, 3);
  EXPECT_THROW(windowed({}, frames, 1), Error);
  EXPECT_NO_THROW(windowed(with(0, ChangeTest::never), frames, 1)) << "a frame outside the window is not looked at";
}

TEST(TemporalWindowParams, TableCoversEveryMember) {
  TemporalWindowParams params;
  params::read(TemporalWindowParams::table(), &params,
               params::Json::parse(R"({"frames": 3, "distance_m": 0.5, "distance_footprints": 1, "moving_depth": 0.1,
                 "normal_deg": 30, "agreement_px": 0.5, "change_test": "never", "occluder_radius_m": 2,
                 "neighbourhood_px": 5, "change": 0.01, "significance": 3})"),
               "test");
  const TemporalWindowParams want{3, 0.5F, 1, 0.1F, 30, 0.5F, ChangeTest::never, 2, 5, 0.01F, 3};
  EXPECT_EQ(params, want);
  EXPECT_EQ(TemporalWindowParams::table().size(), 11U);
}

}  // namespace
}  // namespace aftershade::tests
