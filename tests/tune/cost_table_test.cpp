#include "core/tune/cost_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/error.h"

namespace aftershade::tune {
namespace {

Measured ms(double milliseconds, double spread = 0, double bytes = 1000) { return {{milliseconds, bytes}, spread}; }

/// Taps cost what they are, the radius nothing, frames memory.
CostTable table() {
  CostTable t;
  t.program = "aftershade 1";
  t.preset = "p", t.stage = "ao", t.method = "m";
  t.base = {{"taps", 8}, {"radius_m", 1.0}, {"frames", 2}, {"resolution", "full"}};
  t.width = 480, t.height = 270, t.threads = 2, t.rounds = 5;
  t.cost = ms(4, 0.05);
  t.curves = {{"taps", {2, 8, 32}, {ms(1), t.cost, ms(16)}},
              {"radius_m", {0.25, 1, 4}, {ms(4.1), t.cost, ms(3.95)}},
              {"frames", {0, 2, 8}, {ms(4, 0, 500), t.cost, ms(6, 0, 2500)}}};
  judge_noise(t);
  return t;
}

TEST(CostTable, BeyondNoiseIsMoreThanThreePercentAndBothSpreads) {
  const CostTable t = table();
  EXPECT_TRUE(t.curves[0].time_varies);
  EXPECT_FALSE(t.curves[1].time_varies) << "2.5 % and less";
  EXPECT_TRUE(t.curves[2].time_varies);
  EXPECT_FALSE(t.curves[0].memory_varies);
  EXPECT_TRUE(t.curves[2].memory_varies);
  CostTable wide = table();
  wide.curves[1].time_varies = false;
  wide.curves[1].costs[0] = ms(4.5, 0.4);
  judge_noise(wide);
  EXPECT_FALSE(wide.curves[1].time_varies) << "0.5 is within 0.12 + 0.01 + 0.4 + 0.05";
  wide.curves[1].costs[0] = ms(4.5, 0.3);
  judge_noise(wide);
  EXPECT_TRUE(wide.curves[1].time_varies);
}

TEST(CostTable, PredictsWhatWasMeasured) {
  const CostTable t = table();
  EXPECT_DOUBLE_EQ(t.predict({}).milliseconds, 4);
  EXPECT_DOUBLE_EQ(t.predict({}).bytes, 1000);
  EXPECT_DOUBLE_EQ(t.predict({{"taps", 2}}).milliseconds, 1);
  EXPECT_DOUBLE_EQ(t.predict({{"taps", 32}, {"radius_m", 0.25}}).milliseconds, 16);
  EXPECT_DOUBLE_EQ(t.predict({{"frames", 8}}).bytes, 2500);
}

TEST(CostTable, InterpolatesRatiosInLogarithmsAndMultipliesThem) {
  const CostTable t = table();
  EXPECT_NEAR(t.predict({{"taps", 4}}).milliseconds, 2, 1e-12);
  EXPECT_NEAR(t.predict({{"taps", 16}}).milliseconds, 8, 1e-12);
  EXPECT_NEAR(t.predict({{"taps", 16}, {"frames", 8}}).milliseconds, 12, 1e-12);
  EXPECT_NEAR(t.predict({{"frames", 5}}).milliseconds, 4 * std::sqrt(1.5), 1e-12)
      << "linear in the value where it is 0";
  EXPECT_DOUBLE_EQ(t.predict({{"taps", 1}}).milliseconds, 1) << "constant beyond the ends";
  EXPECT_DOUBLE_EQ(t.predict({{"taps", 100}}).milliseconds, 16);
}

TEST(CostTable, TheCheapestIsTheLeastOfEachCurve) {
  EXPECT_DOUBLE_EQ(table().cheapest().milliseconds, 1);
  EXPECT_DOUBLE_EQ(table().cheapest().bytes, 500);
}

TEST(CostTable, SurvivesJson) {
  const CostTable t = table();
  const params::Json json = to_json(t);
  const CostTable back = cost_table_of(params::Json::parse(json.dump()), "x.json");
  EXPECT_EQ(to_json(back), json);
  EXPECT_EQ(back.predict({{"taps", 11}}), t.predict({{"taps", 11}}));
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::config);
    return error.what();
  }
  return "no error";
}

TEST(CostTable, WhatIsNoTableIsSaid) {
  const auto broken = [](const std::function<void(params::Json&)>& breaks) {
    params::Json json = to_json(table());
    breaks(json);
    return error_of([&] { cost_table_of(json, "x.json"); });
  };
  EXPECT_NE(broken([](auto& j) { j = 3; }).find("x.json: this is no cost table"), std::string::npos);
  EXPECT_NE(broken([](auto& j) { j.erase("curves"); }).find("this is no cost table"), std::string::npos);
  EXPECT_NE(broken([](auto& j) { j["threads"] = "two"; }).find("this is no cost table"), std::string::npos);
  EXPECT_NE(broken([](auto& j) { j["cost"]["milliseconds"] = -1; }).find("not positive"), std::string::npos);
  EXPECT_NE(broken([](auto& j) { j["curves"][0]["costs"][1]["value"] = 2; }).find("do not rise"), std::string::npos);
  EXPECT_NE(broken([](auto& j) { j["base"]["taps"] = "8"; }).find("taps has no number"), std::string::npos);
}

TEST(CostTable, FitsItsStageOnly) {
  const Axes axes{{"taps", 4, 32, true}};
  const auto differs = [&](const std::function<void(CostTable&)>& change) {
    CostTable wanted = table();
    wanted.curves.clear();
    change(wanted);
    return error_of([&] { check_fits(table(), wanted, axes, "x.json"); });
  };
  EXPECT_EQ(differs([](CostTable&) {}), "no error");
  EXPECT_EQ(differs([](CostTable& t) { t.base["taps"] = 16; }), "no error") << "another start on the same curve";
  EXPECT_EQ(differs([](CostTable& t) { t.program = "aftershade 2"; }), "no error");
  EXPECT_NE(differs([](CostTable& t) { t.stage = "blur"; }).find("x.json: the costs were measured with stage ao, not"),
            std::string::npos);
  EXPECT_NE(differs([](CostTable& t) { t.method = "n"; }).find("method m, not n"), std::string::npos);
  EXPECT_NE(differs([](CostTable& t) { t.width = 960; }).find("480, not 960"), std::string::npos);
  EXPECT_NE(differs([](CostTable& t) { t.height = 540; }).find("270, not 540"), std::string::npos);
  EXPECT_NE(differs([](CostTable& t) { t.threads = 4; }).find("(--threads 2, or"), std::string::npos);
  EXPECT_NE(differs([](CostTable& t) { t.base["resolution"] = "half"; }).find("\"full\", not \"half\""),
            std::string::npos);
  const auto lacks = [](const Axis& axis) { return error_of([&] { check_fits(table(), table(), {axis}, "x.json"); }); };
  EXPECT_NE(lacks({"bias", 0, 1}).find("not measured for bias from 0 to 1"), std::string::npos);
  EXPECT_NE(lacks({"taps", 1, 8, true}).find("not measured for taps from 1 to 8"), std::string::npos);
}

}  // namespace
}  // namespace aftershade::tune
