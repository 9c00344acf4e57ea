#include "core/metrics/sequence_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "core/math/sampling.h"
#include "core/metrics/flip.h"
#include "core/parallel/rows.h"
#include "tests/metrics/metric_planes.h"
#include "tests/metrics/scored_scene.h"

namespace aftershade::metrics {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
using S = SlidingBlock;

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const MetricInfo& metric : metric_infos()) names.emplace_back(metric.name);
  return names;
}

/// 0..0.999, of the pixel and frame alone.
double noise(int frame, int x, int y) {
  return static_cast<double>(
      unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(frame))));
}
double noisy(int frame, int x, int y) { return 0.2 + 0.6 * noise(frame, x, y); }
double other(int frame, int x, int y) { return 0.2 + 0.6 * noise(frame + 100, x, y); }

TEST(MetricInfos, HaveNamesOfTheirOwnAndOneSentence) {
  std::set<std::string_view> names;
  for (const MetricInfo& metric : metric_infos()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_EQ(metric.of_ao, metric.name.starts_with("ao_")) << metric.name;
    EXPECT_GT(metric.doc.size(), 20U) << metric.name;
    EXPECT_FALSE(metric.doc.ends_with('.')) << metric.name;
    EXPECT_TRUE(metric.temporal || !metric.moving) << metric.name;
  }
}

