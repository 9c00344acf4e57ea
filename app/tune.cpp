#include <cmath>
#include <cstdio>

#include "app/log.h"
#include "app/signals.h"
#include "app/tune_result.h"
#include "core/base/error.h"
#include "core/base/memory_limit.h"
#include "core/base/text.h"
#include "core/io/publish.h"

namespace aftershade::app {

namespace {

/// How far the search is: a line that changes on a terminal, elsewhere a line for each improvement.
class TuneProgress {
 public:
  TuneProgress(const TuneArgs& args, const TuneJob& job)
      : kind_(progress_kind("auto", args.quiet)), evaluations_(args.evaluations), job_(job) {}
  ~TuneProgress() { log().end_status(); }

  void round(int done) const { say(cat("costs: ", done, " rounds are measured"), false); }

  void evaluated(const tune::Candidate& candidate, int count, bool best) {
    if (best) best_ = candidate;
    say(cat("evaluation ", count, " of ", evaluations_, ": best ", job_.trial->setup().metric.name, " ",
            fixed(best_.score, 4), " for ", fixed(best_.cost.milliseconds, 2), " ms"),
        best);
  }

 private:
  void say(const std::string& text, bool important) const {
    if (kind_ == ProgressPrinter::Kind::bar) log().status_line(text);
    if (kind_ == ProgressPrinter::Kind::plain && important) log().line(text);
  }
  ProgressPrinter::Kind kind_;
  int evaluations_;
  const TuneJob& job_;
  tune::Candidate best_;
};

[[noreturn]] void fail_budget(const TuneJob& job, const tune::Cost& cheapest, const std::string& at) {
  const tune::Budget& budget = job.budget;
  std::vector<std::string> wanted, least;
  if (std::isfinite(budget.milliseconds)) {
    wanted.push_back(cat(budget.milliseconds, " ms"));
    least.push_back(fixed(cheapest.milliseconds, 2) + " ms");
  }
  if (std::isfinite(budget.bytes)) {
    wanted.push_back(cat(budget.bytes / (1 << 20), " MB"));
    least.push_back(fixed(cheapest.bytes / (1 << 20), 1) + " MB");
  }
  throw Error(ErrorCode::usage,
              cat("no setting of stage ", job.stage, " is within ", join(wanted, " and "), ": the cheapest needs ",
                  join(least, " and "), at),
              "raise the budget, search more --parameters or wider ranges, or start from a cheaper preset");
}

std::string values_text(const TuneJob& job, const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (size_t i = 0; i < values.size(); ++i) texts.push_back(cat(job.axes[i].key, " ", values[i]));
  return " (" + join(texts, ", ") + ")";
}

void stop_if_asked() {
  if (stop_signal() == 0) return;
  log().note("stopped by a signal before anything was found");
  end_by_signal(stop_signal());
}

tune::CostTable table_for(const TuneArgs& args, const TuneJob& job, const TuneProgress& progress) {
  if (!args.cost_table.empty()) return read_cost_table(args.cost_table, job);
  const int frame = job.measured_frame();
  const tune::Subject subject{job.preset, job.stage, job.axes, frame};
  log().note(cat("measuring what stage ", job.stage, " costs"));
  tune::CostTable blank = tune::blank_table(subject, *job.source->load(frame, job.trial->setup().view, {}, false));
  blank.program = "aftershade " AFTERSHADE_VERSION;
  auto table = tune::measure_table(*job.trial, subject, std::move(blank), [&](int done) { progress.round(done); });
  if (!table) stop_if_asked();
  return std::move(*table);
}

tune::Found search(const TuneArgs& args, const TuneJob& job, const tune::CostTable& table, TuneProgress& progress) {
  tune::Problem problem;
  problem.axes = job.axes;
  problem.start = tune::values_of(job.preset, job.stage, job.axes);
  problem.better = job.trial->setup().metric.better;
  problem.score = [&](const std::vector<double>& values) {
    return job.trial->score(tune::with_values(job.preset, job.stage, job.axes, values), job.targets);
  };
  problem.cost = [&](const std::vector<double>& values) {
    std::map<std::string, double> named;
    for (size_t i = 0; i < values.size(); ++i) named[job.axes[i].key] = values[i];
    return table.predict(named);
  };
  tune::SearchOptions options;
  options.budget = job.budget;
  options.evaluations = args.evaluations;
  options.seed = static_cast<uint64_t>(args.seed);
  options.should_stop = job.trial->setup().should_stop;
  options.on_evaluated = [&](const tune::Candidate& candidate, int count, bool best) {
    progress.evaluated(candidate, count, best);
    if (count > 1 || !std::isnan(candidate.score)) return;
    stop_if_asked();
    const metrics::MetricInfo& metric = job.trial->setup().metric;
    throw Error(ErrorCode::data, cat("there is nothing on these frames that ", metric.name, " could score"),
                metric.temporal ? "it looks at frames that follow each other: choose such with --frames"
                                : "look at --mask and at the reference");
  };
  return tune::search(problem, options);
}

/// The start and the best once more, on the frames that were held out and on the clock.
void verify(const TuneJob& job, TuneResult& result) {
  const preset::Preset best = tune::with_values(job.preset, job.stage, job.axes, result.found.best.values);
  if (!job.holdout.empty()) {
    result.start_holdout = job.trial->score(job.preset, job.holdout_targets);
    result.best_holdout = job.trial->score(best, job.holdout_targets);
  }
  const auto measured =
      tune::measure_in_turn(*job.trial, {job.preset, best}, job.stage, job.measured_frame(), [](int) {});
  if (measured) result.start_cost = measured->front(), result.best_cost = measured->back();
  if (stop_signal() != 0) result.start_holdout = result.best_holdout = {};
}

void write(const TuneArgs& args, const TuneJob& job, const TuneResult& result) {
  const std::string preset = preset::to_json(tuned_preset(args, job, result)).dump(2) + "\n";
  const std::string front = front_json(args, job, result).dump(2) + "\n";
  io::publish(preset, job.output);
  io::publish(front, job.front_output);
  log().note(cat(job.output, ": the preset; ", job.front_output, ": ", result.found.front.size(),
                 " trade-offs of score and cost"));
}

}  // namespace

int tune(const TuneArgs& args) {
  const GracefulStop graceful;
  const TuneJob job = resolve_tune(args);
  TuneResult result;
  {
    TuneProgress progress(args, job);
    result.table = table_for(args, job, progress);
    const tune::Cost cheapest = result.table.cheapest();
    if (job.budget.excess(cheapest) > 0) fail_budget(job, cheapest, "");
    result.found = search(args, job, result.table, progress);
  }
  const tune::Found& found = result.found;
  if (!found.within_budget) {
    stop_if_asked();
    fail_budget(job, found.best.cost, values_text(job, found.best.values));
  }
  if (stop_signal() == 0) verify(job, result);
  write(args, job, result);
  if (stop_signal() != 0) {
    log().note(cat("stopped by a signal after ", found.evaluations, " evaluations: the best so far is written"));
    end_by_signal(stop_signal());
  }
  std::printf("%s", summary_of(job, result).c_str());
  return 0;
}

}  // namespace aftershade::app
