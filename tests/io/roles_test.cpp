#include "core/io/roles.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace aftershade::io {
namespace {

PartInfo part(const std::vector<std::string>& channels, const std::string& name = "", const std::string& view = "") {
  PartInfo out{.name = name, .view = view, .data_window = {0, 0, 9, 9}, .channels = {}, .compression = "zip"};
  for (const std::string& channel : channels) out.channels.push_back({channel, PixelType::half});
  return out;
}
FileInfo file(std::vector<PartInfo> parts, std::vector<std::string> multi_view = {}) {
  return {.path = "x.exr",
          .display_window = {0, 0, 9, 9},
          .pixel_aspect = 1,
          .parts = std::move(parts),
          .multi_view = std::move(multi_view)};
}

using Names = std::vector<std::string>;
Names names(const std::vector<ChannelRef>& refs) {
  Names out;
  for (const ChannelRef& ref : refs) out.push_back(ref.channel);
  return out;
}
Names channels_of(const std::vector<RoleBinding>& roles, Role role) {
  for (const RoleBinding& binding : roles)
    if (binding.role == role) return names(binding.channels);
  return {};
}
std::vector<RoleBinding> resolve(const FileInfo& info, const char* profile = "generic", const char* view = "",
                                 const std::map<std::string, std::string>& overrides = {}) {
  return resolve_roles(info, view, load_profile(profile), overrides);
}

const FileInfo& stereo() {
  static const FileInfo info = file({part({"A", "B", "G", "R", "Z", "disparityL.x", "disparityL.y", "forward.left.u",
                                           "forward.left.v", "forward.right.u", "forward.right.v", "left.A", "left.B",
                                           "left.G", "left.R", "left.Z", "whitebarmask.left.mask"})},
                                    {"right", "left"});
  return info;
}

TEST(Views, OfSinglePartMultiPartAndPlainFiles) {
  EXPECT_EQ(views_of(stereo()), (Names{"right", "left"}));
  EXPECT_EQ(views_of(file({part({"R"}, "a", "r"), part({"Z"}, "b"), part({"R"}, "c", "l"), part({"Z"}, "d", "r")})),
            (Names{"r", "l"}));
  EXPECT_EQ(views_of(file({part({"R"})})), Names{""});
}

TEST(Views, TokensAreStripped) {
  const FileInfo& info = stereo();
  EXPECT_EQ(name_in_view(info, 0, "forward.left.u", "left"), "forward.u");
  EXPECT_EQ(name_in_view(info, 0, "forward.left.u", "right"), std::nullopt);
  EXPECT_EQ(name_in_view(info, 0, "left.Z", "left"), "Z");
  EXPECT_EQ(name_in_view(info, 0, "Z", "left"), std::nullopt) << "bare channels belong to the default view";
  EXPECT_EQ(name_in_view(info, 0, "Z", "right"), "Z");
  EXPECT_EQ(name_in_view(info, 0, "disparityL.x", "left"), "disparityL.x") << "common to all views";
  const FileInfo parts = file({part({"left.R"}, "a", "right"), part({"Z"}, "b", "left")});
  EXPECT_EQ(name_in_view(parts, 0, "left.R", "right"), "left.R") << "in a multi-part file names hold no view";
  EXPECT_EQ(name_in_view(parts, 1, "Z", "right"), std::nullopt);
}

TEST(Roles, Stereo) {
  for (const std::string view : {"right", "left"}) {
    const auto roles = resolve(stereo(), "generic", view.c_str());
    EXPECT_EQ(channels_of(roles, Role::depth), Names{view == "left" ? "left.Z" : "Z"});
    EXPECT_EQ(channels_of(roles, Role::velocity_next), (Names{"forward." + view + ".u", "forward." + view + ".v"}));
    EXPECT_TRUE(channels_of(roles, Role::velocity_prev).empty());
    const auto colors = resolve_colors(stereo(), view, load_profile("generic"));
    ASSERT_EQ(colors.size(), 1U);
    EXPECT_TRUE(colors[0].is_beauty);
    EXPECT_EQ(colors[0].alpha, 3);
    const std::string prefix = view == "left" ? "left." : "";
    EXPECT_EQ(names(colors[0].channels), (Names{prefix + "R", prefix + "G", prefix + "B", prefix + "A"}));
  }
}

TEST(Roles, BlenderTakesOneViewLayerForAllChannels) {
  Names channels;
  for (const std::string layer : {"View 1", "ViewLayer"})
    for (const char* name : {"Combined.A", "Combined.B", "Combined.G", "Combined.R", "Depth.Z", "Normal.X", "Normal.Y",
                             "Normal.Z", "Vector.W", "Vector.X", "Vector.Y", "Vector.Z", "DiffCol.R", "DiffCol.G",
                             "DiffCol.B", "DiffInd.R", "DiffInd.G", "DiffInd.B"})
      if (layer == "ViewLayer" || std::string(name) != "Vector.W") channels.push_back(layer + "." + name);
  const auto roles = resolve(file({part(channels)}), "blender");
  EXPECT_EQ(channels_of(roles, Role::depth), Names{"View 1.Depth.Z"});
  EXPECT_EQ(channels_of(roles, Role::velocity_prev), (Names{"View 1.Vector.X", "View 1.Vector.Y"}));
  EXPECT_EQ(channels_of(roles, Role::velocity_next), (Names{"ViewLayer.Vector.Z", "ViewLayer.Vector.W"}))
      << "never mixed";
  EXPECT_EQ(channels_of(roles, Role::ambient).size(), 6U);
  EXPECT_EQ(channels_of(roles, Role::ambient)[3], "View 1.DiffCol.R");
}

TEST(Roles, PartsOfTheirOwn) {
  const FileInfo blender5 =
      file({part({"L.Combined.R", "L.Combined.G", "L.Combined.B"}, "L.Combined"),
            part({"L.Diffuse Color.R", "L.Diffuse Color.G", "L.Diffuse Color.B"}, "L.Diffuse Color"),
            part({"L.Diffuse Indirect.R", "L.Diffuse Indirect.G", "L.Diffuse Indirect.B"}, "L.Diffuse Indirect")});
  EXPECT_EQ(channels_of(resolve(blender5, "blender"), Role::ambient).size(), 6U) << "one part a pass";
  const FileInfo nuke =
      file({part({"R", "G", "B", "A"}, "rgba.main"), part({"Z"}, "depth.main"), part({"u", "v"}, "forward.main")});
  const auto roles = resolve(nuke, "nuke");
  EXPECT_EQ(channels_of(roles, Role::depth), Names{"Z"});
  EXPECT_EQ(roles.front().encoding.depth_kind, DepthKind::inverse) << "known as depth.Z by the part's name";
  EXPECT_EQ(channels_of(roles, Role::velocity_next), (Names{"u", "v"}));
}

TEST(Roles, TheZOfAVectorIsNeverDepth) {
  EXPECT_TRUE(channels_of(resolve(file({part({"X", "Y", "Z"})})), Role::depth).empty());
  EXPECT_TRUE(channels_of(resolve(file({part({"depth.X", "depth.Y", "depth.Z"})})), Role::depth).empty());
  const Profile any_z = parse_profile(R"({"depth": [{"channels": "*.Z"}]})", "any.json");
  const FileInfo info = file({part({"N.x", "N.y", "N.z", "P.X", "P.Y", "P.Z", "foo.Z"})});
  EXPECT_EQ(channels_of(resolve_roles(info, "", any_z, {}), Role::depth), Names{"foo.Z"});
  EXPECT_EQ(channels_of(resolve(file({part({"R", "z"})})), Role::depth), Names{"z"});
  EXPECT_EQ(channels_of(resolve(file({part({"Z", "z"})})), Role::depth), Names{"Z"}) << "identical spelling first";
}

TEST(Roles, TheSecondDepthHasItsOwnNames) {
  for (const std::string name : {"depth2.Z", "Z2", "L.Depth2.Z", "depth_second.Z", "depth2"}) {
    const auto roles = resolve(file({part({"R", "G", "B", "Z", name})}));
    EXPECT_EQ(channels_of(roles, Role::depth2), Names{name});
    EXPECT_EQ(channels_of(roles, Role::depth), Names{"Z"});
  }
  EXPECT_TRUE(channels_of(resolve(file({part({"Z", "depth2.X", "depth2.Y", "depth2.Z"})})), Role::depth2).empty());
  EXPECT_EQ(channels_of(resolve(file({part({"Z"})}), "generic", "", {{"depth2", "Z"}}), Role::depth2), Names{"Z"});
}

TEST(Roles, TheZOfAPartIsTheDepthThatThePartSays) {
  const FileInfo info = file({part({"Z"}, "depth2.main"), part({"R", "G", "B"}, "rgba"), part({"Z"}, "other")});
  for (const RoleBinding& binding : resolve(info))
    EXPECT_EQ(binding.channels.front().part, binding.role == Role::depth2 ? 0 : 2)
        << aftershade::info(binding.role).name;
  EXPECT_EQ(resolve(info).size(), 2U);
  EXPECT_TRUE(channels_of(resolve(file({part({"Z"}, "depth2"), part({"R"}, "rgba")})), Role::depth).empty());
}

TEST(Roles, Overrides) {
  const FileInfo info =
      file({part({"R", "G", "B", "Z", "foo.Z", "L.Vector.X", "L.Vector.Y", "m.a", "m.b", "GI.R", "GI.G", "GI.B"})});
  const auto depth = resolve(info, "generic", "", {{"depth", "foo.Z"}});
  EXPECT_EQ(channels_of(depth, Role::depth), Names{"foo.Z"});
  EXPECT_EQ(depth.front().why, "--channel depth=foo.Z");
  const auto prev = resolve(info, "generic", "", {{"velocity_prev", "m.a,m.b"}});
  EXPECT_EQ(channels_of(prev, Role::velocity_prev), (Names{"m.a", "m.b"}));
  const auto twice = resolve(info, "generic", "", {{"ambient", "GI.R,GI.G,GI.B,R,G,B"}});
  EXPECT_TRUE(twice.back().encoding.multiply);
  EXPECT_FALSE(resolve(info, "blender", "", {{"ambient", "GI.R,GI.G,GI.B"}}).back().encoding.multiply);
}

TEST(Roles, OverridesThatCannotBeMet) {
  const auto message = [](const std::map<std::string, std::string>& overrides, ErrorCode code) {
    try {
      resolve(stereo(), "generic", "right", overrides);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message({{"depth", "ZZ"}}, ErrorCode::no_input),
            "channel \"ZZ\" of --channel depth=ZZ does not exist (did you mean \"Z\"?)");
  EXPECT_NE(message({{"depth", "unheard.of"}}, ErrorCode::no_input).find("the file has A, B, G, R, Z"),
            std::string::npos);
  EXPECT_NE(message({{"dept", "Z"}}, ErrorCode::usage).find("did you mean \"depth\"?"), std::string::npos);
  EXPECT_NE(message({{"velocity_next", "Z"}}, ErrorCode::usage).find("names 1 channels; velocity_next has 2"),
            std::string::npos);
  EXPECT_EQ(message({{"color", "R,G,B"}}, ErrorCode::usage), "accepted") << "colour is resolved elsewhere";
}

TEST(Colors, LayersAndCryptomattes) {
  const FileInfo info = file({part({"B",
                                    "G",
                                    "R",
                                    "Z",
                                    "spec.r",
                                    "spec.g",
                                    "spec.b",
                                    "spec.a",
                                    "key.red",
                                    "key.green",
                                    "key.blue",
                                    "mask.m",
                                    "matte.r",
                                    "matte.g",
                                    "matte.b",
                                    "matte00.r",
                                    "matte00.g",
                                    "matte00.b",
                                    "matte00.a",
                                    "uCryptoAsset01.r",
                                    "uCryptoAsset01.g",
                                    "uCryptoAsset01.b",
                                    "uv.u",
                                    "uv.v"})});
  const Names cryptomattes{"matte"};
  const auto colors = resolve_colors(info, "", load_profile("generic"), {}, cryptomattes);
  Names layers;
  for (const ColorBinding& color : colors) layers.push_back(color.layer);
  EXPECT_EQ(layers, (Names{"", "spec", "key"}));
  EXPECT_EQ(colors[0].alpha, -1);
  EXPECT_EQ(colors[1].alpha, 3);
  const auto find = [&](const char* name) { return find_layer(info, "", colors, name, cryptomattes); };
  EXPECT_TRUE(find("beauty").is_beauty);
  EXPECT_EQ(names(find("key").channels), (Names{"key.red", "key.green", "key.blue"}));
  EXPECT_EQ(names(find("uv").channels), (Names{"uv.u", "uv.v"}));
  EXPECT_EQ(names(find("mask.m").channels), Names{"mask.m"});
  EXPECT_THROW(find("matte00"), Error);
  EXPECT_THROW(find("matte00.r"), Error);
  try {
    find("spek");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::no_input);
    EXPECT_STREQ(error.what(), "there is no layer or channel \"spek\" (did you mean \"spec\"?)");
  }
}

TEST(FindChannel, ByNameInTheViewOrInTheFile) {
  const auto in_stereo = [](const char* view, const char* name) { return find_channel(stereo(), view, name).channel; };
  EXPECT_EQ(in_stereo("left", "whitebarmask.mask"), "whitebarmask.left.mask");
  EXPECT_EQ(in_stereo("left", "whitebarmask.left.mask"), "whitebarmask.left.mask");
  EXPECT_EQ(in_stereo("right", "disparityL.x"), "disparityL.x");
  const FileInfo parts = file({part({"R", "G", "B"}, "rgba"), part({"V"}, "shadow"), part({"V"}, "light")});
  EXPECT_EQ(find_channel(parts, "", "V"), (ChannelRef{1, "V"}));
  EXPECT_EQ(find_channel(parts, "", "light.V"), (ChannelRef{2, "V"}));
}

TEST(FindChannel, SaysWhatThereIsAndRefusesCryptomattes) {
  const FileInfo info =
      file({part({"R", "shadow.R", "shadow.G", "matte00.r", "uCryptoAsset01.r"}), part({"r"}, "matte01")});
  const auto message = [&](const char* name, ErrorCode code) {
    try {
      find_channel(info, "", name, {"matte"});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << name;
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message("shadow.B", ErrorCode::no_input), "there is no channel \"shadow.B\" (did you mean \"shadow.R\"?)");
  EXPECT_NE(message("shadow", ErrorCode::no_input).find("name one of its channels, shadow.R, shadow.G"),
            std::string::npos);
  EXPECT_NE(message("something", ErrorCode::no_input).find("the file has R, shadow.R"), std::string::npos);
  for (const char* name : {"matte00.r", "uCryptoAsset01.r", "matte01.r", "r"})
    EXPECT_NE(message(name, ErrorCode::usage).find("Cryptomatte"), std::string::npos) << name;
}

TEST(Colors, Override) {
  const FileInfo info = file({part({"R", "G", "B", "A", "lit.R", "lit.G", "lit.B"})});
  const auto colors = resolve_colors(info, "", load_profile("generic"), {{"color", "lit.R,lit.G,lit.B"}});
  EXPECT_EQ(names(colors[0].channels), (Names{"lit.R", "lit.G", "lit.B"}));
  EXPECT_TRUE(colors[0].is_beauty);
  EXPECT_EQ(colors.size(), 2U) << "the other group is an ordinary layer now";
  EXPECT_THROW(resolve_colors(info, "", load_profile("generic"), {{"color", "R"}}), Error);
}

}  // namespace
}  // namespace aftershade::io
