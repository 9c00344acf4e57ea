// What the scores of structure and time say of errors that are known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/metrics/scored_scene.h"

namespace aftershade::metrics {
namespace {

using S = SlidingBlock;

/// 0.6 and 0.6 + step in turns.
Value alternating(double even, double beside_railing) {
  return [=](int frame, int x, int) {
    return 0.6 + (frame % 2) * (std::abs(x - S::kRailing) <= 4 ? beside_railing : even);
  };
}

TEST(Flicker, IsTheChangeOfStableAndOfUnstableSurfaces) {
  const Scores scores = score_block({"ao_flicker_stable", "ao_flicker_unstable", "ao_warping_error"},
                                    alternating(0.2, 0.05), [](int, int, int) { return 0.6; });
  EXPECT_NEAR(scores.at("ao_flicker_stable"), 0.2, 1e-6);
  EXPECT_NEAR(scores.at("ao_flicker_unstable"), 0.05, 1e-6);
  EXPECT_LT(scores.at("ao_warping_error"), 0.2);
  EXPECT_GT(scores.at("ao_warping_error"), 0.05);
}

TEST(Flicker, DoesNotCountWhatTheReferenceDoesToo) {
  const Scores scores =
      score_block({"ao_flicker_stable", "ao_flicker_unstable"}, alternating(0.2, 0.05), alternating(0.15, 0.05));
  EXPECT_NEAR(scores.at("ao_flicker_stable"), 0.05, 1e-6);
  EXPECT_NEAR(scores.at("ao_flicker_unstable"), 0, 1e-6);
}

TEST(Flicker, OfColourIsOfTheDisplayLuma) {
  const Scores scores = score_block({"flicker_stable"}, alternating(0.2, 0.2), [](int, int, int) { return 0.6; });
  EXPECT_NEAR(scores.at("flicker_stable"), std::pow(0.8, 1 / 2.2) - std::pow(0.6, 1 / 2.2), 1e-6);
}

TEST(Flicker, WithoutReferenceIsAllChangeAlongTheMotion) {
  SequenceScorer scorer({"ao_flicker_stable"});
  // Painted on the surfaces: it moves with the block, and nothing changes along the motion.
  const auto painted = [](int frame, int x, int y) {
    const int on_surface = S::block(frame, x, y) ? x - S::left(frame) : x;
    return 0.5 + 0.03 * (on_surface % 8);
  };
  for (int frame = 0; frame < 4; ++frame) {
    const BlockFrame block(frame, painted, open);
    ScoredFrame scored = block.scored();
    scored.true_ao = {};
    const Scores scores = scorer.add(scored);
    if (frame > 0) {
      EXPECT_NEAR(scores.at("ao_flicker_stable"), 0, 1e-7);
    }
  }
}

/// A dark trail that halves in `half_life` frames, on what was near the block but never behind it; 0 after 8 frames.
Value with_trail(double half_life) {
  return [=](int frame, int x, int y) {
    const int since = S::since(frame, x, y, S::footprint);
    if (since < 1 || since > kFadingFrames) return 1.0;
    return 1 - 0.4 * std::pow(0.5, (since - 1) / half_life);
  };
}

TEST(Trail, HasTheHalfLifeItWasMadeWith) {
  for (const double half_life : {1.0, 3.0, 5.5}) {
    const Scores scores = score_block({"ao_trail", "ao_trail_visible", "ao_trail_half_life"}, with_trail(half_life));
    EXPECT_NEAR(scores.at("ao_trail_half_life"), half_life, 1e-3);
    double sum = 0, visible = 0;
    int count = 0;
    for (int frame = 1; frame < S::kFrames; ++frame)
      for (int y = 0; y < S::kHeight; ++y)
        for (int x = 0; x < S::kWidth; ++x) {
          const int since = S::since(frame, x, y, S::footprint);
          const bool seen_throughout = y < S::kTop || y > S::kBottom;  // the block hid the rows between
          const bool behind = !seen_throughout && S::since_hidden(frame, x, y) >= 0;
          if (since < 1 || since > kFadingFrames || behind) continue;
          const double error = with_trail(half_life)(frame, x, y) - 1;
          sum += error;
          visible += error < -0.03;
          ++count;
        }
    EXPECT_NEAR(scores.at("ao_trail"), sum / count, 1e-6);
    EXPECT_NEAR(scores.at("ao_trail_visible"), visible / count, 1e-6);
  }
}

TEST(Trail, OfAnErrorThatIsEverywhereIsThatErrorAndDoesNotFade) {
  const Scores scores = score_block({"ao_trail", "ao_trail_half_life"}, [](int, int, int) { return 0.9; });
  EXPECT_NEAR(scores.at("ao_trail"), -0.1, 1e-6);
  EXPECT_EQ(scores.at("ao_trail_half_life"), 0) << "nothing beyond the settled error";
}

TEST(Trail, NeverGoneHasNoHalfLife) {
  const Scores scores = score_block({"ao_trail_half_life"}, [](int frame, int x, int y) {
    const int since = S::since(frame, x, y, S::footprint);
    return since >= 1 && since <= kFadingFrames ? 0.8 : 1.0;
  });
  EXPECT_EQ(scores.at("ao_trail_half_life"), std::numeric_limits<double>::infinity());
}

TEST(Trail, NeedsCamerasThatTellWhatMoves) {
  EXPECT_TRUE(score_block({"ao_trail"}, with_trail(2), open, false).empty());
}

TEST(Disocclusion, HasTheErrorAndTheLagItWasMadeWith) {
  for (const double half_life : {1.0, 2.5}) {
    const auto late = [=](int frame, int x, int y) {
      const int since = S::since_hidden(frame, x, y);
      return since >= 1 && since <= kFadingFrames ? 1 - 0.3 * std::pow(0.5, (since - 1) / half_life) : 1.0;
    };
    const Scores scores = score_block({"ao_disocclusion_error", "ao_disocclusion_lag"}, late);
    EXPECT_NEAR(scores.at("ao_disocclusion_lag"), half_life, 1e-3);
    double sum = 0;
    int count = 0;
    for (int frame = 1; frame < S::kFrames; ++frame)
      for (int y = 0; y < S::kHeight; ++y)
        for (int x = 0; x < S::kWidth; ++x)
          if (const int since = S::since_hidden(frame, x, y); since >= 1 && since <= kFadingFrames) {
            sum += 1 - late(frame, x, y);
            ++count;
          }
    EXPECT_NEAR(scores.at("ao_disocclusion_error"), sum / count, 1e-6);
  }
}

TEST(TileSeam, ShowsTilesOfAnErrorWhereverTheWindowLies) {
  // Errors that step by 0.2 at the borders of 20 px tiles and by 0.1 at every pixel inside.
  const auto tiles = [](int, int x, int) { return 1 - 0.1 * ((x + 7) % 2) - 0.1 * (((x + 7) / 20) % 2); };
  const BlockFrame block(0, tiles, open);
  ScoredFrame scored = block.scored();
  SequenceScorer here({"ao_tile_seam"}), there({"ao_tile_seam"});
  const double not_aligned = here.add(scored).at("ao_tile_seam");
  scored.origin_x = 7;
  const double aligned = there.add(scored).at("ao_tile_seam");
  EXPECT_GT(aligned, not_aligned);
  const double of_20 = tile_seam_ratio(block.ao, block.truth, 20, -7, 0);
  EXPECT_GE(aligned, of_20);
}

TEST(Border, IsWhatTheErrorExceedsThatInsideBy) {
  const auto dark_border = [](int, int x, int y) {
    const int reach = S::kMargin_px;
    return x < reach || y < reach || x >= S::kWidth - reach || y >= S::kHeight - reach ? 0.7 : 0.95;
  };
  EXPECT_NEAR(score_block({"ao_border_error"}, dark_border).at("ao_border_error"), 0.25, 1e-6);
}

}  // namespace
}  // namespace aftershade::metrics
