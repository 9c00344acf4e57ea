// The slides' story of seed 000, on scenes small enough for a test: an infinite tolerance ghosts, 0.1 % flickers, 10 %
// trails, Selective Temporal Filtering does neither; a two-sided window does better at both. bench_temporal_story has
// the whole table. Bounds are regressions a little beyond what was measured; the figures are printed.
#include "tests/pipeline/temporal_story.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace aftershade::tests {
namespace {

/// Where objects move, the truth is ray-traced; where only the camera moves, it does not change and costs nothing.
constexpr StorySize kMovingSize{160, 90, 64}, kStillSize{};
constexpr const char* kStillScenes[] = {"columns", "grass"};

/// Scores of one scene by system, each made when it is asked for.
class Scores {
 public:
  Scores(const std::string& scene, const StorySize& size)
      : scene_(scene), story_(scene, size), systems_(story_systems()) {}
  const StoryScore& operator[](const std::string& name) {
    const auto found = scores_.find(name);
    if (found != scores_.end()) return found->second;
    const StoryScore& s = scores_[name] = story_.score(find_system(systems_, name).preset);
    std::printf("%s, %s: flicker %.4f on unstable, %.4f on stable pixels", scene_.c_str(), name.c_str(),
                s.unstable.mean, s.stable.mean);
    if (s.trail)
      std::printf("; trail %+.5f (%.1f %% above 0.03), ghost %.4f", s.trail->all.mean, 100 * s.trail->all.visible,
                  s.ghost->all.absolute);
    std::printf("\n");
    return s;
  }

 private:
  std::string scene_;
  Story story_;
  std::vector<StorySystem> systems_;
  std::map<std::string, StoryScore> scores_;
};

Scores& trail() {
  static Scores scores("trail", kMovingSize);
  return scores;
}
Scores& still(const std::string& scene) {
  static Scores columns("columns", kStillSize), grass("grass", kStillSize);
  return scene == "columns" ? columns : grass;
}
double unstable(const char* scene, const char* system) { return still(scene)[system].unstable.mean; }
double stable(const char* scene, const char* system) { return still(scene)[system].stable.mean; }
double trail_of(const std::string& name) { return std::abs(trail()[name].trail->all.mean); }

TEST(TemporalStory, TheTrailSceneHasItsFloorWithinTheStableDistance) {
  const StoryScore& s = trail()["no filter"];
  EXPECT_GT(s.stable_trail->all.count, 0.95 * static_cast<double>(s.trail->all.count));
  EXPECT_GT(s.stable.count, 3 * s.unstable.count);
}

TEST(TemporalStory, AnInfiniteToleranceGhosts) {
  EXPECT_GT(trail()["epsilon infinite"].ghost->all.visible, 0.3);
  EXPECT_GT(trail()["epsilon infinite"].unstable.mean, 1.5 * trail()["epsilon 10 %"].unstable.mean);
  EXPECT_LT(trail()["STF"].ghost->all.visible, 0.02);
}

TEST(TemporalStory, APerMilleFlickers) {
  for (const char* scene : kStillScenes) {
    EXPECT_GT(unstable(scene, "epsilon 0.1 %"), 0.5 * unstable(scene, "no filter")) << scene;
    EXPECT_GT(unstable(scene, "epsilon 0.1 %"), 2.5 * unstable(scene, "epsilon 10 %")) << scene;
  }
}

TEST(TemporalStory, TenPerCentAndSelectionDoNotFlicker) {
  for (const char* scene : kStillScenes)
    for (const char* system : {"epsilon 10 %", "STF"})
      EXPECT_LT(unstable(scene, system), 0.33 * unstable(scene, "no filter")) << scene << " " << system;
}

TEST(TemporalStory, TenPerCentTrails) {
  EXPECT_GT(trail_of("epsilon 10 %"), 0.01);
  EXPECT_GT(trail()["epsilon 10 %"].trail->all.visible, 0.15);
  EXPECT_GT(trail()["epsilon 10 %"].trail->half_life_frames, 3);
}

TEST(TemporalStory, SelectionDoesNotTrail) {
  EXPECT_LT(trail_of("STF"), 0.05 * trail_of("epsilon 10 %"));
  EXPECT_LT(trail()["STF"].trail->all.visible, 0.01);
  EXPECT_LT(trail()["STF"].unstable.mean, 0.75 * trail()["no filter"].unstable.mean);
}

TEST(TemporalStory, MoreResolutionFlickersLessButMoreThanSelection) {
  for (const char* scene : kStillScenes)
    for (const char* system : {"full resolution", "dual resolution"}) {
      EXPECT_LT(unstable(scene, system), unstable(scene, "no filter")) << scene << " " << system;
      EXPECT_GT(unstable(scene, system), 2 * unstable(scene, "STF")) << scene << " " << system;
    }
}

TEST(TemporalStory, ATwoSidedWindowHasHalfOfSelectionsFlicker) {
  for (const char* scene : kStillScenes) {
    EXPECT_LE(stable(scene, "two-sided window"), 0.5 * stable(scene, "STF")) << scene;
    EXPECT_LE(stable(scene, "two-sided window 10"), 0.5 * stable(scene, "STF")) << scene;
    EXPECT_LE(unstable(scene, "two-sided window 10"), 0.5 * unstable(scene, "STF")) << scene;
    std::printf("%s: the window of 7 frames has %.3f of STF's flicker on unstable pixels\n", scene,
                unstable(scene, "two-sided window") / unstable(scene, "STF"));
  }
}

TEST(TemporalStory, ATwoSidedWindowHasHalfOfSelectionsTrail) {
  for (const char* system : {"two-sided window", "two-sided window 10"}) {
    EXPECT_LE(trail_of(system), 0.5 * trail_of("STF")) << system;
    EXPECT_LE(trail()[system].trail->all.absolute, 0.5 * trail()["STF"].trail->all.absolute) << system;
  }
}

}  // namespace
}  // namespace aftershade::tests
