#include "core/ao/apply_ao.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using ao::ApplyAoParams;
using ao::ApplyTarget;

constexpr int kWidth = 5;
const std::array<float, kWidth> kColours{0.0F, 0.5F, 2.0F, -0.25F, 1e-3F};

/// Two layers, A B G R as files list them; only the first receives AO.
Frame frame_of(bool with_ambient) {
  Frame frame;
  frame.number = 7;
  frame.window = frame.display = {0, 0, kWidth - 1, 0};
  for (const bool receives : {true, false}) {
    Layer layer;
    layer.channels = {"L.A", "L.B", "L.G", "L.R"};
    layer.alpha = 0;
    layer.receives_ao = receives;
    for (int i = 0; i < 4; ++i) {
      Plane plane(kWidth, 1, 0.75F);
      for (int x = 0; i > 0 && x < kWidth; ++x) plane(x, 0) = kColours[static_cast<size_t>(x)];
      layer.planes.push_back(std::move(plane));
    }
    frame.layers.push_back(std::move(layer));
  }
  if (with_ambient)
    for (int i = 0; i < 3; ++i) frame.planes(Role::ambient).emplace_back(kWidth, 1, 0.1F * static_cast<float>(i + 1));
  return frame;
}

Plane ao_plane(std::array<float, kWidth> values) {
  Plane plane(kWidth, 1);
  for (int x = 0; x < kWidth; ++x) plane(x, 0) = values[static_cast<size_t>(x)];
  return plane;
}

TEST(ApplyAo, EverythingMultipliesColourAndLeavesAlphaAndOtherLayers) {
  Frame frame = frame_of(false);
  const std::array<float, kWidth> open{1.0F, 0.5F, 0.0F, 0.25F, 0.9F};
  ApplyAoParams params;
  params.strength = 0.8F;
  params.minimum = 0.3F;
  ao::apply_ao(params, ao_plane(open), frame);
  for (size_t x = 0; x < kWidth; ++x) {
    const double a = std::max(0.3, 1 - 0.8 * (1 - static_cast<double>(open[x])));
    for (size_t i = 1; i < 4; ++i) {
      EXPECT_NEAR(frame.layers[0].planes[i](static_cast<int>(x), 0), a * static_cast<double>(kColours[x]), 1e-6);
      EXPECT_EQ(frame.layers[1].planes[i](static_cast<int>(x), 0), kColours[x]);
    }
    EXPECT_EQ(frame.layers[0].planes[0](static_cast<int>(x), 0), 0.75F) << "alpha";
  }
}

TEST(ApplyAo, AmbientIsSubtractedChannelByChannelAndNothingTurnsNegative) {
  Frame frame = frame_of(true);
  ApplyAoParams params;
  params.target = ApplyTarget::ambient;
  ao::apply_ao(params, ao_plane({0.5F, 0.5F, 0.0F, 0.0F, 0.0F}), frame);
  const std::array<double, 4> ambient{0, 0.3, 0.2, 0.1};  // of A, B, G, R
  for (size_t i = 1; i < 4; ++i) {
    const Plane& plane = frame.layers[0].planes[i];
    EXPECT_EQ(plane(0, 0), 0.0F);
    EXPECT_NEAR(plane(1, 0), 0.5 - 0.5 * ambient[i], 1e-6);
    EXPECT_NEAR(plane(2, 0), 2 - ambient[i], 1e-6);
    EXPECT_EQ(plane(3, 0), -0.25F) << "negative already: not made worse";
    EXPECT_EQ(plane(4, 0), 0.0F) << "less light than the ambient claims";
  }
}

TEST(ApplyAo, OpenAoChangesNoBit) {
  for (const ApplyTarget target : {ApplyTarget::everything, ApplyTarget::ambient}) {
    Frame frame = frame_of(true);
    ApplyAoParams params;
    params.target = target;
    ao::apply_ao(params, ao_plane({1, 1, 1, 1, 1}), frame);
    for (int x = 0; x < kWidth; ++x) EXPECT_EQ(frame.layers[0].planes[2](x, 0), kColours[static_cast<size_t>(x)]);
  }
}

