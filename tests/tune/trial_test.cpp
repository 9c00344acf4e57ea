#include "core/tune/trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/tune/measure.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"
#include "tests/support/truth.h"

/// Tuning from end to end, in memory: presets on rendered frames beside ray-traced truth.
namespace aftershade::tune {
namespace {

using namespace aftershade::tests;

constexpr int kWidth = 96, kHeight = 54;
const RenderSettings kSmall{kWidth, kHeight, 1};
constexpr const char* kPreset = R"({"description": "", "stages": [
  {"id": "ao", "method": "slice-ao", "resolution": "full", "slices": 4, "steps": 8, "radius_m": 1.5},
  {"id": "apply", "method": "apply-ao"}]})";

preset::Preset slices(double radius_m) {
  preset::Preset preset = preset::from_json(params::Json::parse(kPreset), "slices.json");
  return with_values(preset, "ao", {{"radius_m", 0.01, 10}}, {radius_m});
}

/// Counts what is read.
class Counting final : public FrameSource {
 public:
  explicit Counting(FrameSource& source) : source_(source) {}
  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool layers) override {
    ++loads[number];
    return source_.load(number, view, roles, layers);
  }
  std::map<int, int> loads;

 private:
  FrameSource& source_;
};

struct Bench {
  explicit Bench(const std::string& metric, std::string_view scene_name = "columns")
      : scene(find_scene(scene_name)), rendered(scene, kSmall, 1, 6), counted(rendered) {
    setup.offer = {kSceneRoles, true, true};
    setup.on_disk = {1, 2, 3, 4, 5, 6};
    setup.metric = metric_named(metric);
    const Wanted wanted = wanted_by(slices(1), setup);
    source.emplace(counted, wanted.roles, wanted.layers);
  }
  Trial trial() { return Trial(setup, *source); }
  const Scene& scene;
  SceneSource rendered;
  Counting counted;
  TrialSetup setup;
  std::optional<FramesInMemory> source;
};

Targets traced_targets(Bench& bench, const std::vector<int>& frames, double radius_m) {
  Targets targets;
  AoTruth truth;
  truth.radius_m = radius_m, truth.rays = 128;
  for (const int number : frames) {
    Target& target = targets[number];
    target.truth.ao = ambient_occlusion_truth(bench.scene, number, kWidth, kHeight, truth);
    target.depth = copy_of(bench.rendered.load(number, "", {Role::depth}, false)->depth());
  }
  return targets;
}

Found tune_radius(const Trial& trial, const Targets& targets, double start_m, int evaluations = 40) {
  const preset::Preset start = slices(start_m);
  Problem problem{{{"radius_m", 0.1, 10}}, {start_m}, {}, [](const auto&) { return Cost{1, 1}; }};
  problem.score = [&](const auto& values) {
    return trial.score(with_values(start, "ao", problem.axes, values), targets);
  };
  SearchOptions options;
  options.evaluations = evaluations;
  return search(problem, options);
}

TEST(Trial, FindsARadiusThatIsWrongByThree) {
  Bench bench("ao_rmse");
  const Trial trial = bench.trial();
  const Targets targets = traced_targets(bench, {2, 5}, 0.5);
  const double right = trial.score(slices(0.5), targets), wrong = trial.score(slices(1.5), targets);
  ASSERT_GT(wrong, 1.5 * right) << "the scene must show the radius";
  const Found found = tune_radius(trial, targets, 1.5);
  EXPECT_LE(found.best.score, right * 1.001) << "radius " << found.best.values[0];
  EXPECT_GT(found.best.values[0], 0.33);
  EXPECT_LT(found.best.values[0], 0.75);
  const Targets others = traced_targets(bench, {4}, 0.5);
  EXPECT_LT(trial.score(slices(found.best.values[0]), others), trial.score(slices(1.5), others)) << "on another frame";
}

TEST(Trial, APresetsOwnResultIsReachedExactly) {
  Bench bench("ao_rmse");
  const Trial trial = bench.trial();
  Targets targets = traced_targets(bench, {3}, 0.5);
  targets[3].truth = std::move(trial.results(slices(0.5), {3}).at(3));
  EXPECT_EQ(trial.score(slices(0.5), targets), 0);
  const Found found = tune_radius(trial, targets, 1.5, 60);
  EXPECT_LT(found.best.score, 0.01 * found.start.score);
  EXPECT_NEAR(found.best.values[0], 0.5, 0.02);
}