TEST(SequenceScorer, KnowsItsNames) {
  try {
    SequenceScorer({"ao_rmsee"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("did you mean \"ao_rmse\"?"), std::string::npos) << error.what();
  }
}

/// What each metric is when nothing is wrong; warping error alone tells of the picture itself.
TEST(SequenceScorer, FindsEqualSequencesPerfect) {
  const Scores scores = score_block(all_names(), noisy, noisy);
  for (const MetricInfo& metric : metric_infos()) {
    ASSERT_TRUE(scores.contains(std::string(metric.name))) << metric.name;
    const double value = scores.at(std::string(metric.name));
    if (metric.name.ends_with("warping_error"))
      EXPECT_GT(value, 0.1);
    else if (metric.name.ends_with("tile_seam"))
      EXPECT_EQ(value, 1) << metric.name;
    else if (metric.unit == "dB")
      EXPECT_EQ(value, kInf) << metric.name;
    else if (metric.better == Better::higher)
      EXPECT_NEAR(value, 1, 1e-12) << metric.name;
    else
      EXPECT_EQ(value, 0) << metric.name;
  }
}

TEST(SequenceScorer, GivesWhatTheFreeFunctionsGive) {
  SequenceScorer scorer(all_names());
  const BlockFrame frame(0, noisy, other);
  const Scores scores = scorer.add(frame.scored());
  EXPECT_DOUBLE_EQ(scores.at("ao_rmse"), rmse(frame.ao, frame.truth));
  EXPECT_DOUBLE_EQ(scores.at("ao_mae"), mae(frame.ao, frame.truth));
  EXPECT_DOUBLE_EQ(scores.at("ao_bias"), mean_error(frame.ao, frame.truth));
  EXPECT_DOUBLE_EQ(scores.at("ao_correlation"), correlation(frame.ao, frame.truth));
  EXPECT_DOUBLE_EQ(scores.at("ao_ssim"), ssim(frame.ao, frame.truth));
  EXPECT_DOUBLE_EQ(scores.at("rmse"), rmse(frame.ao, frame.truth)) << "three equal channels";
  EXPECT_DOUBLE_EQ(scores.at("mae"), mae(frame.ao, frame.truth));
  EXPECT_DOUBLE_EQ(scores.at("psnr_linear"), psnr(frame.ao, frame.truth));
  const Rgb color{frame.ao, frame.ao, frame.ao}, truth{frame.truth, frame.truth, frame.truth};
  EXPECT_DOUBLE_EQ(scores.at("psnr"), display_psnr(color, truth));
  const Plane ldr = ldr_flip(color, truth), hdr = hdr_flip(color, truth);
  EXPECT_DOUBLE_EQ(scores.at("ldr_flip"), mean_sum(ldr).mean());
  EXPECT_DOUBLE_EQ(scores.at("hdr_flip"), mean_sum(hdr).mean());
  const Displayed shown = displayed(color, truth);
  EXPECT_DOUBLE_EQ(scores.at("ssim"), ssim(shown.luma_a, shown.luma_b));
  EXPECT_FALSE(scores.contains("ao_warping_error")) << "no frame before";
}

TEST(SequenceScorer, DoesNotCareWhichSideIsWhich) {
  for (const MetricInfo& metric : metric_infos()) {
    if (!metric.reference || metric.temporal || metric.name == "hdr_flip") continue;
    const std::string name(metric.name);
    SequenceScorer one({name}), two({name});
    const BlockFrame a(0, noisy, other), b(0, other, noisy);
    const double ab = one.add(a.scored()).at(name), ba = two.add(b.scored()).at(name);
    if (metric.better == Better::zero)
      EXPECT_DOUBLE_EQ(ab, -ba) << name;
    else
      EXPECT_DOUBLE_EQ(ab, ba) << name;
  }
}

TEST(SequenceScorer, PoolsPixelsNotFrames) {
  // Frame 0 is wrong by 0.3 everywhere, frame 1 by 0.1 at a third of the pixels that count.
  SequenceScorer scorer({"ao_rmse", "ao_mae", "ao_bias", "ao_correlation"});
  const Plane zero = plane_of(3, {0, 0, 0}), wrong = plane_of(3, {0.3F, 0.3F, 0.3F}), some = plane_of(3, {0.1F, 9, 9});
  ScoredFrame first, second;
  first.ao = wrong;
  first.true_ao = second.true_ao = zero;
  second.number = 1;
  second.ao = some;
  const Plane mask = plane_of(3, {1, 0, 0});
  second.mask = mask;
  EXPECT_NEAR(scorer.add(first).at("ao_mae"), 0.3, 1e-7);
  EXPECT_NEAR(scorer.add(second).at("ao_mae"), 0.1, 1e-7);
  EXPECT_NEAR(scorer.sequence().at("ao_mae"), (3 * 0.3 + 0.1) / 4, 1e-7);
  EXPECT_NEAR(scorer.sequence().at("ao_rmse"), std::sqrt((3 * 0.09 + 0.01) / 4), 1e-7);
  EXPECT_NEAR(scorer.sequence().at("ao_bias"), 0.25, 1e-7);
}

TEST(SequenceScorer, PoolsCorrelationsOverAllPixels) {
  // Each frame has one value a side, so neither has a correlation; together they lie on a line.
  SequenceScorer scorer({"ao_correlation"});
  for (int frame = 0; frame < 3; ++frame) {
    const Plane a(4, 4, 0.1F * static_cast<float>(frame)), b(4, 4, 0.3F * static_cast<float>(frame));
    ScoredFrame scored;
    scored.number = frame;
    scored.ao = a;
    scored.true_ao = b;
    EXPECT_TRUE(std::isnan(scorer.add(scored).at("ao_correlation")));
  }
  EXPECT_NEAR(scorer.sequence().at("ao_correlation"), 1, 1e-9);
}

TEST(SequenceScorer, CountsWhereTheMaskIsSet) {
  Plane mask(S::kWidth, S::kHeight);
  for (int y = 8; y < 40; ++y)
    for (int x = 8; x < 90; ++x) mask(x, y) = 1;
  // Wrong outside of the mask alone, away from the windows of SSIM and FLIP inside it.
  const auto wrong_outside = [&](int frame, int x, int y) {
    return noisy(frame, x, y) + (x > 110 && x != S::kRailing ? 0.3 : 0);
  };
  SequenceScorer masked(all_names()), whole(all_names());
  for (int frame = 0; frame < S::kFrames; ++frame) {
    const BlockFrame block(frame, wrong_outside, noisy);
    ScoredFrame scored = block.scored();
    whole.add(scored);
    scored.mask = mask;
    masked.add(scored);
  }
  const Scores inside = masked.sequence(), all = whole.sequence();
  for (const char* name : {"rmse", "mae", "ldr_flip", "hdr_flip", "ao_rmse", "ao_mae", "ao_bias"}) {
    EXPECT_EQ(inside.at(name), 0) << name;
    EXPECT_GT(all.at(name), 0) << name;
  }
  for (const char* name : {"ssim", "ao_ssim", "ao_correlation"}) {
    EXPECT_NEAR(inside.at(name), 1, 1e-12) << name;
    EXPECT_LT(all.at(name), 1 - 1e-6) << name;
  }
  EXPECT_EQ(inside.at("psnr"), kInf);
  Plane none(S::kWidth, S::kHeight);
  SequenceScorer nothing(all_names());
  for (int frame = 0; frame < 3; ++frame) {
    const BlockFrame block(frame, noisy, other);
    ScoredFrame scored = block.scored();
    scored.mask = none;
    nothing.add(scored);
  }
  for (const auto& [name, value] : nothing.sequence()) EXPECT_TRUE(std::isnan(value)) << name;
}

TEST(SequenceScorer, LeavesAoOfTheBackgroundOut) {
  BlockFrame frame(0, noisy, noisy);
  for (int x = 0; x < S::kWidth; ++x) {
    frame.depth(x, 0) = std::numeric_limits<float>::infinity();
    frame.ao(x, 0) = 5;
  }
  SequenceScorer scorer({"ao_rmse", "mae"});
  const Scores scores = scorer.add(frame.scored());
  EXPECT_EQ(scores.at("ao_rmse"), 0);
  EXPECT_GT(scores.at("mae"), 0.01) << "colour counts everywhere";
}

TEST(SequenceScorer, LeavesOutWhatItHasNoInputsFor) {
  SequenceScorer scorer(all_names());
  for (int frame = 0; frame < 2; ++frame) {
    const BlockFrame block(frame, noisy, other);
    ScoredFrame scored = block.scored(false);
    scored.true_color = {};
    scored.true_ao = {};
    const Scores scores = scorer.add(scored);
    for (const MetricInfo& metric : metric_infos()) {
      const bool expected = frame == 1 && !metric.reference && !metric.moving;
      EXPECT_EQ(scores.contains(std::string(metric.name)), expected) << metric.name << " of frame " << frame;
    }
  }
  SequenceScorer alone({"ao_rmse", "rmse"});
  const BlockFrame block(0, noisy, other);
  ScoredFrame scored = block.scored();
  scored.color = scored.true_color = {};
  EXPECT_EQ(alone.add(scored).count("rmse"), 0U);
  EXPECT_EQ(alone.sequence().size(), 1U);
}

TEST(SequenceScorer, StartsAgainAfterAGap) {
  SequenceScorer scorer({"ao_warping_error"});
  for (const int number : {1, 2, 4, 5}) {
    const BlockFrame block(number, noisy, other);
    EXPECT_EQ(scorer.add(block.scored()).size(), number == 2 || number == 5 ? 1U : 0U) << number;
  }
}

TEST(SequenceScorer, DoesNotDependOnThreads) {
  set_thread_count(1);
  const Scores one = score_block(all_names(), noisy, other);
  set_thread_count(0);
  for (const auto& [name, value] : score_block(all_names(), noisy, other)) EXPECT_EQ(value, one.at(name)) << name;
}

}  // namespace
}  // namespace aftershade::metrics
