#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "app/compared_frames.h"
#include "app/frame_notes.h"
#include "app/log.h"
#include "app/signals.h"
#include "core/base/error.h"
#include "core/base/memory_limit.h"
#include "core/base/text.h"
#include "core/io/publish.h"
#include "core/parallel/rows.h"
#include "core/preview/picture.h"

namespace aftershade::app {

namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw Error(ErrorCode::cannot_create, cat("cannot make the folder ", folder.string(), ": ", error.message()));
}

/// What every preset writes, if frames are written.
struct Files {
  std::vector<std::unique_ptr<io::FileSink>> sinks;

  Files(const CompareJob& job, FrameNotes& notes) {
    for (const Contender& contender : job.contenders) {
      sinks.emplace_back();
      if (!contender.output_path) continue;
      make_folder(fs::path(contender.output_path(job.frames.front())).parent_path());
      io::SinkOptions options;
      options.path = contender.output_path;
      options.on_note = [&notes](int frame, const std::string& text) {
        notes.add(frame, [text] { log().note(text); });
      };
      sinks.back() = std::make_unique<io::FileSink>(job.input.found.sequence, std::move(options));
    }
  }
};

void log_result(const pipeline::Progress& progress, const Contender& contender) {
  for (const pipeline::FrameReport& report : progress.reports) {
    for (const std::string& text : report.notes) log().note(cat(contender.preset.name, ": ", text));
    for (const std::string& text : report.warnings)
      log().warning(cat("frame ", progress.number, ": ", contender.preset.name, ": ", text));
    std::string times = cat("frame ", progress.number, ": ", contender.preset.name, ": ");
    for (const auto& time : report.times) times += cat(time.id, " ", fixed(time.milliseconds, 1), " ms  ");
    log().detail(times);
  }
}

/// Runs all presets over the frames.
void run_all(CompareJob& job, const CompareArgs& args, ComparedFrames& compared) {
  FrameNotes written;
  const Files files(job, written);
  std::vector<std::unique_ptr<FrameSink>> sinks;
  std::vector<pipeline::Program> programs;
  for (size_t i = 0; i < job.contenders.size(); ++i) {
    sinks.push_back(compared.sink(i, files.sinks[i].get()));
    programs.push_back({job.contenders[i].views, *sinks.back()});
  }
  ProgressPrinter progress(progress_kind(args.progress, args.quiet));
  double frame_ms = 0;
  pipeline::RunOptions run;
  run.written = job.frames;
  run.on_disk = job.input.found.sequence.frames();
  run.preroll = job.preroll;
  run.measure = job.measure;
  run.frames_in_flight = thread_count() == 1 ? 1 : 3;
  run.on_progress = [&](const pipeline::Progress& p) {
    written.say(p.number);
    log_result(p, job.contenders[p.program]);
    compared.add_cost(p);
    frame_ms += p.milliseconds;
    const size_t presets = job.contenders.size();
    if (p.written && p.done % presets == 0)
      progress.update(p.number, p.done / presets, p.total / presets, std::exchange(frame_ms, 0.0));
  };
  run.should_stop = [] { return stop_signal() != 0; };
  const GracefulStop graceful;
  pipeline::run(programs, compared.source(), run);
  progress.finish();
  log().summarise();
}

void write_text(const fs::path& path, const std::string& text) {
  io::publish({text.data(), text.size()}, path.string());
}

void write_reports(const report::Comparison& comparison, const CompareArgs& args, int64_t page_budget) {
  const fs::path folder(args.output);
  std::error_code none_there;
  fs::remove(folder / "report.html", none_there);  // a page of other results must not stand beside these
  write_text(folder / "report.json", report::json_text(comparison));
  write_text(folder / "report.csv", report::csv_text(comparison));
  if (args.no_report) return;
  std::vector<std::string> notes;
  write_text(folder / "report.html", report::page_text(comparison, static_cast<size_t>(page_budget), notes));
  for (const std::string& note : notes) log().note(note);
}

double sum_of(const std::vector<report::StageCost>& cost) {
  double sum = 0;
  for (const report::StageCost& stage : cost) sum += stage.milliseconds;
  return sum;
}

