#include "app/score_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/params/table.h"

namespace aftershade::app {

namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double value_in(const metrics::Scores& scores, const std::string& metric) {
  const auto found = scores.find(metric);
  return found == scores.end() ? kNan : found->second;
}

std::string shortly(double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.5g", value);
  return std::isnan(value) ? "nan" : buffer;
}

std::string right(const std::string& text, size_t width) {
  return std::string(width > text.size() ? width - text.size() : 1, ' ') + text;
}

const metrics::MetricInfo& info_of(const std::string& name) {
  const auto infos = metrics::metric_infos();
  return *std::find_if(infos.begin(), infos.end(), [&](const auto& info) { return info.name == name; });
}

/// visit(label, scores) of every frame, then of all.
template <class Visit>
void for_rows_of(const ScoreReport& report, Visit&& visit) {
  for (const auto& [frame, scores] : report.frames) visit(cat(frame), scores);
  visit("all", report.sequence);
}

std::string_view name_of(metrics::Better better) {
  if (better == metrics::Better::zero) return "zero";
  return better == metrics::Better::lower ? "lower" : "higher";
}

params::Json number(double value) { return std::isfinite(value) ? params::Json(value) : params::Json(nullptr); }

params::Json json_of(const ScoreReport& report, const metrics::Scores& scores) {
  params::Json out = params::Json::object();
  for (const std::string& metric : report.metrics) out[metric] = number(value_in(scores, metric));
  return out;
}

/// The frames' values of a requirement's metric, the worst first.
std::vector<std::pair<int, double>> worst_first(const ScoreReport& report, const Requirement& requirement) {
  std::vector<std::pair<int, double>> frames;
  for (const auto& [frame, scores] : report.frames)
    if (scores.contains(requirement.metric)) frames.emplace_back(frame, value_in(scores, requirement.metric));
  const auto badness = [&](double value) {
    if (std::isnan(value)) return std::numeric_limits<double>::infinity();
    return requirement.least ? -value : value;
  };
  std::stable_sort(frames.begin(), frames.end(),
                   [&](const auto& a, const auto& b) { return badness(a.second) > badness(b.second); });
  return frames;
}

/// What is wrong, "" when the requirement is met.
std::string shortfall(const ScoreReport& report, const Requirement& requirement) {
  if (!requirement.of_frames) {
    const double value = report.of_sequence(requirement.metric);
    return requirement.met(value) ? "" : shortly(value);
  }
  const auto frames = worst_first(report, requirement);
  const auto failed =
      std::count_if(frames.begin(), frames.end(), [&](const auto& frame) { return !requirement.met(frame.second); });
  if (frames.empty()) return "no frame has a score";
  return failed == 0 ? "" : cat("by ", failed, " of ", frames.size(), " frames");
}
}  // namespace

bool Requirement::met(double value) const {
  if (least) return strict ? value > bound : value >= bound;
  return strict ? value < bound : value <= bound;
}

Requirement parse_requirement(const std::string& text, bool of_frames) {
  Requirement out;
  out.text = text;
  out.of_frames = of_frames;
  const size_t at = text.find_first_of("<>");
  const size_t end = at == std::string::npos ? at : at + (text.compare(at + 1, 1, "=") == 0 ? 2 : 1);
  const std::optional<double> bound = at == std::string::npos ? std::nullopt : parse_number(text.substr(end));
  if (!bound || std::isnan(*bound) || at == 0)
    throw Error(ErrorCode::usage, cat(of_frames ? "--require-frames " : "--require ", text, " is no requirement"),
                "write it as METRIC>=NUMBER or METRIC<=NUMBER, in quotes, such as 'psnr>=35'");
  out.metric = text.substr(0, at);
  out.least = text[at] == '>';
  out.strict = end == at + 1;
  out.bound = *bound;
  return out;
}

double ScoreReport::of_sequence(const std::string& metric) const { return value_in(sequence, metric); }

std::string table_text(const ScoreReport& report) {
  constexpr size_t kMetricsAcross = 6;
  std::string out;
  for (size_t first = 0; first < report.metrics.size(); first += kMetricsAcross) {
    const auto begin = report.metrics.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<std::string> metrics(
        begin, begin + static_cast<std::ptrdiff_t>(std::min(kMetricsAcross, report.metrics.size() - first)));
    const auto width = [](const std::string& metric) { return std::max<size_t>(metric.size() + 2, 10); };
    out += first > 0 ? "\n" : "";
    out += right("frame", 7);
    for (const std::string& metric : metrics) out += right(metric, width(metric));
    out += "\n";
    for_rows_of(report, [&](const std::string& label, const metrics::Scores& scores) {
      out += right(label, 7);
      for (const std::string& metric : metrics)
        out += right(scores.contains(metric) ? shortly(value_in(scores, metric)) : "-", width(metric));
      out += "\n";
    });
  }
  return out;
}

std::string csv_text(const ScoreReport& report) {
  std::string out = "frame";
  for (const std::string& metric : report.metrics) out += "," + metric;
  for_rows_of(report, [&](const std::string& label, const metrics::Scores& scores) {
    out += "\n" + label;
    for (const std::string& metric : report.metrics) out += cat(",", value_in(scores, metric));
  });
  return out + "\n";
}

std::string json_text(const ScoreReport& report) {
  params::Json json;
  json["result"] = report.result;
  json["reference"] = report.reference;
  json["metrics"] = params::Json::array();
  for (const std::string& name : report.metrics) {
    const metrics::MetricInfo& info = info_of(name);
    json["metrics"].push_back(
        {{"name", name}, {"unit", info.unit}, {"better", name_of(info.better)}, {"doc", info.doc}});
  }
  json["frames"] = params::Json::array();
  for (const auto& [frame, scores] : report.frames)
    json["frames"].push_back({{"frame", frame}, {"scores", json_of(report, scores)}});
  json["sequence"] = json_of(report, report.sequence);
  json["requirements"] = params::Json::array();
  for (const Requirement& requirement : report.requirements)
    json["requirements"].push_back({{"text", requirement.text},
                                    {"of", requirement.of_frames ? "frames" : "sequence"},
                                    {"met", shortfall(report, requirement).empty()}});
  return json.dump(2, ' ', false, params::Json::error_handler_t::replace) + "\n";
}

std::vector<std::string> failures(const ScoreReport& report) {
  constexpr size_t kMost = 3;
  std::vector<std::string> out;
  for (const Requirement& requirement : report.requirements) {
    const std::string wrong = shortfall(report, requirement);
    if (wrong.empty()) continue;
    std::vector<std::string> worst;
    for (const auto& [frame, value] : worst_first(report, requirement))
      if (worst.size() < kMost) worst.push_back(cat(frame, " (", shortly(value), ")"));
    out.push_back(
        cat(requirement.text, " is not met: ", wrong, worst.empty() ? "" : "; worst frames: " + join(worst, ", ")));
  }
  return out;
}

}  // namespace aftershade::app
