// Intermediate results: every preset gives what it says, in the range that the table says, and asking changes nothing.
#include "core/pipeline/aov.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/temporal/history_use.h"
#include "tests/pipeline/ao_quality.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"

namespace aftershade::tests {
namespace {

using pipeline::Aov;
using pipeline::AovSet;

constexpr int kFirst = 3, kLast = 6;

MemorySink run_with(const preset::Preset& preset, AovSet aovs) {
  SceneSource source(find_scene("crossing"), {61, 35, 1}, kFirst, kLast);
  pipeline::Outputs outputs;
  if (pipeline::aovs_of(preset).contains(Aov::ao_raw)) outputs.ao_channel = "AO";
  outputs.work.aovs = aovs;
  return run_over(preset, source, frames_from_to(kFirst, kLast), outputs);
}

/// A preset of one motion blur.
preset::Preset blur_of(const std::string& method) {
  return preset::from_json({{"stages", {{{"id", "motion_blur"}, {"method", method}}}}}, method);
}

/// All that is shipped, and the methods that no shipped preset has.
preset::Preset preset_named(const std::string& name) {
  const auto shipped = preset::shipped_presets();
  if (std::find(shipped.begin(), shipped.end(), name) != shipped.end()) return preset::load_preset(name).preset;
  return blur_of(name);
}

std::vector<std::string> every_preset() {
  std::vector<std::string> names = preset::shipped_presets();
  names.emplace_back("gather-plus");
  return names;
}

/// What values an AOV may have; vectors of length `most` at most.
struct Bounds {
  float least, most;
  bool whole = false;
};
Bounds bounds_of(Aov aov) {
  switch (aov) {
    case Aov::history_age:
      return {1, 10000};
    case Aov::rejected:
      return {0, temporal::kHistoryUses - 1, true};
    case Aov::mask:
      return {0, 1, true};
    case Aov::thickness:
      return {0, 1};  // metres: max_thickness_m of all shipped presets
    case Aov::tile_velocity:
    case Aov::neighbour_velocity:
      return {-61, 61};  // no longer than the image
    default:
      return {0, 1};
  }
}

void expect_within(const Plane& plane, const Bounds& bounds, const std::string& name) {
  constexpr float kRounding = 1e-5F;
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      const float value = plane(x, y);
      ASSERT_TRUE(value >= bounds.least - kRounding && value <= bounds.most + kRounding)  // false for NaN
          << name << " (" << x << ", " << y << "): " << value;
      if (bounds.whole) {
        ASSERT_EQ(value, std::round(value)) << name;
      }
    }
}

class Aovs : public testing::TestWithParam<std::string> {};

TEST_P(Aovs, AreAllThereWithinTheirRangeAndChangeNothingElse) {
  const preset::Preset preset = preset_named(GetParam());
  const AovSet offered = pipeline::aovs_of(preset);
  const MemorySink plain = run_with(preset, {}), with = run_with(preset, offered);
  ASSERT_EQ(with.planes.size(), static_cast<size_t>(kLast - kFirst + 1));
  for (const auto& [number, planes] : with.planes) {
    size_t given = 0;
    for (const pipeline::AovInfo& entry : pipeline::kAovs)
      for (const std::string& name : pipeline::channels_of(entry.aov)) {
        ASSERT_EQ(planes.contains(name), offered.contains(entry.aov)) << name;
        if (!planes.contains(name)) continue;
        ++given;
        EXPECT_EQ(planes.at(name).width(), 61) << name;
        EXPECT_EQ(planes.at(name).height(), 35) << name;
        expect_within(planes.at(name), bounds_of(entry.aov), cat(name, " of frame ", number));
      }
    EXPECT_EQ(planes.size(), plain.planes.at(number).size() + given) << "nothing but AOVs is added";
    for (const auto& [name, plane] : plain.planes.at(number))
      EXPECT_TRUE(same_pixels(plane, planes.at(name))) << name << " of frame " << number;
  }
}

TEST_P(Aovs, OneAskedForAloneIsTheSameAsAmongAll) {
  const preset::Preset preset = preset_named(GetParam());
  const AovSet offered = pipeline::aovs_of(preset);
  const MemorySink all = run_with(preset, offered);
  for (const pipeline::AovInfo& entry : pipeline::kAovs) {
    if (!offered.contains(entry.aov)) continue;
    const MemorySink alone = run_with(preset, {entry.aov});
    for (const pipeline::AovInfo& other : pipeline::kAovs)
      for (const std::string& name : pipeline::channels_of(other.aov))
        EXPECT_EQ(alone.planes.at(kLast).contains(name), other.aov == entry.aov) << name;
    for (const std::string& name : pipeline::channels_of(entry.aov))
      EXPECT_TRUE(same_pixels(alone.planes.at(kLast).at(name), all.planes.at(kLast).at(name))) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, Aovs, testing::ValuesIn(every_preset()), [](const auto& preset) {
  std::string name = preset.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(AovTable, IsInTheOrderOfTheEnumAndEveryOneHasAStageThatGivesIt) {
  AovSet given;
  for (const std::string& name : every_preset()) given.insert(pipeline::aovs_of(preset_named(name)));
  for (size_t i = 0; i < pipeline::kAovs.size(); ++i) {
    EXPECT_EQ(static_cast<size_t>(pipeline::kAovs[i].aov), i);
    EXPECT_EQ(pipeline::aov_from_name(pipeline::kAovs[i].name), pipeline::kAovs[i].aov);
    EXPECT_FALSE(pipeline::kAovs[i].doc.empty());
    EXPECT_TRUE(given.contains(pipeline::kAovs[i].aov)) << pipeline::kAovs[i].name;
  }
}

TEST(AovNames, AreListsWithCommasAndAll) {
  const AovSet offered{Aov::ao_raw, Aov::mask, Aov::rejected};
  EXPECT_EQ(names_of(pipeline::aovs_from_names({}, offered)), std::vector<std::string>());
  EXPECT_EQ(names_of(pipeline::aovs_from_names({"mask", "rejected,ao_raw"}, offered)),
            (std::vector<std::string>{"ao_raw", "mask", "rejected"}));
  EXPECT_EQ(names_of(pipeline::aovs_from_names({"all"}, offered)), names_of(offered));
}

std::string message_of(const std::vector<std::string>& names, AovSet offered) {
  try {
    pipeline::aovs_from_names(names, offered);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "no error";
}

TEST(AovNames, WhatIsUnknownOrNotOfferedIsSaidWithWhatThereIs) {
  const AovSet offered{Aov::ao_raw, Aov::mask};
  const std::string misspelt = message_of({"masks"}, offered), missing = message_of({"guessed"}, offered);
  EXPECT_NE(misspelt.find("there is no AOV \"masks\""), std::string::npos) << misspelt;
  EXPECT_NE(misspelt.find("did you mean \"mask\"?"), std::string::npos) << misspelt;
  EXPECT_NE(missing.find("no stage of the preset has the AOV guessed"), std::string::npos) << missing;
  EXPECT_NE(missing.find("ao_raw, mask"), std::string::npos) << missing;
  EXPECT_NE(message_of({"mask,"}, offered).find("no AOV \"\""), std::string::npos);
}

TEST(AovNames, WithoutLayersStagesOfTheMotionBlurHaveNone) {
  const preset::Preset preset = preset::load_preset("high-dx11").preset;
  EXPECT_TRUE(pipeline::aovs_of(preset, true).contains(Aov::tile_velocity));
  EXPECT_FALSE(pipeline::aovs_of(preset, false).contains(Aov::tile_velocity));
  EXPECT_TRUE(pipeline::aovs_of(preset, false).contains(Aov::ao_raw));
}

/// What the codes say must agree with the other results of the same frame.
TEST(Rejections, AgreeWithTheHistorysAgeWeightAndConfidence) {
  const auto used = code_of(temporal::HistoryUse::used);
  const auto count_where = [](const Plane& plane, auto&& holds) {
    int count = 0;
    for (int y = 0; y < plane.height(); ++y)
      for (int x = 0; x < plane.width(); ++x) count += holds(x, y) ? 1 : 0;
    return count;
  };
  for (const char* name : {"high-dx11", "battlefield3-high", "soma", "accumulative-ssao", "temporal-refinement"}) {
    const MemorySink sink = run_with(preset::load_preset(name).preset, AovSet::all());
    const auto& planes = sink.planes.at(kLast);
    const Plane& codes = planes.at("aftershade.rejected");
    const auto aged = [&](int x, int y) {
      if (planes.contains("aftershade.history_weight")) return planes.at("aftershade.history_weight")(x, y) > 0;
      return planes.at("aftershade.history_age")(x, y) > 1;
    };
    EXPECT_GT(count_where(codes, [&](int x, int y) { return codes(x, y) == used; }), 50) << name;
    const bool by_samples = std::string(name) == "temporal-refinement",
               by_miss = std::string(name) == "accumulative-ssao";
    if (by_samples || by_miss) continue;  // there a pixel without history counts for more than one
    EXPECT_EQ(count_where(codes, [&](int x, int y) { return (codes(x, y) == used) != aged(x, y); }), 0) << name;
  }
  const MemorySink first = run_with(preset::load_preset("high-dx11").preset, {Aov::rejected});
  const Plane& codes = first.planes.at(kFirst).at("aftershade.rejected");
  EXPECT_EQ(count_where(codes, [&](int x, int y) { return codes(x, y) == used; }), 0) << "frame 1 has no history";
}

}  // namespace
}  // namespace aftershade::tests
