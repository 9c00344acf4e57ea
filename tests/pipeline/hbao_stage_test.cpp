#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/pipeline/pipeline.h"
#include "tests/pipeline/memory_sequence.h"

namespace aftershade::pipeline {
namespace {

const Offer kOffer{{Role::depth, Role::velocity_prev}, true, true};

preset::Preset hbao_and_apply(ao::Resolution resolution) {
  ao::HbaoParams hbao;
  hbao.resolution = resolution;
  return {"test", "", {{"ao", hbao}, {"apply", ao::ApplyAoParams{}}}};
}

/// What is written of frame 1 of the blades.
std::map<std::string, Plane> written(const preset::Preset& preset) {
  std::vector<ViewPipeline> views;
  views.emplace_back(preset, "", kOffer, Outputs{"AO", true, {pipeline::AovSet::all(), false}});
  tests::MemorySource source({1}, tests::blade_frame);
  tests::MemorySink sink;
  RunOptions options;
  options.written = options.on_disk = {1};
  run(views, source, sink, options);
  return std::move(sink.planes.at(1));
}

TEST(HbaoStage, FullAndDualResolutionNeedNoUpsamplingHalfDoes) {
  const auto full = written(hbao_and_apply(ao::Resolution::full)), dual = written(hbao_and_apply(ao::Resolution::dual));
  for (const auto* planes : {&full, &dual}) {
    ASSERT_EQ(planes->at("AO").width(), 48);
    ASSERT_EQ(planes->at("AO").height(), 36);
    EXPECT_TRUE(tests::same_pixels(planes->at("AO"), planes->at("aftershade.ao_raw")));
  }
  EXPECT_FALSE(tests::same_pixels(full.at("AO"), dual.at("AO")));
  EXPECT_THROW(ViewPipeline(hbao_and_apply(ao::Resolution::half), "", kOffer, {}), Error);
}

TEST(HbaoStage, BlursAndFiltersAfterDualResolutionWorkAtPixels) {
  preset::Preset preset = hbao_and_apply(ao::Resolution::dual);
  preset.stages.insert(preset.stages.begin() + 1, {{"blur", filter::BilateralBlurParams{}},
                                                   {"upsample", filter::BilateralUpsampleParams{}},
                                                   {"temporal", temporal::SelectiveTemporalParams{}}});
  const auto planes = written(preset);
  EXPECT_EQ(planes.at("AO").width(), 48);
  EXPECT_FALSE(tests::same_pixels(planes.at("AO"), planes.at("aftershade.ao_raw")));
}

}  // namespace
}  // namespace aftershade::pipeline
