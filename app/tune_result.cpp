#include "app/tune_result.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/base/text.h"

namespace aftershade::app {

namespace {

using params::Json;

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

/// JSON has no numbers that are not finite.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }
Json whole(double value) { return std::isfinite(value) ? Json(std::llround(value)) : Json(); }

Json json_of(const tune::Cost& cost) {
  return {{"milliseconds", number(cost.milliseconds)}, {"bytes", whole(cost.bytes)}};
}

Json parameters_of(const tune::Axes& axes, const std::vector<double>& values) {
  Json out = Json::object();
  for (size_t i = 0; i < axes.size(); ++i)
    out[axes[i].key] = axes[i].integer ? Json(std::llround(values[i])) : Json(values[i]);
  return out;
}

Json json_of(const TuneJob& job, const tune::Candidate& candidate) {
  Json out{{"score", number(candidate.score)}};
  out.update(json_of(candidate.cost));
  out["parameters"] = parameters_of(job.axes, candidate.values);
  return out;
}

Json json_of(const TuneJob& job, const tune::Candidate& candidate, const std::optional<tune::Measured>& measured,
             const std::optional<double>& holdout) {
  Json out = json_of(job, candidate);
  if (holdout) out["holdout_score"] = number(*holdout);
  if (measured) {
    out["measured"] = json_of(measured->cost);
    out["measured"]["spread_milliseconds"] = number(measured->spread_ms);
  }
  return out;
}

Json json_of(const tune::Axes& axes) {
  Json out = Json::array();
  for (const tune::Axis& axis : axes)
    out.push_back({{"key", axis.key}, {"minimum", axis.min}, {"maximum", axis.max}, {"integer", axis.integer}});
  return out;
}

std::string budget_text(const tune::Budget& budget) {
  std::vector<std::string> limits;
  if (std::isfinite(budget.milliseconds)) limits.push_back(cat(budget.milliseconds, " ms"));
  if (std::isfinite(budget.bytes)) limits.push_back(cat(budget.bytes / (1 << 20), " MB"));
  return limits.empty() ? "" : ", within " + join(limits, " and ");
}

std::string score_text(double score) { return fixed(score, std::abs(score) < 10 ? 4 : 2); }
std::string megabytes(double bytes) { return fixed(bytes / (1 << 20), 1); }

/// A line of the summary: name, before, after.
std::string line(const std::string& name, const std::string& before, const std::string& after,
                 const std::string& remark = "") {
  constexpr size_t kName = 28, kValue = 12;
  const auto right = [](const std::string& text) {
    return std::string(text.size() < kValue ? kValue - text.size() : 1, ' ') + text;
  };
  return name + std::string(name.size() < kName ? kName - name.size() : 1, ' ') + right(before) + right(after) +
         (remark.empty() ? "" : "  " + remark) + "\n";
}

std::string cost_lines(const TuneJob& job, const TuneResult& result) {
  const tune::Candidate &start = result.found.start, &best = result.found.best;
  std::string out = line("predicted ms a frame", fixed(start.cost.milliseconds, 2), fixed(best.cost.milliseconds, 2));
  if (!result.best_cost) return out;
  const tune::Cost &start_cost = result.start_cost->cost, &best_cost = result.best_cost->cost;
  const double off = 100 * (best.cost.milliseconds / best_cost.milliseconds - 1);
  out += line("measured ms a frame", fixed(start_cost.milliseconds, 2), fixed(best_cost.milliseconds, 2),
              cat("the prediction is ", fixed(std::abs(off), 1), " % ", off < 0 ? "below" : "above"));
  out += line("predicted MB", megabytes(start.cost.bytes), megabytes(best.cost.bytes));
  out += line("measured MB", megabytes(start_cost.bytes), megabytes(best_cost.bytes));
  if (job.budget.excess(best_cost) > 0)
    out += "What was measured is over the budget: machines are never quite as predicted. A smaller budget keeps it.\n";
  return out;
}

}  // namespace

preset::Preset tuned_preset(const TuneArgs& args, const TuneJob& job, const TuneResult& result) {
  const tune::Candidate &start = result.found.start, &best = result.found.best;
  preset::Preset out = tune::with_values(job.preset, job.stage, job.axes, best.values);
  const std::vector<std::string> changes = preset::difference(job.preset, out);
  const std::string metric(job.trial->setup().metric.name);
  out.description = cat(
      "Preset ", job.preset.name, " with stage ", job.stage, " tuned on frames ", io::format_frames(job.frames), " of ",
      file_name(args.input), " beside ", file_name(args.reference), ": ", metric, " ", score_text(best.score),
      ", before ", score_text(start.score), "; predicted to take ", fixed(best.cost.milliseconds, 2), " ms, before ",
      fixed(start.cost.milliseconds, 2), " ms", budget_text(job.budget), " (", result.table.width, "x",
      result.table.height, ", ", result.table.threads, " threads; ", result.found.evaluations, " evaluations, seed ",
      args.seed, "). ", changes.empty() ? "Nothing changed" : "Changed: " + join(changes, ", "), ". ", job.preset.name,
      " is: ", job.preset.description);
  return out;
}

Json front_json(const TuneArgs& args, const TuneJob& job, const TuneResult& result) {
  const tune::Found& found = result.found;
  const metrics::MetricInfo& metric = job.trial->setup().metric;
  Json front = Json::array();
  for (const tune::Candidate& candidate : found.front) front.push_back(json_of(job, candidate));
  return {{"program", "aftershade " AFTERSHADE_VERSION},
          {"input", file_name(args.input)},
          {"reference", file_name(args.reference)},
          {"frames", job.frames},
          {"holdout", job.holdout},
          {"preset", job.preset.name},
          {"stage", job.stage},
          {"metric", metric.name},
          {"better", metric.better == metrics::Better::zero     ? "zero"
                     : metric.better == metrics::Better::higher ? "higher"
                                                                : "lower"},
          {"budget", json_of(tune::Cost{job.budget.milliseconds, job.budget.bytes})},
          {"seed", args.seed},
          {"evaluations", found.evaluations},
          {"searched", json_of(job.axes)},
          {"without_influence", found.idle},
          {"start", json_of(job, found.start, result.start_cost, result.start_holdout)},
          {"found", json_of(job, found.best, result.best_cost, result.best_holdout)},
          {"front", std::move(front)},
          {"cost_table", to_json(result.table)}};
}

std::string summary_of(const TuneJob& job, const TuneResult& result) {
  const tune::Candidate &start = result.found.start, &best = result.found.best;
  const std::string metric(job.trial->setup().metric.name);
  std::string out = line("", "before", "after");
  out += line(metric, score_text(start.score), score_text(best.score));
  if (result.best_holdout)
    out += line(metric + ", held out", score_text(*result.start_holdout), score_text(*result.best_holdout));
  out += cost_lines(job, result);
  for (size_t i = 0; i < job.axes.size(); ++i) {
    const bool idle = std::ranges::find(result.found.idle, job.axes[i].key) != result.found.idle.end();
    out += line(job.stage + "." + job.axes[i].key, cat(start.values[i]), cat(best.values[i]),
                idle ? "without influence here" : "");
  }
  return out;
}

}  // namespace aftershade::app
