#include "core/io/profile.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"

namespace aftershade::io {
namespace {

const Candidate& only(const Profile& profile, Role role) { return profile.roles[static_cast<size_t>(role)].at(0); }

TEST(Profiles, ShippedOnesLoad) {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : builtin_profiles()) {
    const Profile profile = parse_profile(file.text, file.name);
    EXPECT_EQ(profile.name, file.name);
    EXPECT_FALSE(profile.description.empty()) << file.name;
    EXPECT_FALSE(profile.color.empty()) << file.name;
    EXPECT_EQ(profile.detect.empty(), file.name == "generic") << "only the fallback has no sign";
    names.emplace_back(file.name);
  }
  for (const char* name : {"blender", "nuke", "generic"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
}

TEST(Profiles, BlenderConventions) {
  const Profile blender = load_profile("blender");
  EXPECT_EQ(only(blender, Role::velocity_prev).channels, (std::vector<std::string>{"*.Vector.X", "*.Vector.Y"}));
  EXPECT_EQ(only(blender, Role::velocity_prev).encoding.scale, (std::array<double, 3>{1, -1, 1}));
  EXPECT_EQ(only(blender, Role::velocity_next).encoding.scale, (std::array<double, 3>{-1, 1, 1}));
  EXPECT_EQ(only(blender, Role::velocity_next).encoding.sentinel_above, 10000);
  EXPECT_TRUE(only(blender, Role::ambient).encoding.multiply);
  EXPECT_EQ(only(blender, Role::ambient).channels.size(), 6U);
  EXPECT_EQ(only(blender, Role::normal).encoding.normal_space, NormalSpace::world);
}

TEST(Profiles, NukeConventions) {
  const Profile nuke = load_profile("nuke");
  EXPECT_EQ(only(nuke, Role::depth).encoding.depth_kind, DepthKind::inverse);
  EXPECT_EQ(only(nuke, Role::depth).channels, std::vector<std::string>{"depth.Z"});
  EXPECT_EQ(only(nuke, Role::velocity_next).channels, (std::vector<std::string>{"forward.u", "forward.v"}));
  EXPECT_EQ(only(nuke, Role::velocity_next).encoding.scale, (std::array<double, 3>{1, -1, 1}));
}

TEST(Profiles, EveryKeyIsRead) {
  const Profile p = parse_profile(R"({
    "description": "d", "unit": 0.5,
    "detect": [{"attribute": "unreal/*", "contains": "5."}, {"channel": "FinalImage*"}],
    "color": [["r.x", "g.x", "b.x"], "q.{R,G,B,A}"],
    "depth": [{"channels": "d", "kind": "device-reversed", "background_above": 5, "zero_is_background": true, "scale": [2], "neutral": 0.25}],
    "normal": [{"channels": "N.{X,Y,Z}", "space": "camera", "scale": [2, 2, -2], "neutral": 0.5}],
    "velocity_prev": [{"channels": ["mv.R", "mv.G"], "unit": "screen", "sentinel_above": 2, "scale": [-2, 2], "neutral": 0.5}],
    "velocity_next": [{"channels": "w.{u,v}"}],
    "ambient": [{"channels": ["a.{R,G,B}", "b.{R,G,B}"], "multiply": true}, {"channels": "GI.{R,G,B}"}],
    "ao": [{"channels": "AO"}],
    "camera": {"world_to_camera": "wc", "world_to_ndc": "wn"}})",
                                  "configs/own.json");
  EXPECT_EQ(p.name, "own");
  EXPECT_EQ(p.unit, "0.5");
  EXPECT_EQ(p.detect[0].contains, "5.");
  EXPECT_EQ(p.detect[1].channel, "FinalImage*");
  EXPECT_EQ(p.color, (std::vector<std::vector<std::string>>{{"r.x", "g.x", "b.x"}, {"q.R", "q.G", "q.B", "q.A"}}));
  const Encoding& depth = only(p, Role::depth).encoding;
  EXPECT_EQ(depth.depth_kind, DepthKind::device_reversed);
  EXPECT_EQ(depth.background_above, 5);
  EXPECT_TRUE(depth.zero_is_background);
  EXPECT_EQ(depth.scale[0], 2);
  EXPECT_EQ(depth.neutral, 0.25);
  EXPECT_EQ(only(p, Role::normal).encoding.normal_space, NormalSpace::camera);
  EXPECT_EQ(only(p, Role::normal).encoding.scale[2], -2);
  EXPECT_EQ(only(p, Role::velocity_prev).encoding.velocity_unit, VelocityUnit::screen);
  EXPECT_EQ(only(p, Role::velocity_prev).encoding.sentinel_above, 2);
  EXPECT_EQ(p.camera.world_to_camera, "wc");
  EXPECT_EQ(p.camera.world_to_ndc, "wn");
}

std::string complaint(const std::string& text) {
  try {
    parse_profile(text, "own.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::config);
    return error.what();
  }
  return "accepted";
}

TEST(Profiles, ComplaintsNameFileAndKey) {
  EXPECT_EQ(complaint(R"({"depts": []})"), "own.json: unknown key \"depts\" (did you mean \"depth\"?)");
  EXPECT_EQ(complaint(R"({"depth": [{"channels": "Z", "kind": "plane"}]})"),
            "own.json: depth[0].kind: \"plane\" is not one of planar, ray, device, device-reversed, inverse");
  EXPECT_NE(complaint(R"({"depth": [{"channels": "Z", "space": "world"}]})").find("depth[0]: unknown key \"space\""),
            std::string::npos);
  EXPECT_NE(complaint(R"({"normal": [{"channels": "N.{X,Y}"}]})")
                .find("normal[0].channels: names 2 channels, but normal has 3"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"normal": [{"channels": "N.{X,Y,Z}", "scale": [1]}]})").find("scale: needs 3 numbers"),
            std::string::npos);
  EXPECT_NE(complaint(R"({"depth2": [{"channels": "Z2", "kind": "ray"}]})").find("kind"), std::string::npos)
      << "the second depth is stored as the first";
  EXPECT_NE(complaint(R"({"detect": [{}]})").find("detect[0]: needs either"), std::string::npos);
  EXPECT_NE(complaint(R"({"color": ["R"]})").find("color[0]: names 1 channels"), std::string::npos);
  EXPECT_NE(complaint(R"({"unit": "yard"})").find("unit"), std::string::npos);
  EXPECT_NE(complaint("[]").find("must be an object"), std::string::npos);
}

TEST(Profiles, DepthKindsHaveOneTable) {
  for (size_t i = 0; i < kDepthKinds.size(); ++i) {
    const auto& [name, kind] = kDepthKinds[i];
    EXPECT_EQ(static_cast<size_t>(kind), i) << "each kind once";
    EXPECT_EQ(depth_kind_named(name), kind);
    const std::string json = R"({"depth": [{"channels": "Z", "kind": ")" + std::string(name) + R"("}]})";
    EXPECT_EQ(only(parse_profile(json, "own.json"), Role::depth).encoding.depth_kind, kind);
  }
  EXPECT_FALSE(depth_kind_named("plane"));
}

TEST(Profiles, UnknownNameSuggests) {
  try {
    load_profile("blendr");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "there is no producer profile \"blendr\" (did you mean \"blender\"?)");
  }
  EXPECT_THROW(load_profile("/no/such.json"), Error);
}

}  // namespace
}  // namespace aftershade::io
