#include "core/preset/preset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "core/base/error.h"

namespace aftershade::preset {
namespace {

const StageDescription* stage(const Preset& preset, std::string_view id) {
  for (const StageDescription& s : preset.stages)
    if (s.id == id) return &s;
  return nullptr;
}

template <class Params>
const Params& get(const Preset& preset, std::string_view id) {
  const StageDescription* s = stage(preset, id);
  if (!s) throw std::runtime_error(preset.name + " has no " + std::string(id));
  return std::get<Params>(s->params);
}

std::vector<std::string> ids(const Preset& preset) {
  std::vector<std::string> out;
  for (const StageDescription& s : preset.stages) out.push_back(s.id);
  return out;
}

using Ids = std::vector<std::string>;

const Ids kSets{"high-current-gen", "high-dx11", "low-current-gen", "low-dx11", "ultra-current-gen", "ultra-dx11"};

TEST(ShippedPresets, HaveTheSixSets) {
  const Ids shipped = shipped_presets();
  for (const std::string& name : kSets)
    EXPECT_NE(std::find(shipped.begin(), shipped.end(), name), shipped.end()) << name;
}

class ShippedPreset : public testing::TestWithParam<std::string> {};
class Set : public ShippedPreset {};
std::string test_name(const testing::TestParamInfo<std::string>& param) {
  std::string name = param.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(All, ShippedPreset, testing::ValuesIn(shipped_presets()), test_name);
INSTANTIATE_TEST_SUITE_P(All, Set, testing::ValuesIn(kSets), test_name);

TEST_P(ShippedPreset, LoadsAndRoundTrips) {
  const Preset preset = load_preset(GetParam()).preset;
  EXPECT_EQ(preset.name, GetParam());
  EXPECT_EQ(from_json(to_json(preset), preset.name), preset);
  const params::Json reparsed = params::Json::parse(to_json(preset).dump());
  EXPECT_EQ(from_json(reparsed, preset.name), preset);
}

TEST_P(ShippedPreset, SaysWhatIsOursAndWhoseTheRestIs) {
  const std::string description = load_preset(GetParam()).preset.description;
  EXPECT_LE(description.find(". "), 120U) << "its first sentence is its line in presets list: " << description;
  EXPECT_TRUE(std::regex_search(description, std::regex("\\b([Oo]urs|[Aa]ssumed|no public source)\\b"))) << description;
  EXPECT_TRUE(std::regex_search(description, std::regex("\\b20[01][0-9]\\b")))
      << "no year of a source: " << description;
}

TEST_P(Set, HasStagesInTheirOrder) {
  const Preset preset = load_preset(GetParam()).preset;
  const bool half = get<ao::ScalableAoParams>(preset, "ao").resolution == ao::Resolution::half;
  Ids expected{"ao", "blur", "upsample", "temporal", "apply", "motion_blur"};
  if (!half) std::erase(expected, "upsample");
  if (GetParam().starts_with("low")) std::erase(expected, "temporal");
  EXPECT_EQ(ids(preset), expected);
}

TEST_P(ShippedPreset, KnowsTheOriginOfEveryValue) {
  const Resolved resolved = load_preset(GetParam());
  size_t values = 0;
  for (const StageDescription& s : resolved.preset.stages)
    for (const params::Record& record : table_of(s.params)) {
      ++values;
      EXPECT_TRUE(resolved.origins.contains(s.id + "." + record.key)) << s.id << "." << record.key;
    }
  EXPECT_EQ(resolved.origins.size(), values);
}

TEST(ShippedPresets, HighCurrentGenIsTheSeedsSet) {
  const Preset preset = load_preset("high-current-gen").preset;
  const auto& ao = get<ao::ScalableAoParams>(preset, "ao");
  EXPECT_EQ(ao.resolution, ao::Resolution::full);
  EXPECT_EQ(ao.pattern, ao::TapPattern::mirrored);
  EXPECT_EQ(ao.taps, 4);
  EXPECT_EQ(ao.max_radius_px, 20);
  EXPECT_EQ(ao.reference_height_px, 720);
  EXPECT_FALSE(ao.depth_mips);
  const auto& blur = get<motionblur::ScalableBlurParams>(preset, "motion_blur");
  EXPECT_EQ(blur.taps, 7);
  EXPECT_EQ(blur.max_radius_px, 10);
  EXPECT_EQ(blur.reference_height_px, 720);
  EXPECT_EQ(blur.jitter, motionblur::Jitter::checkerboard);
  EXPECT_EQ(blur.directions, motionblur::Directions::alternate);
}

TEST(ShippedPresets, HighDx11IsTheSeedsSet) {
  const Preset preset = load_preset("high-dx11").preset;
  const auto& ao = get<ao::ScalableAoParams>(preset, "ao");
  EXPECT_EQ(ao.resolution, ao::Resolution::half);
  EXPECT_EQ(ao.pattern, ao::TapPattern::spiral);
  EXPECT_EQ(ao.taps, 9);
  EXPECT_EQ(ao.max_radius_px, 0);
  EXPECT_TRUE(ao.depth_mips);
  const auto& temporal = get<temporal::SelectiveTemporalParams>(preset, "temporal");
  EXPECT_EQ(temporal.epsilon, 0.1F);
  EXPECT_EQ(temporal.distance_m, 0.1F);
  EXPECT_EQ(temporal.dilation_texels, 4);
  EXPECT_EQ(temporal.max_frames, 8);
  const auto& blur = get<motionblur::ScalableBlurParams>(preset, "motion_blur");
  EXPECT_EQ(blur.taps, 9);
  EXPECT_EQ(blur.max_radius_px, 18);
  EXPECT_EQ(blur.reference_height_px, 1080);
  EXPECT_EQ(blur.jitter, motionblur::Jitter::random4x4);
  EXPECT_EQ(blur.directions, motionblur::Directions::alternate);
  EXPECT_EQ(blur.shutter_frames, 0.5F);
}

TEST(ShippedPresets, VicariousVisionsAreTheTalksTwoSetsAndNothingBeside) {
  const Preset dx11 = load_preset("vicarious-visions-dx11").preset;
  const Preset current_gen = load_preset("vicarious-visions-current-gen").preset;
  for (const Preset* preset : {&dx11, &current_gen}) {
    EXPECT_EQ(ids(*preset), (Ids{"ao", "blur", "apply", "motion_blur"}));
    const auto& ao = get<ao::ScalableAoParams>(*preset, "ao");
    EXPECT_EQ(ao.resolution, ao::Resolution::full);
    EXPECT_EQ(ao.falloff, ao::DistanceFalloff::linear);
    EXPECT_TRUE(ao.squared);
    EXPECT_EQ(ao.bias_m, 0);
    EXPECT_GT(ao.bias, 0);
    EXPECT_FALSE(ao.per_frame_noise);
    EXPECT_GE(get<filter::BilateralBlurParams>(*preset, "blur").radius_px, 8) << "wider than the 4x4 pattern";
  }
  // Taps, clamp, mips and motion blur: those of the sets that the other presets are made of.
  for (const auto& [talk, set] :
       {std::pair{&dx11, load_preset("high-dx11").preset}, {&current_gen, load_preset("high-current-gen").preset}}) {
    auto ao = get<ao::ScalableAoParams>(*talk, "ao");
    ao.resolution = get<ao::ScalableAoParams>(set, "ao").resolution;
    EXPECT_EQ(ao, get<ao::ScalableAoParams>(set, "ao"));
    EXPECT_EQ(get<motionblur::ScalableBlurParams>(*talk, "motion_blur"),
              get<motionblur::ScalableBlurParams>(set, "motion_blur"));
  }
}

TEST(ShippedPresets, LowIsCheaperAndUltraFiner) {
  for (const std::string set : {"current-gen", "dx11"}) {
    const Preset low = load_preset("low-" + set).preset, high = load_preset("high-" + set).preset;
    const Preset ultra = load_preset("ultra-" + set).preset;
    EXPECT_EQ(get<ao::ScalableAoParams>(low, "ao").resolution, ao::Resolution::half);
    EXPECT_EQ(get<ao::ScalableAoParams>(ultra, "ao").resolution, ao::Resolution::full);
    EXPECT_EQ(get<ao::ScalableAoParams>(ultra, "ao").taps, 4 * get<ao::ScalableAoParams>(high, "ao").taps);
    EXPECT_LT(get<motionblur::ScalableBlurParams>(low, "motion_blur").taps,
              get<motionblur::ScalableBlurParams>(high, "motion_blur").taps);
    EXPECT_LT(get<filter::BilateralBlurParams>(low, "blur").radius_px,
              get<filter::BilateralBlurParams>(high, "blur").radius_px);
    const auto width_px = [](const Preset& preset) {
      const float texel = get<ao::ScalableAoParams>(preset, "ao").resolution == ao::Resolution::half ? 2 : 1;
      return get<filter::BilateralBlurParams>(preset, "blur").radius_px * texel;
    };
    EXPECT_GT(width_px(ultra), width_px(high));
  }
}

TEST(Difference, NamesWhatDiffers) {
  const Preset a = load_preset("high-dx11").preset;
  EXPECT_TRUE(difference(a, a).empty());
  const Preset b = load_preset("high-dx11", {"ao.radius_m=1.5", "ao.pattern=mirrored", "upsample.remove=true"}).preset;
  EXPECT_EQ(difference(a, b),
            (Ids{"ao.pattern: spiral -> mirrored", "ao.radius_m: 1 -> 1.5", "upsample: only in high-dx11"}));
  EXPECT_EQ(difference(b, a).back(), "upsample: only in high-dx11");
  const Preset moved = load_preset("high-dx11", {"blur.after=upsample"}).preset;
  EXPECT_EQ(difference(a, moved), (Ids{"order: ao, blur, upsample, temporal, apply, motion_blur -> "
                                       "ao, upsample, blur, temporal, apply, motion_blur"}));
  const Preset other = load_preset("high-dx11", {"blur.method=bilateral-upsample"}).preset;
  EXPECT_EQ(difference(a, other), (Ids{"blur.method: bilateral-blur -> bilateral-upsample"}));
}

TEST(Methods, AreNamedAndFoundOnce) {
  Ids names;
  for (const MethodInfo& info : methods()) {
    names.emplace_back(info.method);
    EXPECT_FALSE(info.summary.empty());
    EXPECT_NE(info.summary.back(), '.');
  }
  Ids unique = names;
  std::sort(unique.begin(), unique.end());
  EXPECT_EQ(std::unique(unique.begin(), unique.end()), unique.end());
  EXPECT_EQ(names.size(), std::variant_size_v<StageParams>);
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// AFTERSHADE_UPDATE_DOCUMENTS=1 rewrites the committed file first.
TEST(Schema, IsWhatIsCommitted) {
  const std::filesystem::path path = std::filesystem::path(AFTERSHADE_SOURCE_DIR) / "configs/preset.schema.json";
  const std::string expected = schema().dump(2) + "\n";
  if (std::getenv("AFTERSHADE_UPDATE_DOCUMENTS")) std::ofstream(path, std::ios::binary) << expected;
  EXPECT_EQ(read_text(path), expected)
      << "the tables have changed; write the file anew with  aftershade presets schema > configs/preset.schema.json  "
         "or\n"
         "  AFTERSHADE_UPDATE_DOCUMENTS=1 build/bin/test_preset --gtest_filter=Schema.*";
}

TEST(Schema, HasEveryMethodAndKey) {
  const params::Json json = schema();
  EXPECT_EQ(json["definitions"].size(), methods().size() + 1);
  EXPECT_EQ(json["properties"]["stages"]["items"]["anyOf"].size(), methods().size() + 1);
  for (const MethodInfo& info : methods()) {
    const params::Json& definition = json["definitions"][std::string(info.method)];
    EXPECT_EQ(definition["properties"]["method"]["const"], info.method);
    EXPECT_EQ(definition["required"], params::Json::array({"id"}));
    for (const params::Record& record : *info.table)
      EXPECT_TRUE(definition["properties"].contains(record.key)) << record.key;
  }
}

}  // namespace
}  // namespace aftershade::preset
