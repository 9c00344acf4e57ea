#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/base/text.h"
#include "core/report/comparison.h"

namespace aftershade::report {

namespace {

/// RFC 4180: quoted where a comma, a quote or a line end would break it, quotes doubled.
std::string field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string field(std::optional<double> value) { return value && !std::isnan(*value) ? cat(*value) : ""; }

std::string line(const std::vector<std::string>& fields) { return join(fields, ",") + "\r\n"; }

/// The stages of all candidates, in order of their first appearance.
std::vector<std::string> stage_ids(const Comparison& comparison) {
  std::vector<std::string> ids;
  const auto add = [&](const std::vector<StageCost>& cost) {
    for (const StageCost& stage : cost)
      if (std::find(ids.begin(), ids.end(), stage.id) == ids.end()) ids.push_back(stage.id);
  };
  for (const Candidate& candidate : comparison.candidates) {
    add(candidate.cost);
    for (const FrameResult& frame : candidate.frames) add(frame.cost);
  }
  return ids;
}

std::optional<double> total_ms(const std::vector<StageCost>& cost) {
  if (cost.empty()) return std::nullopt;
  double sum = 0;
  for (const StageCost& stage : cost) sum += stage.milliseconds;
  return sum;
}

struct Columns {
  std::vector<std::string> metrics, stages;
};

std::vector<std::string> header(const Columns& columns) {
  std::vector<std::string> fields{"preset", "frame"};
  for (const std::string& metric : columns.metrics) fields.push_back(field(metric));
  for (const std::string& stage : columns.stages) fields.push_back(field(stage + "_ms"));
  fields.insert(fields.end(), {"total_ms", "memory_bytes"});
  return fields;
}

std::vector<std::string> row(const Columns& columns, const std::string& preset, const std::string& frame,
                             const metrics::Scores& scores, const std::vector<StageCost>& cost) {
  std::vector<std::string> fields{field(preset), frame};
  for (const std::string& metric : columns.metrics) {
    const auto found = scores.find(metric);
    fields.push_back(field(found == scores.end() ? std::nullopt : std::optional(found->second)));
  }
  for (const std::string& id : columns.stages) {
    const auto found = std::find_if(cost.begin(), cost.end(), [&](const StageCost& stage) { return stage.id == id; });
    fields.push_back(field(found == cost.end() ? std::nullopt : std::optional(found->milliseconds)));
  }
  fields.push_back(field(total_ms(cost)));
  return fields;
}

}  // namespace

std::string csv_text(const Comparison& comparison) {
  const Columns columns{comparison.metrics, stage_ids(comparison)};
  std::string out = line(header(columns));
  for (const Candidate& candidate : comparison.candidates) {
    const std::string& name = candidate.preset.name;
    for (const FrameResult& frame : candidate.frames) {
      auto fields = row(columns, name, cat(frame.number), frame.scores, frame.cost);
      fields.emplace_back();
      out += line(fields);
    }
    auto fields = row(columns, name, "all", candidate.sequence, candidate.cost);
    fields.push_back(candidate.memory_bytes > 0 ? cat(candidate.memory_bytes) : "");
    out += line(fields);
  }
  return out;
}

}  // namespace aftershade::report