/// A line a preset on stdout: the scores that most people ask for first, and the cost.
void print_summary(const report::Comparison& comparison) {
  std::vector<std::string> columns;
  const auto add = [&](std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names)
      if (std::find(comparison.metrics.begin(), comparison.metrics.end(), name) != comparison.metrics.end())
        columns.emplace_back(name);
  };
  add({"psnr", "ssim", "ldr_flip", "ao_rmse", "ao_correlation"});
  if (columns.empty()) add({"flicker_unstable", "ao_flicker_unstable"});  // without a reference
  const bool cost = !comparison.candidates.front().cost.empty();
  if (columns.empty() && !cost) return;
  size_t width = 6;
  for (const report::Candidate& candidate : comparison.candidates)
    width = std::max(width, candidate.preset.name.size());
  std::printf("%-*s", static_cast<int>(width), "preset");
  for (const std::string& column : columns) std::printf("  %9s", column.c_str());
  std::printf("%s\n", cost ? "   ms/frame         MB" : "");
  for (const report::Candidate& candidate : comparison.candidates) {
    std::printf("%-*s", static_cast<int>(width), candidate.preset.name.c_str());
    for (const std::string& column : columns) {
      const auto score = candidate.sequence.find(column);
      const int field = static_cast<int>(std::max<size_t>(9, column.size()));
      if (score == candidate.sequence.end() || std::isnan(score->second))
        std::printf("  %*s", field, "-");
      else
        std::printf("  %*.*f", field, column == "psnr" ? 2 : 4, score->second);
    }
    if (cost) std::printf("  %9.1f  %9.1f", sum_of(candidate.cost), static_cast<double>(candidate.memory_bytes) / 1e6);
    std::printf("\n");
  }
}

int64_t page_budget_of(const std::string& text) {
  const auto size = parse_size(text);
  if (!size)
    throw Error(ErrorCode::usage, "--page-budget " + text + " is no size", "a number with K, M or G, such as 24M");
  if (*size < (1 << 20))
    throw Error(ErrorCode::usage, "--page-budget " + text + " is too little for any page", "1M or more");
  return *size;
}

}  // namespace

int compare(const CompareArgs& args) {
  const int64_t page_budget = page_budget_of(args.page_budget);
  CompareJob job = resolve_comparison(args);
  report::ShowOptions show;
  show.display = {args.ocio, args.view_transform};
  show.has_reference = !job.reference_text.empty();
  show.pixel_aspect = job.input.source->info().pixel_aspect;
  const std::string view_transform = job.pictures ? preview::view_name(show.display) : "";
  log().note(cat(job.input.found.pattern.text(), ": profile ", job.input.producer.profile.name, " (",
                 job.input.producer.why, "), ", job.compared, job.compared == 1 ? " preset" : " presets", ", frames ",
                 io::format_frames(job.frames)));
  make_folder(args.output);
  ComparedFrames compared(job, show);
  std::exception_ptr failure;
  try {
    run_all(job, args, compared);
  } catch (const Error&) {
    failure = std::current_exception();  // the reports are of the frames before
  }
  report::Comparison comparison = compared.take();
  if (comparison.frames.empty()) {
    if (failure) std::rethrow_exception(failure);
    end_by_signal(stop_signal());
  }
  if (comparison.frames.size() < job.frames.size())
    comparison.notes.push_back(cat(stop_signal() != 0 ? "stopped by a signal" : "ended by an error",
                                   ": the reports are of ", comparison.frames.size(), " of ", job.frames.size(),
                                   " frames"));
  comparison.program = "aftershade " AFTERSHADE_VERSION;
  comparison.view_transform = view_transform;
  comparison.threads = thread_count();
  write_reports(comparison, args, page_budget);
  if (compared.sheet() != nullptr) {
    const std::string note = compared.sheet()->write((fs::path(args.output) / "sheet.png").string());
    if (!note.empty()) log().note(note);
  }
  print_summary(comparison);
  for (const std::string& note : comparison.notes) log().note(note);
  if (failure) std::rethrow_exception(failure);
  if (stop_signal() != 0) end_by_signal(stop_signal());
  return 0;
}

}  // namespace aftershade::app
