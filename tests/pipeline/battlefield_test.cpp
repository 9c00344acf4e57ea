// Battlefield 3's presets: their stages work on the resolutions that the talk states, and its experiments are settings.
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/pipeline/pipeline.h"
#include "tests/pipeline/memory_sequence.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"

namespace aftershade::pipeline {
namespace {

const Offer kDepthAndCamera{{Role::depth, Role::normal}, true, true};

preset::Preset high(const std::vector<std::string>& sets) {
  return preset::load_preset("battlefield3-high", sets).preset;
}

tests::MemorySink run_high(FrameSource& source, std::vector<int> frames, const std::vector<std::string>& sets) {
  std::vector<ViewPipeline> views;
  views.emplace_back(high(sets), "", kDepthAndCamera, Outputs{"AO", false, {pipeline::AovSet::all(), false}});
  tests::MemorySink sink;
  RunOptions options;
  options.written = options.on_disk = std::move(frames);
  options.preroll = kPrerollAll;
  run(views, source, sink, options);
  return sink;
}

tests::SceneSource grass(int first, int last) { return {tests::find_scene("grass"), {96, 54, 1}, first, last}; }

int differing(ConstPlaneView a, ConstPlaneView b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += a(x, y) != b(x, y) ? 1 : 0;
  return count;
}

double largest(ConstPlaneView plane) {
  double largest = 0;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) largest = std::max<double>(largest, plane(x, y));
  return largest;
}

TEST(Battlefield, TheMaskIsThatOfTheHalfResolutionAoUnderTheFullResolutionFilter) {
  tests::SceneSource source = grass(1, 3);
  const tests::MemorySink sink = run_high(source, {1, 2, 3}, {"temporal.distance_m=0.5"});
  const Plane &mask = sink.planes.at(3).at("aftershade.mask"), &count = sink.planes.at(3).at("aftershade.history_age");
  int stable = 0, between = 0;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      ASSERT_EQ(mask(x, y), mask(x & ~1, y & ~1)) << "one value a block";
      stable += mask(x, y) > 0 ? 1 : 0;
      between += count(x, y) != count(x & ~1, y & ~1) ? 1 : 0;
    }
  EXPECT_GT(stable, 400);
  EXPECT_LT(stable, 5000);
  EXPECT_GT(between, 100) << "the history has every pixel";
}

TEST(Battlefield, TheBlurAlsoTakesAoThatIsAtEveryPixel) {
  for (const char* resolution : {"full", "dual"}) {
    tests::SceneSource source = grass(1, 1), half = grass(1, 1);
    const tests::MemorySink sink = run_high(source, {1}, {std::string("ao.resolution=") + resolution});
    EXPECT_GT(differing(sink.planes.at(1).at("AO"), run_high(half, {1}, {}).planes.at(1).at("AO")), 1000);
    EXPECT_GT(largest(sink.planes.at(1).at("AO")), 0.9);
  }
}

TEST(Battlefield, TheSlidesExperimentsAreSettings) {
  const auto filtered_pixels = [](const std::vector<std::string>& sets) {
    tests::SceneSource source = grass(1, 4);
    const tests::MemorySink sink = run_high(source, {1, 2, 3, 4}, sets);
    const Plane& count = sink.planes.at(4).at("aftershade.history_age");
    int filtered = 0;
    for (int y = 0; y < count.height(); ++y)
      for (int x = 0; x < count.width(); ++x) filtered += count(x, y) > 1 ? 1 : 0;
    return filtered;
  };
  const int ten_percent = filtered_pixels({}), tenth_of_a_percent = filtered_pixels({"temporal.epsilon=0.001"});
  const int infinite = filtered_pixels({"temporal.epsilon=1e9"});
  const int everywhere = filtered_pixels({"temporal.selective=false"});
  EXPECT_LT(tenth_of_a_percent, ten_percent / 2);
  EXPECT_GT(infinite, ten_percent);
  EXPECT_GT(everywhere, ten_percent);
  EXPECT_GT(filtered_pixels({"temporal.selective=false", "temporal.epsilon=1e9"}), everywhere);
  EXPECT_NO_THROW(filtered_pixels({"temporal.literal=true", "ao.literal=true", "blur.sampling=brute-force"}));
}

/// Frame n is the scene at time 2n.
class EverySecond final : public FrameSource {
 public:
  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) override {
    std::optional<Frame> frame = grass(2, 8).load(2 * number, view, roles, with_layers);
    if (frame) frame->number = number;
    return frame;
  }
};

TEST(Battlefield, EachAlternatingHistoryIsThatOfItsOwnFrames) {
  // Two lanes over frames 1 to 8 do on the even ones what a single one does on every second frame.
  tests::SceneSource source = grass(1, 8);
  EverySecond second;
  const tests::MemorySink both = run_high(source, {1, 2, 3, 4, 5, 6, 7, 8}, {"temporal.afr_lanes=2"});
  const tests::MemorySink one = run_high(second, {1, 2, 3, 4}, {});
  for (const int frame : {1, 2, 3, 4})
    for (const char* channel : {"AO", "aftershade.history_age"})
      EXPECT_EQ(differing(both.planes.at(2 * frame).at(channel), one.planes.at(frame).at(channel)), 0) << frame;
  EXPECT_EQ(largest(both.planes.at(2).at("aftershade.history_age")), 1) << "frame 2 does not know frame 1";
  EXPECT_EQ(largest(both.planes.at(3).at("aftershade.history_age")), 2);
  EXPECT_GT(largest(both.planes.at(8).at("aftershade.history_age")), 3.9);
}

TEST(Battlefield, AlternatingHistoriesNeedCameras) {
  const Offer vectors{{Role::depth, Role::velocity_prev}, true, false};
  const auto make = [&](const std::vector<std::string>& sets) { ViewPipeline(high(sets), "", vectors, {}); };
  EXPECT_NO_THROW(make({"temporal.reprojection=auto"}));
  EXPECT_THROW(make({"temporal.reprojection=auto", "temporal.afr_lanes=2"}), Error);
  EXPECT_THROW(make({}), Error) << "the game reprojects by its camera";
}

TEST(Battlefield, UltraIsHigh) { EXPECT_EQ(preset::load_preset("battlefield3-ultra").preset.stages, high({}).stages); }

}  // namespace
}  // namespace aftershade::pipeline
