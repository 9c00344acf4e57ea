#include "core/report/json.h"

#include <algorithm>
#include <cmath>

namespace aftershade::report {

using params::Json;

namespace {

/// JSON knows no infinity, but a reader must tell it (equal pictures) from what was not counted.
Json number(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return std::isnan(value) ? Json(nullptr) : Json(value);
}

/// In the order of the comparison's metrics; those that were not computed are left out.
Json scores_of(const metrics::Scores& scores, const std::vector<std::string>& names) {
  Json out = Json::object();
  for (const std::string& name : names)
    if (const auto found = scores.find(name); found != scores.end()) out[name] = number(found->second);
  return out;
}

Json cost_of(const std::vector<StageCost>& cost) {
  if (cost.empty()) return nullptr;
  Json out = Json::array();
  for (const StageCost& stage : cost) out.push_back({{"stage", stage.id}, {"ms", number(stage.milliseconds)}});
  return out;
}

std::string_view text_of(metrics::Better better) {
  switch (better) {
    case metrics::Better::lower:
      return "lower";
    case metrics::Better::higher:
      return "higher";
    case metrics::Better::zero:
      return "zero";
  }
  return "";
}

Json metrics_of(const std::vector<std::string>& names) {
  Json out = Json::array();
  for (const std::string& name : names) {
    const metrics::MetricInfo info = info_of(name);
    out.push_back({{"name", name}, {"unit", info.unit}, {"better", text_of(info.better)}, {"doc", info.doc}});
  }
  return out;
}

Json window_of(Window window) {
  return {{"x", window.min_x}, {"y", window.min_y}, {"width", window.width()}, {"height", window.height()}};
}

Json frames_of(const Candidate& candidate, const std::vector<std::string>& names) {
  Json out = Json::array();
  for (const FrameResult& frame : candidate.frames)
    out.push_back({{"frame", frame.number}, {"scores", scores_of(frame.scores, names)}, {"cost", cost_of(frame.cost)}});
  return out;
}

Json candidate_of(const Candidate& candidate, const std::vector<std::string>& names) {
  return {{"name", candidate.preset.name},
          {"scores", scores_of(candidate.sequence, names)},
          {"cost", cost_of(candidate.cost)},
          {"memory_bytes", candidate.memory_bytes > 0 ? Json(candidate.memory_bytes) : Json(nullptr)},
          {"frames", frames_of(candidate, names)},
          {"preset", preset::to_json(candidate.preset)}};
}

Json shown_of(const std::vector<ShownFrame>& frames) {
  Json out = Json::array();
  for (const ShownFrame& frame : frames)
    out.push_back({{"frame", frame.number}, {"error", number(frame.error)}, {"region", window_of(frame.region)}});
  return out;
}

}  // namespace

metrics::MetricInfo info_of(std::string_view metric) {
  const auto infos = metrics::metric_infos();
  const auto found = std::find_if(infos.begin(), infos.end(), [&](const auto& info) { return info.name == metric; });
  if (found != infos.end()) return *found;
  metrics::MetricInfo unknown{};
  unknown.name = metric;
  return unknown;
}

Json json_of(const Comparison& comparison) {
  Json presets = Json::array();
  for (const Candidate& candidate : comparison.candidates)
    presets.push_back(candidate_of(candidate, comparison.metrics));
  return {{"program", comparison.program},
          {"input", comparison.input},
          {"reference", comparison.reference.empty() ? Json(nullptr) : Json(comparison.reference)},
          {"view_transform", comparison.view_transform},
          {"threads", comparison.threads},
          {"display", window_of(comparison.display)},
          {"frames", comparison.frames},
          {"metrics", metrics_of(comparison.metrics)},
          {"notes", comparison.notes},
          {"presets", std::move(presets)},
          {"shown", shown_of(comparison.shown)}};
}

std::string dumped(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string json_text(const Comparison& comparison) { return dumped(json_of(comparison), 2) + "\n"; }

}  // namespace aftershade::report
