// The two-sided window in the frame loop: any chunk of the sequence gives the same pixels.
#include <gtest/gtest.h>

#include "tests/pipeline/ao_quality.h"

namespace aftershade::pipeline {
namespace {

using tests::blade_frame;
using tests::MemorySink;
using tests::MemorySource;

constexpr int kReach = 3;

/// AO at every pixel, filtered by a window of 3 frames on each side.
preset::Preset windowed_preset(const std::string& reach = "3") {
  return tests::ao_part("high-dx11",
                        {"temporal.method=temporal-window", "temporal.frames=" + reach, "ao.reference_height_px=36"});
}

MemorySink run_window(const preset::Preset& preset, MemorySource& source, const std::vector<int>& written,
                      const Outputs& outputs = {"AO", false, {}}) {
  std::vector<ViewPipeline> views;
  views.emplace_back(preset, "", tests::kFullOffer, outputs);
  MemorySink sink;
  RunOptions options;
  options.written = written;
  options.on_disk = source.numbers();
  run(views, source, sink, options);
  return sink;
}

TEST(WindowStage, AnyChunkOfTheSequenceGivesTheSamePixels) {
  MemorySource source({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, blade_frame);
  const MemorySink all = run_window(windowed_preset(), source, source.numbers());
  for (const std::vector<int>& chunk : {std::vector<int>{6}, {1, 2}, {5, 7, 11}, {12}}) {
    source.loads.clear();
    const MemorySink part = run_window(windowed_preset(), source, chunk);
    ASSERT_EQ(part.planes.size(), chunk.size());
    for (const int frame : chunk)
      EXPECT_TRUE(tests::same_pixels(part.planes.at(frame).at("AO"), all.planes.at(frame).at("AO"))) << frame;
    for (const auto& load : source.loads) {
      const bool within =
          std::any_of(chunk.begin(), chunk.end(), [&](int f) { return std::abs(f - load.number) <= kReach; });
      EXPECT_TRUE(within) << "frame " << load.number << " is of no use";
    }
  }
}

TEST(WindowStage, AGapAndAMissingFutureMakeTheWindowShorter) {
  MemorySource whole({1, 2, 3, 4, 5, 6, 7, 8, 9}, blade_frame), holed({1, 2, 3, 5, 6, 7, 8, 9}, blade_frame),
      late({5, 6, 7, 8, 9}, blade_frame);
  const MemorySink gap = run_window(windowed_preset(), holed, {5, 6}),
                   without = run_window(windowed_preset(), late, {5, 6});
  const MemorySink full = run_window(windowed_preset(), whole, {5, 6});
  for (const int frame : {5, 6}) {
    EXPECT_TRUE(tests::same_pixels(gap.planes.at(frame).at("AO"), without.planes.at(frame).at("AO")));
    EXPECT_FALSE(tests::same_pixels(gap.planes.at(frame).at("AO"), full.planes.at(frame).at("AO")));
  }
}

TEST(WindowStage, AWindowOfOneFrameChangesNothing) {
  MemorySource source({1, 2, 3}, blade_frame);
  preset::Preset without = windowed_preset();
  std::erase_if(without.stages, [](const auto& stage) { return stage.id == "temporal"; });
  const MemorySink one = run_window(windowed_preset("0"), source, {2}), none = run_window(without, source, {2});
  EXPECT_TRUE(tests::same_pixels(one.planes.at(2).at("AO"), none.planes.at(2).at("AO")));
}

TEST(WindowStage, DiagnosticsShowHowMuchOfTheWindowWasUsed) {
  MemorySource source({1, 2, 3, 4, 5, 6, 7}, blade_frame);
  Outputs outputs{"AO", false, {}};
  outputs.work.aovs = pipeline::AovSet::all();
  const MemorySink sink = run_window(windowed_preset(), source, {4}, outputs);
  const Plane& weight = sink.planes.at(4).at("aftershade.window_weight");
  double sum = 0;
  for (int y = 0; y < weight.height(); ++y)
    for (int x = 0; x < weight.width(); ++x) {
      ASSERT_TRUE(weight(x, y) > 0 && weight(x, y) <= 1.00001F);
      sum += weight(x, y);
    }
  EXPECT_GT(sum / (weight.width() * weight.height()), 0.4);
}

TEST(WindowStage, WithoutACameraPositionItNeedsVectors) {
  EXPECT_THROW(ViewPipeline(windowed_preset(), "", {{Role::depth}, true, false}, {"AO", false, {}}), Error);
  EXPECT_NO_THROW(
      ViewPipeline(windowed_preset(), "", {{Role::depth, Role::velocity_next}, true, false}, {"AO", false, {}}));
}

}  // namespace
}  // namespace aftershade::pipeline