TEST(ApplyAo, LeavesNanAndInfAndTakesUnknownAoForOpen) {
  for (const ApplyTarget target : {ApplyTarget::everything, ApplyTarget::ambient}) {
    Frame frame = frame_of(true);
    Plane& green = frame.layers[0].planes[2];
    green(0, 0) = kNan;
    green(1, 0) = kInf;
    green(2, 0) = -kInf;
    ApplyAoParams params;
    params.target = target;
    ao::apply_ao(params, ao_plane({0, 0, 0, kNan, kInf}), frame);
    EXPECT_TRUE(std::isnan(green(0, 0)));
    EXPECT_EQ(green(1, 0), kInf);
    EXPECT_EQ(green(2, 0), -kInf);
    EXPECT_EQ(green(3, 0), -0.25F);
    EXPECT_EQ(green(4, 0), 1e-3F);
  }
}

TEST(ApplyAo, BadAmbientIsTakenForNone) {
  Frame frame = frame_of(true);
  for (Plane& plane : frame.planes(Role::ambient)) {
    plane(1, 0) = kNan;
    plane(2, 0) = -5;
  }
  ApplyAoParams params;
  params.target = ApplyTarget::ambient;
  ao::apply_ao(params, ao_plane({0, 0, 0, 0, 0}), frame);
  EXPECT_EQ(frame.layers[0].planes[3](1, 0), 0.5F);
  EXPECT_EQ(frame.layers[0].planes[3](2, 0), 2.0F);
}

TEST(ApplyAo, AutomaticIsAmbientWhereTheFileHasIt) {
  ApplyAoParams params;
  EXPECT_EQ(ao::resolved_target(params, frame_of(true)), ApplyTarget::ambient);
  EXPECT_EQ(ao::resolved_target(params, frame_of(false)), ApplyTarget::everything);
  params.target = ApplyTarget::none;
  Frame frame = frame_of(true);
  ao::apply_ao(params, ao_plane({0, 0, 0, 0, 0}), frame);
  EXPECT_EQ(frame.layers[0].planes[1](1, 0), 0.5F);
}

TEST(ApplyAo, AmbientWithoutAmbientNamesTheFrame) {
  Frame frame = frame_of(false);
  ApplyAoParams params;
  params.target = ApplyTarget::ambient;
  try {
    ao::apply_ao(params, ao_plane({0, 0, 0, 0, 0}), frame);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::data);
    EXPECT_NE(std::string(error.what()).find("frame 7"), std::string::npos);
  }
}

TEST(ApplyAo, AnAoOfTheFileIsIgnoredMultipliedOrTheLeastCounts) {
  const std::array<float, kWidth> ours{0.5F, 0.5F, 0.75F, 1.0F, kNan}, theirs{0.25F, 0.5F, 1.0F, kNan, 0.5F};
  const std::array<float, kWidth> product{0.125F, 0.25F, 0.75F, 1.0F, 0.5F}, least{0.25F, 0.5F, 0.75F, 1.0F, 0.5F},
      alone{0.5F, 0.5F, 0.75F, 1.0F, 1.0F};
  for (const auto& [baked, expected] :
       {std::pair(ao::BakedAo::ignore, alone), {ao::BakedAo::multiply, product}, {ao::BakedAo::least, least}}) {
    Frame frame = frame_of(false);
    frame.planes(Role::ao).push_back(ao_plane(theirs));
    for (Plane& plane : frame.layers[0].planes)
      for (int x = 0; x < kWidth; ++x) plane(x, 0) = 2;
    ApplyAoParams params;
    params.baked = baked;
    ao::apply_ao(params, ao_plane(ours), frame);
    for (int x = 0; x < kWidth; ++x)
      EXPECT_EQ(frame.layers[0].planes[1](x, 0), 2 * expected[static_cast<size_t>(x)]) << x;
    EXPECT_EQ(frame.planes(Role::ao)[0](0, 0), 0.25F) << "the file's own stays what it is";
  }
}

TEST(ApplyAo, AnAoThatTheFileLacksNamesTheFrame) {
  Frame frame = frame_of(false);
  ApplyAoParams params;
  params.baked = ao::BakedAo::least;
  try {
    ao::apply_ao(params, ao_plane({0, 0, 0, 0, 0}), frame);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::data);
    EXPECT_NE(std::string(error.what()).find("frame 7"), std::string::npos);
  }
}

}  // namespace
}  // namespace aftershade::tests
