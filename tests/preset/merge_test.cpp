#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/preset/preset.h"

namespace aftershade::preset {
namespace {

/// A folder of its own for each test.
class PresetFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("aftershade_preset_") + info->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  /// The message of the error that loading `text` as my.json gives, from "my.json" on.
  std::string error_of(const std::string& text, const std::vector<std::string>& sets = {},
                       ErrorCode code = ErrorCode::config) {
    return message_of(write("my.json", text), sets, code);
  }
  std::string message_of(const std::string& name, const std::vector<std::string>& sets = {},
                         ErrorCode code = ErrorCode::config) {
    try {
      load_preset(name, sets);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      std::string text = error.what();
      for (size_t at; (at = text.find(folder_.string() + "/")) != std::string::npos;)
        text.erase(at, folder_.string().size() + 1);
      return text;
    }
    return "no error";
  }
  Resolved load(const std::string& text, const std::vector<std::string>& sets = {}) {
    return load_preset(write("my.json", text), sets);
  }

  std::filesystem::path folder_;
};

std::string order(const Preset& preset) {
  std::string out;
  for (const StageDescription& stage : preset.stages) out += (out.empty() ? "" : " ") + stage.id;
  return out;
}

TEST_F(PresetFiles, NameIsTheFilesStem) {
  EXPECT_EQ(load(R"({"stages": []})").preset.name, "my");
  EXPECT_EQ(from_json(params::Json::parse(R"({"stages": []})"), "some/where/else.json").name, "else");
}

TEST_F(PresetFiles, SchemaKeyIsIgnored) {
  EXPECT_EQ(load(R"({"$schema": "./preset.schema.json", "stages": []})").preset, (Preset{"my", "", {}}));
}

TEST_F(PresetFiles, SameIdOverridesTheGivenKeysOnly) {
  const Resolved mine =
      load(R"({"description": "d", "extends": "high-dx11", "stages": [{"id": "ao", "radius_m": 2}]})");
  Preset expected = load_preset("high-dx11").preset;
  std::get<ao::ScalableAoParams>(expected.stages[0].params).radius_m = 2;
  expected.name = "my", expected.description = "d";
  EXPECT_EQ(mine.preset, expected);
  EXPECT_TRUE(mine.origins.at("ao.radius_m").ends_with("my.json"));
  EXPECT_EQ(mine.origins.at("ao.taps"), "high-dx11");
  EXPECT_EQ(mine.origins.at("motion_blur.shutter_from_header"), "default");
}

TEST_F(PresetFiles, SameMethodAgainIsAnOverride) {
  const Preset preset =
      load(R"({"extends": "high-dx11", "stages": [{"id": "ao", "method": "scalable-ao", "taps": 5}]})").preset;
  EXPECT_EQ(std::get<ao::ScalableAoParams>(preset.stages[0].params).taps, 5);
  EXPECT_TRUE(std::get<ao::ScalableAoParams>(preset.stages[0].params).depth_mips);
}

TEST_F(PresetFiles, OtherMethodReplacesTheStageInItsPlace) {
  const Resolved mine =
      load(R"({"extends": "high-dx11", "stages": [{"id": "blur", "method": "apply-ao", "strength": 0.5}]})");
  EXPECT_EQ(order(mine.preset), "ao blur upsample temporal apply motion_blur");
  ao::ApplyAoParams expected;
  expected.strength = 0.5F;
  EXPECT_EQ(mine.preset.stages[1].params, StageParams(expected));
  EXPECT_EQ(mine.origins.at("blur.minimum"), "default");
  EXPECT_FALSE(mine.origins.contains("blur.radius_px"));
}

TEST_F(PresetFiles, NewStageIsAppendedOrPlaced) {
  const auto with = [&](const std::string& where) {
    return order(
        load(R"({"extends": "high-dx11", "stages": [{"id": "x", "method": "bilateral-blur")" + where + "}]}").preset);
  };
  EXPECT_EQ(with(""), "ao blur upsample temporal apply motion_blur x");
  EXPECT_EQ(with(R"(, "before": "apply")"), "ao blur upsample temporal x apply motion_blur");
  EXPECT_EQ(with(R"(, "after": "ao")"), "ao x blur upsample temporal apply motion_blur");
  EXPECT_EQ(with(R"(, "before": "ao")"), "x ao blur upsample temporal apply motion_blur");
  EXPECT_EQ(with(R"(, "after": "motion_blur")"), "ao blur upsample temporal apply motion_blur x");
}

TEST_F(PresetFiles, InheritedStageCanMove) {
  EXPECT_EQ(order(load(R"({"extends": "high-dx11", "stages": [{"id": "blur", "after": "temporal"}]})").preset),
            "ao upsample temporal blur apply motion_blur");
}

TEST_F(PresetFiles, RemoveDropsTheStageAndItsOrigins) {
  const Resolved mine = load(R"({"extends": "low-dx11", "stages": [{"id": "upsample", "remove": true}]})");
  EXPECT_EQ(order(mine.preset), "ao blur apply motion_blur");
  for (const auto& [key, origin] : mine.origins) EXPECT_FALSE(key.starts_with("upsample.")) << key;
}

TEST_F(PresetFiles, ExtendsAFileRelativeToTheFile) {
  std::filesystem::create_directories(folder_ / "sub");
  write("base.json", R"({"extends": "low-dx11", "stages": [{"id": "ao", "taps": 3}]})");
  const std::string child =
      write("sub/child.json", R"({"extends": "../base.json", "stages": [{"id": "ao", "bias": 0.25}]})");
  const Resolved mine = load_preset(child);
  EXPECT_EQ(std::get<ao::ScalableAoParams>(mine.preset.stages[0].params).taps, 3);
  EXPECT_EQ(mine.origins.at("ao.taps"), (folder_ / "base.json").string());
  EXPECT_EQ(mine.origins.at("ao.bias"), child);
  EXPECT_EQ(mine.preset.description, "");
}

TEST_F(PresetFiles, SetOverridesTheFile) {
  const Resolved mine =
      load(R"({"extends": "high-dx11"})",
           {"ao.radius_m=1.5", "ao.radius_m=0.5", "ao.depth_mips=false", "ao.pattern=mirrored", "ao.taps=6"});
  const auto& ao = std::get<ao::ScalableAoParams>(mine.preset.stages[0].params);
  EXPECT_EQ(ao.radius_m, 0.5F);
  EXPECT_FALSE(ao.depth_mips);
  EXPECT_EQ(ao.pattern, ao::TapPattern::mirrored);
  EXPECT_EQ(ao.taps, 6);
  EXPECT_EQ(mine.origins.at("ao.radius_m"), "--set");
}

TEST_F(PresetFiles, SetCanRemoveAndMoveStages) {
  EXPECT_EQ(order(load_preset("high-dx11", {"temporal.remove=true", "motion_blur.before=apply"}).preset),
            "ao blur upsample motion_blur apply");
}

using PresetErrors = PresetFiles;

TEST_F(PresetErrors, UnknownKeys) {
  EXPECT_EQ(error_of(R"({"extends": "high-dx11", "stages": [{"id": "ao", "radus_m": 1}]})"),
            "my.json: stage ao: unknown key \"radus_m\" (did you mean \"radius_m\"?)");
  EXPECT_EQ(error_of(R"({"extends": "high-dx11", "stages": [{"id": "ao", "methd": "x"}]})"),
            "my.json: stage ao: unknown key \"methd\" (did you mean \"method\"?)");
  EXPECT_EQ(error_of(R"({"extend": "high-dx11", "stages": []})"),
            "my.json: unknown key \"extend\" (did you mean \"extends\"?)");
  EXPECT_EQ(error_of(R"({"stages": [], "qqqqqq": ""})"),
            "my.json: unknown key \"qqqqqq\" (known keys: $schema, description, extends, stages)");
}

TEST_F(PresetErrors, SyntaxNamesLineAndColumn) {
  EXPECT_EQ(error_of("{\n  \"stages\": [}\n").rfind("my.json: line 2, column 14: syntax error", 0), 0U)
      << error_of("{\n  \"stages\": [}\n");
  EXPECT_EQ(error_of("?").rfind("my.json: line 1, column 1: ", 0), 0U) << error_of("?");
  EXPECT_EQ(error_of("").rfind("my.json: line 1, column 1: ", 0), 0U) << error_of("");
  EXPECT_EQ(error_of("{\"stages\": [],\n\"stages\": []}"), "my.json: the key \"stages\" is given twice in one object");
  EXPECT_EQ(error_of(R"({"a": 1e999})").rfind("my.json: ", 0), 0U);
}

TEST_F(PresetErrors, WrongShapes) {
  EXPECT_EQ(error_of("[]"), "my.json: is not a JSON object (a preset is {\"stages\": [...]})");
  EXPECT_EQ(error_of("{}"), "my.json: has neither \"stages\" nor \"extends\"");
  EXPECT_EQ(error_of(R"({"stages": {}})"), "my.json: \"stages\" is not a list in [ ]");
  EXPECT_EQ(error_of(R"({"stages": [], "description": 3})"), "my.json: \"description\" is not a text in quotes: 3");
  EXPECT_EQ(error_of(R"({"extends": 3, "stages": []})"), "my.json: \"extends\" is not a text in quotes: 3");
  EXPECT_EQ(error_of(R"({"stages": [3]})"), "my.json: stages[0]: is not an object: 3 (write {\"id\": \"ao\", ...})");
  EXPECT_EQ(error_of(R"({"stages": [{}]})"),
            "my.json: stages[0]: has no \"id\" (every stage needs one, unique in its file)");
  EXPECT_EQ(error_of(R"({"stages": [{"id": "a.b"}]})"),
            "my.json: stages[0]: \"a.b\" is not an id (use letters, digits, _ and -)");
  EXPECT_EQ(error_of(R"({"stages": [{"id": 1}]})"), "my.json: stages[0]: \"id\" is not a text in quotes: 1");
  EXPECT_EQ(error_of(R"({"stages": [{"id": "a", "method": 1}]})"),
            "my.json: stage a: \"method\" is not a text in quotes: 1");
  EXPECT_EQ(error_of(R"({"stages": [{"id": "a"}]})"), "my.json: stage a: has no \"method\" (a new stage needs one)");
}

TEST_F(PresetErrors, WrongValues) {
  const auto ao = [&](const std::string& value) {
    return error_of(R"({"extends": "high-dx11", "stages": [{"id": "ao", )" + value + "}]}");
  };
  EXPECT_EQ(ao("\"radius_m\": -1").rfind("my.json: stage ao: radius_m: -1 is out of range ", 0), 0U)
      << ao("\"radius_m\": -1");
  EXPECT_EQ(ao("\"radius_m\": \"1\"").rfind("my.json: stage ao: radius_m: \"1\" is not a number", 0), 0U);
  EXPECT_EQ(ao("\"taps\": 1.5").rfind("my.json: stage ao: taps: 1.5 is not a whole number", 0), 0U);
  EXPECT_EQ(ao("\"pattern\": \"spirals\""),
            "my.json: stage ao: pattern: \"spirals\" is not one of mirrored, spiral (did you mean \"spiral\"?)");
}

TEST_F(PresetErrors, UnknownMethodPresetAndStage) {
  EXPECT_EQ(error_of(R"({"stages": [{"id": "ao", "method": "scalable-oa"}]})"),
            "my.json: stage ao: unknown method \"scalable-oa\" (did you mean \"scalable-ao\"?)");
  EXPECT_EQ(message_of("hihg-dx11"), "unknown preset \"hihg-dx11\" (did you mean \"high-dx11\"?)");
  EXPECT_EQ(message_of("zzz"), cat("unknown preset \"zzz\" (shipped are ", join(shipped_presets(), ", "),
                                   "; the name of a file ends in .json)"));
  EXPECT_EQ(error_of(R"({"extends": "hihg-dx11"})"),
            "my.json: extends: unknown preset \"hihg-dx11\" (did you mean \"high-dx11\"?)");
  EXPECT_EQ(error_of(R"({"extends": "low-dx11", "stages": [{"id": "temporal", "remove": true}]})"),
            "my.json: stage temporal: no stage \"temporal\" (the stages are ao, blur, upsample, apply, motion_blur)");
  EXPECT_EQ(error_of(R"({"extends": "low-dx11", "stages": [{"id": "x", "method": "apply-ao", "before": "aply"}]})"),
            "my.json: stage x: no stage \"aply\" (did you mean \"apply\"? the stages are ao, blur, upsample, apply, "
            "motion_blur, x)");
}

TEST_F(PresetErrors, ContradictoryStages) {
  EXPECT_EQ(error_of(R"({"extends": "high-dx11", "stages": [{"id": "ao"}, {"id": "ao"}]})"),
            "my.json: stage ao: the id is used twice (ids are unique in a file)");
  EXPECT_EQ(error_of(R"({"extends": "high-dx11", "stages": [{"id": "ao", "remove": false}]})"),
            "my.json: stage ao: \"remove\" is not true: false (leave it out to keep the stage)");
  EXPECT_EQ(error_of(R"({"extends": "high-dx11", "stages": [{"id": "ao", "remove": true, "taps": 3}]})"),
            "my.json: stage ao: is removed and yet has other keys (give \"id\" and \"remove\" only)");
  EXPECT_EQ(error_of(R"({"extends": "high-dx11", "stages": [{"id": "ao", "before": "blur", "after": "blur"}]})"),
            "my.json: stage ao: has both \"before\" and \"after\" (give one of them)");
  EXPECT_EQ(error_of(R"({"extends": "high-dx11", "stages": [{"id": "ao", "before": "ao"}]})"),
            "my.json: stage ao: is placed beside itself");
}

TEST_F(PresetErrors, Files) {
  EXPECT_EQ(message_of((folder_ / "none.json").string(), {}, ErrorCode::no_input),
            "none.json: the preset file cannot be read: No such file or directory (give a shipped preset's name or a "
            "readable .json file)");
  std::filesystem::create_directories(folder_ / "dir.json");
  EXPECT_NE(message_of((folder_ / "dir.json").string(), {}, ErrorCode::no_input).find("Is a directory"),
            std::string::npos);
  EXPECT_EQ(error_of(R"({"extends": "none.json"})", {}, ErrorCode::no_input).rfind("my.json: extends: none.json: ", 0),
            0U);
}

TEST_F(PresetErrors, ExtendsInACircle) {
  write("a.json", R"({"extends": "b.json"})");
  write("b.json", R"({"extends": "./a.json"})");
  EXPECT_EQ(message_of((folder_ / "a.json").string()),
            "b.json: extends \"./a.json\" in a circle: a.json -> b.json -> a.json");
  EXPECT_EQ(error_of(R"({"extends": "my.json"})"), "my.json: extends \"my.json\" in a circle: my.json -> my.json");
}

TEST_F(PresetErrors, Set) {
  const auto set = [&](const std::string& text) { return message_of("high-dx11", {text}); };
  EXPECT_EQ(set("ao"), "--set ao: is not of the form stage.key=value (for example --set ao.radius_m=1.5)");
  EXPECT_EQ(set("ao=1.5"), "--set ao=1.5: is not of the form stage.key=value (for example --set ao.radius_m=1.5)");
  EXPECT_EQ(set("occlusion.radius_m=1"),
            "--set occlusion.radius_m=1: no stage \"occlusion\" (the stages are ao, blur, upsample, temporal, apply, "
            "motion_blur)");
  EXPECT_EQ(set("ao.radus_m=1"), "--set ao.radus_m=1: stage ao: unknown key \"radus_m\" (did you mean \"radius_m\"?)");
  EXPECT_EQ(set("ao.radius_m=big").rfind("--set ao.radius_m=big: stage ao: radius_m: \"big\" is not a number", 0), 0U);
  EXPECT_EQ(set("ao.radius_m=nan").rfind("--set ao.radius_m=nan: stage ao: radius_m: \"nan\" is not a number", 0), 0U);
  EXPECT_EQ(set("ao.radius_m=-1").rfind("--set ao.radius_m=-1: stage ao: radius_m: -1 is out of range ", 0), 0U);
  EXPECT_EQ(set("ao.taps=2.5").rfind("--set ao.taps=2.5: stage ao: taps: 2.5 is not a whole number", 0), 0U);
  EXPECT_EQ(
      set("ao.depth_mips=yes").rfind("--set ao.depth_mips=yes: stage ao: depth_mips: \"yes\" is not true or false", 0),
      0U);
}

}  // namespace
}  // namespace aftershade::preset
