#include <cstdio>

#include "app/frame_notes.h"
#include "app/job.h"
#include "app/log.h"
#include "app/signals.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::app {

namespace {

void print_config(const preset::Resolved& resolved) {
  std::printf("preset: %s\n", resolved.preset.name.c_str());
  for (const preset::StageDescription& stage : resolved.preset.stages) {
    std::printf("%s: %s\n", stage.id.c_str(), std::string(preset::method_of(stage.params)).c_str());
    const auto& table = preset::table_of(stage.params);
    const void* params = preset::values_of(stage.params);
    for (const params::Record& record : table) {
      const std::string key = stage.id + "." + record.key;
      const auto origin = resolved.origins.find(key);
      std::printf("  %s = %s  [%s]\n", key.c_str(), record.get(params).dump().c_str(),
                  origin == resolved.origins.end() ? "default" : origin->second.c_str());
    }
  }
}

void print_plan(const Job& job) {
  for (const int frame : job.written)
    std::printf("%s -> %s\n", job.input.found.sequence.path(frame)->c_str(), job.output_path(frame).c_str());
}

void log_result(const pipeline::Progress& progress, const std::vector<pipeline::ViewPipeline>& views) {
  for (size_t i = 0; i < progress.reports.size(); ++i) {
    const std::string view = views[i].view().empty() ? "" : "view " + views[i].view() + ": ";
    for (const std::string& text : progress.reports[i].notes) log().note(view + text);
    for (const std::string& text : progress.reports[i].warnings)
      log().warning(cat("frame ", progress.number, ": ", view, text));
    if (!log().verbose()) continue;
    std::string times = cat("frame ", progress.number, progress.written ? ": " : " (preroll): ", view);
    for (const auto& time : progress.reports[i].times) times += cat(time.id, " ", fixed(time.milliseconds, 1), " ms  ");
    log().detail(times);
  }
}

void log_nan(int frame, const io::NanReport& report) {
  for (const auto& [kind, counts] : {std::pair{"NaN", &report.nan}, {"infinite", &report.infinite}})
    for (const auto& [channel, count] : *counts)
      log().warning(cat("frame ", frame, ": channel ", channel, " has ", count, " ", kind,
                        " pixels: kept out of filters and history"));
}

int run_job(Job& job, const RenderArgs& args) {
  io::SinkOptions sink_options;
  sink_options.write = job.write;
  sink_options.path = job.output_path;
  FrameNotes read, written;
  sink_options.on_note = [&](int frame, const std::string& text) { written.add(frame, [text] { log().note(text); }); };
  io::FileSink sink(job.input.found.sequence, std::move(sink_options));
  job.input.source->on_nan = [&](int frame, const io::NanReport& report) {
    read.add(frame, [frame, report] { log_nan(frame, report); });
  };
  job.input.source->on_note = [&read, say = job.input.source->on_note](int frame, const std::string& text) {
    read.add(frame, [say, frame, text] { say(frame, text); });
  };

  ProgressPrinter progress(progress_kind(args.progress, args.quiet));
  int status = 0;
  pipeline::RunOptions run;
  run.written = job.written;
  run.on_disk = job.input.found.sequence.frames();
  run.preroll = job.preroll;
  run.keep_going = args.keep_going;
  run.frames_in_flight = job.frames_in_flight;
  run.on_loaded = [&](int frame) { read.say(frame); };
  run.on_progress = [&](const pipeline::Progress& p) {
    written.say(p.number);
    log_result(p, job.views);
    if (p.written) progress.update(p.number, p.done, p.total, p.milliseconds);
  };
  run.on_error = [&](const Error& error) {
    log().error(error.what());
    if (status == 0) status = exit_status(error.code());
  };
  run.should_stop = [] { return stop_signal() != 0; };
  const size_t complete = [&] {
    const GracefulStop graceful;
    return pipeline::run(job.views, *job.input.source, sink, run);
  }();
  progress.finish();
  log().summarise();
  if (stop_signal() != 0) {
    log().note(cat("stopped by a signal: ", complete, " of ", job.written.size(), " frames are complete"));
    end_by_signal(stop_signal());
  }
  return status;
}

}  // namespace

int render(const RenderArgs& args) {
  if (args.print_config && !args.recode) {
    print_config(resolve_preset(args));
    return 0;
  }
  Job job = resolve_job(args);
  log().note(cat(job.input.found.pattern.text(), ": profile ", job.input.producer.profile.name, " (",
                 job.input.producer.why, "), ", args.recode ? "no preset" : "preset " + job.preset.preset.name,
                 ", frames ", io::format_frames(job.written)));
  if (args.dry_run) {
    print_plan(job);
    return 0;
  }
  return run_job(job, args);
}

}  // namespace aftershade::app
