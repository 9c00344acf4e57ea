#include "core/base/text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/metrics/sequence_scores.h"
#include "core/params/table.h"
#include "tests/report/sample.h"

namespace aftershade::tests {
namespace {

using params::Json;

/// RFC 4180, read back: records of fields.
std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> records(1, std::vector<std::string>(1));
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    std::string& field = records.back().back();
    if (quoted && text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"')
      field += text[++i];
    else if (text[i] == '"')
      quoted = !quoted;
    else if (!quoted && text[i] == ',')
      records.back().emplace_back();
    else if (!quoted && text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n')
      records.emplace_back(1), ++i;
    else
      field += text[i];
  }
  EXPECT_FALSE(quoted);
  EXPECT_EQ(records.back(), std::vector<std::string>{""}) << "the last line is ended";
  records.pop_back();
  return records;
}

TEST(ReportJson, HoldsEveryNumberExactly) {
  const report::Comparison comparison = sample_comparison();
  const Json json = Json::parse(json_text(comparison));
  EXPECT_EQ(json["program"], comparison.program);
  EXPECT_EQ(json["input"], comparison.input);
  EXPECT_EQ(json["reference"], comparison.reference);
  EXPECT_EQ(json["frames"].get<std::vector<int>>(), comparison.frames);
  EXPECT_EQ(json["display"], (Json{{"x", 16}, {"y", 8}, {"width", 640}, {"height", 360}}));
  ASSERT_EQ(json["presets"].size(), comparison.candidates.size());
  for (size_t i = 0; i < comparison.candidates.size(); ++i) {
    const report::Candidate& candidate = comparison.candidates[i];
    const Json& preset = json["presets"][i];
    EXPECT_EQ(preset["memory_bytes"].get<int64_t>(), candidate.memory_bytes);
    EXPECT_EQ(preset::from_json(preset["preset"], candidate.preset.name), candidate.preset);
    ASSERT_EQ(preset["frames"].size(), candidate.frames.size());
    for (size_t f = 0; f < candidate.frames.size(); ++f) {
      const report::FrameResult& frame = candidate.frames[f];
      EXPECT_EQ(preset["frames"][f]["frame"], frame.number);
      for (const auto& [name, value] : frame.scores) {
        const Json& score = preset["frames"][f]["scores"][name];
        EXPECT_TRUE(std::isfinite(value) ? score.get<double>() == value : score.is_null()) << name;
      }
      for (size_t s = 0; s < frame.cost.size(); ++s) {
        EXPECT_EQ(preset["frames"][f]["cost"][s]["stage"], frame.cost[s].id);
        EXPECT_EQ(preset["frames"][f]["cost"][s]["ms"].get<double>(), frame.cost[s].milliseconds);
      }
    }
  }
  EXPECT_FALSE(json["presets"][0]["frames"][0]["scores"].contains("flicker_stable")) << "left out where there is none";
}

TEST(ReportJson, MetricsSayWhichWayIsBetter) {
  const Json json = Json::parse(json_text(sample_comparison()));
  const auto better = [&](const std::string& name) {
    for (const Json& metric : json["metrics"])
      if (metric["name"] == name) return metric["better"].get<std::string>();
    return std::string();
  };
  EXPECT_EQ(better("psnr"), "higher");
  EXPECT_EQ(better("ldr_flip"), "lower");
  EXPECT_EQ(better("ao_bias"), "zero");
}

TEST(ReportJson, WhatWasNotMeasuredIsNull) {
  SampleOptions options;
  options.reference = options.cost = false;
  report::Comparison comparison = sample_comparison(options);
  comparison.candidates[0].sequence["flicker_stable"] = std::numeric_limits<double>::quiet_NaN();
  comparison.candidates[1].sequence["flicker_stable"] = std::numeric_limits<double>::infinity();
  const Json json = Json::parse(json_text(comparison));
  EXPECT_TRUE(json["reference"].is_null());
  EXPECT_TRUE(json["presets"][0]["cost"].is_null());
  EXPECT_TRUE(json["presets"][0]["memory_bytes"].is_null());
  EXPECT_TRUE(json["presets"][0]["scores"]["flicker_stable"].is_null());
  EXPECT_EQ(json["presets"][1]["scores"]["flicker_stable"], "inf");
}

TEST(ReportCsv, ALinePerFrameAndOneForAll) {
  const report::Comparison comparison = sample_comparison();
  const auto records = read_csv(csv_text(comparison));
  ASSERT_EQ(records.size(), 1 + comparison.candidates.size() * (comparison.frames.size() + 1));
  const auto& header = records[0];
  EXPECT_EQ((std::vector<std::string>(header.begin(), header.begin() + 4)),
            (std::vector<std::string>{"preset", "frame", "psnr", "ssim"}));
  EXPECT_EQ(header.back(), "memory_bytes");
  for (const auto& record : records) EXPECT_EQ(record.size(), header.size());
  const auto column = static_cast<size_t>(std::find(header.begin(), header.end(), "ao_ms") - header.begin());
  const auto total = static_cast<size_t>(std::find(header.begin(), header.end(), "total_ms") - header.begin());
  for (size_t c = 0; c < comparison.candidates.size(); ++c)
    for (size_t f = 0; f <= comparison.frames.size(); ++f) {
      const report::Candidate& candidate = comparison.candidates[c];
      const auto& record = records[1 + c * (comparison.frames.size() + 1) + f];
      const bool all = f == comparison.frames.size();
      const auto& scores = all ? candidate.sequence : candidate.frames[f].scores;
      const auto& cost = all ? candidate.cost : candidate.frames[f].cost;
      EXPECT_EQ(record[0], candidate.preset.name);
      EXPECT_EQ(record[1], all ? "all" : cat(candidate.frames[f].number));
      EXPECT_EQ(parse_number(record[2]), scores.at("psnr")) << "exactly";
      EXPECT_EQ(record[7], "") << "a NaN";
      EXPECT_EQ(parse_number(record[column]), cost[1].milliseconds);
      double sum = 0;
      for (const report::StageCost& stage : cost) sum += stage.milliseconds;
      EXPECT_EQ(parse_number(record[total]), sum);
    }
}

TEST(ReportCsv, OddNamesComeBack) {
  report::Comparison comparison = sample_comparison();
  const std::vector<std::string> names{"a,b", "say \"hi\"", "two\r\nlines", "\xE5\x83\x8F"};
  for (size_t i = 0; i < names.size(); ++i) comparison.candidates[i].preset.name = names[i];
  comparison.candidates[0].cost[1].id = "my,stage";
  const auto records = read_csv(csv_text(comparison));
  for (size_t i = 0; i < names.size(); ++i) EXPECT_EQ(records[1 + i * 13][0], names[i]);
  EXPECT_NE(std::find(records[0].begin(), records[0].end(), "my,stage_ms"), records[0].end());
}

TEST(ReportCsv, WithoutCostThereIsNoStage) {
  SampleOptions options;
  options.cost = false;
  const auto records = read_csv(csv_text(sample_comparison(options)));
  EXPECT_EQ(records[0].size(), 2 + 6 + 2U);
  EXPECT_EQ(records[1].back(), "");
}

}  // namespace
}  // namespace aftershade::tests
