#include <cstdio>

#include "tests/temporal/blur_frames.h"

/// What the temporal blur does over many frames: how smooth it becomes, how fast, what trails and what does not.
namespace aftershade::tests {
namespace {

using temporal::BlurTaps;
using temporal::TemporalBlurHistory;
using temporal::TemporalBlurParams;

const View kWall = [](double, double) { return Hit{5, Vec3(0, 0, -1)}; };

BlurFrame wall(int size, int step) { return {picture(size, size, Lens{200, 200, 0, 0}, kWall), step}; }

TemporalBlurParams smoothing(BlurTaps taps, float a) {
  TemporalBlurParams params;
  params.weights = taps;
  params.history_weight = a;
  params.difference_scale = 0;
  return params;
}

/// Along x, in texels, of a picture that was one texel.
double spread(ConstPlaneView impulse) {
  double sum = 0, first = 0, second = 0;
  for (int y = 0; y < impulse.height; ++y)
    for (int x = 0; x < impulse.width; ++x) {
      const double v = impulse(x, y);
      sum += v;
      first += v * x;
      second += v * x * x;
    }
  return std::sqrt(second / sum - first / sum * first / sum);
}

/// Standard deviation in full-resolution pixels after so many frames of one still texel among none.
double sigma_px(const TemporalBlurParams& params, int frames) {
  constexpr int kTexels = 101;  // 50 texels to each side: more than 7 standard deviations
  BlurFrame frame = wall(2 * kTexels, 2);
  frame.value = Plane(kTexels, kTexels);
  frame.value(kTexels / 2, kTexels / 2) = 1;
  TemporalBlurHistory history;
  Plane out;
  for (int i = 0; i < frames; ++i) out = frame.run(params, history);
  EXPECT_NEAR(std::sqrt(history.variance(kTexels / 2, kTexels / 2)) * 2, spread(history.value) * 2, 0.02)
      << "the variance that is kept is the kernel's own";
  return spread(out) * 2;
}

TEST(TemporalBlurStory, TheKernelGrowsToTheSteadyStateOfTheFormula) {
  // algorithms 5.3: variance 2 s^2 + s^2 a / (1 - a) per axis; half-resolution texels are 2 px.
  for (const auto& [taps, a, frames, published] : {std::tuple(BlurTaps::box, 0.9F, 90, 9.4),
                                                   {BlurTaps::box, 0.95F, 180, 13.0},
                                                   {BlurTaps::binomial, 0.9F, 90, 6.6},
                                                   {BlurTaps::binomial, 0.95F, 180, 9.2}}) {
    const double s2 = taps == BlurTaps::box ? 2 : 1, weight = static_cast<double>(a);
    const double formula = 2 * std::sqrt(2 * s2 + s2 * weight / (1 - weight));
    const double measured = sigma_px(smoothing(taps, a), frames);
    std::printf("%s a %.2f: %.3f px after %d frames, formula %.3f, published %.1f\n",
                taps == BlurTaps::box ? "box" : "binomial", weight, measured, frames, formula, published);
    EXPECT_NEAR(measured, formula, 0.02);
    EXPECT_NEAR(formula, published, 0.06);
  }
}

TEST(TemporalBlurStory, SharpnessBreathesUnlessTheStartIsWarm) {
  // algorithms 5.3: 4.0, 4.8, 6.0, 7.3, 8.6 px after 1, 2, 4, 8, 16 frames.
  TemporalBlurParams params = smoothing(BlurTaps::box, 0.9F);
  for (const auto& [frames, published] : {std::pair(1, 4.0), {2, 4.8}, {4, 6.0}, {8, 7.3}, {16, 8.6}}) {
    params.warm_start = false;
    const double cold = sigma_px(params, frames);
    params.warm_start = true;
    const double warm = sigma_px(params, frames);
    std::printf("after %d frames: %.2f px, with a warm start %.2f\n", frames, cold, warm);
    EXPECT_NEAR(cold, published, 0.06);
    EXPECT_NEAR(warm, 9.38, 1.0) << "as smooth as the steady state, up to whole texels between taps";
  }
}

/// Frames from the jump of a shadow of visibility 0.3 (all of the picture; away at once) until a pixel has come back by
/// 90 %.
int frames_to_90_percent(TemporalBlurParams params, float difference_scale) {
  params.difference_scale = difference_scale;
  BlurFrame frame = wall(40, 2);
  TemporalBlurHistory history;
  frame.set_value([](int, int) { return 0.3F; });
  for (int i = 0; i < 3; ++i) frame.run(params, history);
  frame.set_value([](int, int) { return 1.0F; });
  for (int frames = 1; frames < 200; ++frames)
    if (frame.run(params, history)(10, 10) >= 0.93F) return frames;
  return 200;
}

TEST(TemporalBlurStory, TheDifferenceInAoRemovesTheTrail) {
  const TemporalBlurParams params;
  const int without = frames_to_90_percent(params, 0), published = frames_to_90_percent(params, 1),
            with = frames_to_90_percent(params, params.difference_scale);
  std::printf("back by 90 %% after %d frames without the difference, %d with it, %d at its default scale\n", without,
              published, with);
  EXPECT_EQ(without, 22) << "0.9^22 = 0.098";
  EXPECT_EQ(published, 1) << "1 - 0.7 leaves 0.09 of the weight";
  EXPECT_EQ(with, 1);
}

TEST(TemporalBlurStory, ASteepSlopeFarAwayIsBlurredUnlessLiteral) {
  // algorithms 5.4: at 10 m, a surface tilted by 45 degrees differs by more than 2 cm from texel to texel.
  const float focal = 270 / std::tan(30 * 3.14159265F / 180);  // 540 lines, 60 degrees
  const Lens lens{focal, focal, 40, 40};
  const View slope = [&](double x, double y) { return meet_plane(lens, x, y, {0, 1, -1}, -10 / std::sqrt(2.0)); };
  for (const float footprints : {0.0F, 1.0F}) {
    TemporalBlurParams params;
    params.cut_footprints = footprints;
    BlurFrame frame(picture(80, 80, lens, slope), 1);
    frame.set_value([](int, int y) { return y % 2 ? 1.0F : 0.0F; });
    const auto contrast = [&](bool literal) {
      params.literal = literal;
      TemporalBlurHistory history;
      const Plane out = frame.run(params, history);
      return std::abs(out(20, 20) - out(20, 21));
    };
    EXPECT_LT(contrast(false), 0.1F);
    if (footprints == 0) {
      EXPECT_EQ(contrast(true), 1.0F) << "rows are not blurred at all";
    }
  }
}

}  // namespace
}  // namespace aftershade::tests