TEST(Trial, TheSameTrialGivesTheSameScoreAndPreset) {
  Bench a("ao_rmse"), b("ao_rmse");
  const Targets targets_a = traced_targets(a, {2, 5}, 0.5), targets_b = traced_targets(b, {2, 5}, 0.5);
  const Found found_a = tune_radius(a.trial(), targets_a, 1.5, 15),
              found_b = tune_radius(b.trial(), targets_b, 1.5, 15);
  EXPECT_EQ(found_a.best, found_b.best);
  EXPECT_EQ(found_a.front, found_b.front);
}

TEST(Trial, FramesAreReadOnceAndNotChanged) {
  Bench bench("psnr");
  const Trial trial = bench.trial();
  const auto color = [&] { return copy_of(bench.source->load(2, "", {}, true)->layers.front().planes.front()); };
  const Plane before = color();
  Targets targets;
  targets[2].truth = std::move(trial.results(slices(0.5), {2}).at(2));
  ASSERT_EQ(targets[2].truth.color.size(), 3U);
  const double first = trial.score(slices(1.5), targets);
  EXPECT_EQ(trial.score(slices(1.5), targets), first);
  EXPECT_TRUE(std::isfinite(first));
  EXPECT_EQ(trial.score(slices(0.5), targets), std::numeric_limits<double>::infinity());
  EXPECT_EQ(bench.counted.loads, (std::map<int, int>{{2, 1}}));
  EXPECT_EQ(metrics::rmse(color(), before), 0) << "what stages do to the colour stays with them";
}

TEST(Trial, CountsWhereTheMaskSaysSo) {
  Bench bench("ao_rmse");
  const Trial trial = bench.trial();
  Targets targets = traced_targets(bench, {3}, 0.5);
  const double everywhere = trial.score(slices(1.5), targets);
  targets[3].mask = Plane(kWidth, kHeight, 0);
  EXPECT_TRUE(std::isnan(trial.score(slices(1.5), targets))) << "nowhere";
  for (int y = 0; y < kHeight; ++y) std::fill_n(targets[3].mask.row(y), kWidth / 2, 1.0F);
  EXPECT_NE(trial.score(slices(1.5), targets), everywhere);
}

TEST(Trial, StopsMidway) {
  Bench bench("ao_rmse");
  bench.setup.should_stop = [] { return true; };
  EXPECT_TRUE(std::isnan(bench.trial().score(slices(1), traced_targets(bench, {3}, 0.5))));
}

TEST(Trial, AnUnknownMetricIsSaid) {
  try {
    metric_named("ao_rmsd");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "there is no metric \"ao_rmsd\" (did you mean \"ao_rmse\"?)");
  }
}

TEST(Measure, TwiceTheSlicesTakeLongerAndTheTableSaysSo) {
  Bench bench("ao_rmse");
  const Trial trial = bench.trial();
  const preset::Preset preset = slices(0.5);
  const Axes axes{{"slices", 1, 16, true}, {"radius_m", 0.1, 10}};
  const Subject subject{preset, "ao", axes, 3};
  int rounds = 0;
  const auto table = measure_table(trial, subject, blank_table(subject, *bench.source->load(3, "", {}, false)),
                                   [&](int done) { rounds = done; });
  ASSERT_TRUE(table);
  EXPECT_GE(rounds, kFewestRounds);
  EXPECT_EQ(table->rounds, rounds);
  EXPECT_EQ(table->width, kWidth);
  EXPECT_EQ(table->method, "slice-ao");
  ASSERT_EQ(table->curves.size(), 2U);
  EXPECT_EQ(table->curves[0].values, (std::vector<double>{1, 3, 4, 6, 16}));
  EXPECT_TRUE(table->curves[0].time_varies);
  EXPECT_GT(table->predict({{"slices", 16}}).milliseconds, table->predict({{"slices", 1}}).milliseconds);
  EXPECT_GT(table->cost.cost.bytes, kWidth * kHeight * 4) << "the AO at least";
  EXPECT_FALSE(table->curves[0].memory_varies);
  bench.setup.should_stop = [] { return true; };
  EXPECT_FALSE(
      measure_table(bench.trial(), subject, blank_table(subject, *bench.source->load(3, "", {}, false)), [](int) {}));
}

TEST(Measure, ValuesGoIntoAPresetAndComeBack) {
  const Axes axes{{"slices", 1, 16, true}, {"radius_m", 0.1, 10}};
  const preset::Preset preset = with_values(slices(1), "ao", axes, {7, 0.123});
  EXPECT_EQ(values_of(preset, "ao", axes), (std::vector<double>{7, 0.123}));
  EXPECT_EQ(preset::difference(slices(1), preset),
            (std::vector<std::string>{"ao.slices: 4 -> 7", "ao.radius_m: 1 -> 0.123"}));
}

}  // namespace
}  // namespace aftershade::tune
