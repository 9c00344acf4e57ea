#include "core/pipeline/named_channels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/filter/bilateral_blur.h"
#include "core/math/sampling.h"
#include "core/pipeline/pipeline.h"
#include "tests/pipeline/memory_sequence.h"

namespace aftershade::pipeline {
namespace {

using filter::BilateralBlurParams;
using tests::same_pixels;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
const WorkOptions kNoWishes;
const Offer kDepthAndLens{{Role::depth}, true, false};

BilateralBlurParams blur_of(const std::string& channel) {
  BilateralBlurParams params;
  params.channel = channel;
  return params;
}

/// The blades with a channel "shadow" of noise.
Frame shadow_frame(int number) {
  Frame frame = tests::blade_frame(number);
  Plane shadow(48, 36);
  for (int y = 0; y < 36; ++y)
    for (int x = 0; x < 48; ++x)
      shadow(x, y) = unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y)));
  frame.named["shadow"] = std::move(shadow);
  return frame;
}

/// A frame as it leaves the stages.
Frame processed(const preset::Preset& preset, Frame frame, const Offer& offer = kDepthAndLens) {
  ViewPipeline view(preset, "", offer, {});
  const int number = frame.number;
  view.push(std::move(frame), {}, {number, view.stages(), true, true});
  view.flush();
  return std::move(view.take_finished().at(0).frame);
}

Plane blurred(Frame& frame, const Plane& value) {
  Work work(frame, nullptr, kNoWishes);
  return filter::bilateral_blur({}, value, filter::full_grid(work.surface()), work.surface());
}

TEST(NamedChannels, ArePresetsChannelsOnce) {
  const preset::Preset preset{
      "p", "", {{"a", blur_of("shadow")}, {"b", blur_of("")}, {"c", blur_of("light.V")}, {"d", blur_of("shadow")}}};
  EXPECT_EQ(named_channels(preset), (std::vector<std::string>{"shadow", "light.V"}));
  EXPECT_TRUE(named_channels(preset::load_preset("high-dx11").preset).empty());
}

TEST(NamedChannels, NeedNeitherAoNorLayers) {
  const preset::Preset preset{"p", "", {{"blur", blur_of("shadow")}}};
  ViewPipeline view(preset, "", kDepthAndLens, {});
  EXPECT_FALSE(view.layers(view.stages()));
  EXPECT_TRUE(view.roles(view.stages()).contains(Role::depth));
  EXPECT_THROW(ViewPipeline(preset, "", {}, {}), Error) << "but depth";
  EXPECT_THROW(ViewPipeline({"p", "", {{"blur", blur_of("")}}}, "", kDepthAndLens, {}), Error) << "the AO's blur does";
}

TEST(NamedChannels, AreLeftOutWhereOnlyAddedChannelsAreWanted) {
  ViewPipeline view({"p", "", {{"blur", blur_of("shadow")}}}, "", {}, {{}, false, {}});
  EXPECT_EQ(view.stages(), 0U);
}

TEST(NamedChannels, TheBlurOfOneIsTheFilterAtEveryPixel) {
  Frame source = shadow_frame(1);
  const Frame out = processed({"p", "", {{"blur", blur_of("shadow")}}}, shadow_frame(1));
  EXPECT_TRUE(same_pixels(out.added.at("shadow"), blurred(source, source.named.at("shadow"))));
  EXPECT_FALSE(same_pixels(out.added.at("shadow"), source.named.at("shadow")));
  EXPECT_TRUE(same_pixels(out.named.at("shadow"), source.named.at("shadow"))) << "still as the file has it";
  EXPECT_FALSE(out.layers.front().changed);
}

TEST(NamedChannels, ALaterStageGoesOnWithWhatTheFirstMade) {
  Frame source = shadow_frame(1);
  const Frame out = processed({"p", "", {{"a", blur_of("shadow")}, {"b", blur_of("shadow")}}}, shadow_frame(1));
  EXPECT_TRUE(same_pixels(out.added.at("shadow"), blurred(source, blurred(source, source.named.at("shadow")))));
}

TEST(NamedChannels, HaveNothingToDoWithTheAo) {
  preset::Preset with = preset::load_preset("low-dx11").preset;
  std::erase_if(with.stages, [](const auto& stage) { return stage.id == "motion_blur"; });
  Frame without = processed(with, shadow_frame(1), {{Role::depth, Role::velocity_prev}, true, true});
  for (size_t at = 0; at <= with.stages.size(); ++at) {
    preset::Preset mixed = with;
    mixed.stages.insert(mixed.stages.begin() + static_cast<std::ptrdiff_t>(at), {"shadow", blur_of("shadow")});
    const Frame out = processed(mixed, shadow_frame(1), {{Role::depth, Role::velocity_prev}, true, true});
    EXPECT_TRUE(same_pixels(out.layers.front().planes[0], without.layers.front().planes[0])) << at;
    EXPECT_TRUE(same_pixels(out.added.at("shadow"), blurred(without, without.named.at("shadow")))) << at;
  }
}

TEST(NamedChannels, BackgroundAndWhatIsNoNumberStayAndDoNotSpread) {
  Frame frame = shadow_frame(1);
  frame.planes(Role::depth)[0](5, 5) = kInf;
  Plane& shadow = frame.named["shadow"];
  shadow = Plane(48, 36, 0.5F);
  shadow(5, 5) = -0.0F;
  shadow(20, 20) = kNan;
  shadow(30, 20) = kInf;
  const Plane before = copy_of(shadow);
  const Frame out = processed({"p", "", {{"blur", blur_of("shadow")}}}, std::move(frame));
  EXPECT_TRUE(same_pixels(out.added.at("shadow"), before));
  EXPECT_TRUE(std::signbit(out.added.at("shadow")(5, 5)));
}

TEST(NamedChannels, FollowTheWindow) {
  Frame frame = shadow_frame(1);
  frame.added["shadow"] = copy_of(frame.named["shadow"]);
  frame.added["other"] = Plane(48, 36, 1.0F);
  Work work(frame, nullptr, kNoWishes);
  work.change_window({-2, -1, 47, 35});
  for (const Plane* plane : {&frame.named["shadow"], &frame.added["shadow"]}) {
    EXPECT_TRUE(std::isnan((*plane)(0, 0)));
    EXPECT_EQ((*plane)(2, 1), unit_float(hash_counters(0U, 0U)));
  }
  EXPECT_EQ(frame.added["other"](0, 0), 0);
}

}  // namespace
}  // namespace aftershade::pipeline
