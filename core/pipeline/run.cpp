#include <chrono>
#include <new>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/pipeline/pipeline.h"

namespace aftershade::pipeline {

namespace {

Frame load_or_fail(FrameSource& source, int number, const std::string& view, RoleSet roles, bool layers) {
  auto frame = source.load(number, view, roles, layers);
  if (!frame) throw Error(ErrorCode::no_input, cat("frame ", number, " is missing"));
  return std::move(*frame);
}

/// Loads and filters every view of one frame; writes it if it is to be written. Source and sink name the frame in their
/// own errors.
Progress visit(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const PlannedFrame& planned) {
  Progress progress{planned.number, planned.written, 0, 0, 0, {}};
  std::vector<Frame> frames;
  for (ViewPipeline& view : views) {
    if (!planned.written && !view.recursive()) continue;
    Frame frame = load_or_fail(source, planned.number, view.view(), view.roles(planned.written),
                               planned.written && view.changes_layers());
    std::optional<Frame> previous;
    if (!planned.restarts && !view.previous_roles().empty())
      previous = source.load(planned.number - 1, view.view(), view.previous_roles(), false);
    progress.results.push_back(with_context(cat("frame ", planned.number), [&] {
      return view.run(frame, previous ? &*previous : nullptr, planned.written, planned.restarts);
    }));
    frames.push_back(std::move(frame));
  }
  if (planned.written) sink.write(planned.number, frames);
  return progress;
}

/// Memory that runs out is this frame's failure, like any other.
Progress visit_in_memory(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink,
                         const PlannedFrame& planned) {
  try {
    return visit(views, source, sink, planned);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::memory, cat("frame ", planned.number, ": out of memory"), "fewer --threads need less");
  }
}

}  // namespace

size_t run(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const RunOptions& options) {
  bool recursive = false;
  for (const ViewPipeline& view : views) recursive = recursive || view.recursive();
  size_t done = 0;
  bool broken = false;  // the frame before failed: the history cannot go on over it
  for (PlannedFrame planned : plan(options.written, options.on_disk, recursive, options.preroll)) {
    if (options.should_stop && options.should_stop()) break;
    planned.restarts = planned.restarts || broken;
    const auto start = std::chrono::steady_clock::now();
    try {
      Progress progress = visit_in_memory(views, source, sink, planned);
      broken = false;
      done += planned.written ? 1 : 0;
      progress.done = done;
      progress.total = options.written.size();
      progress.milliseconds =
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
      if (options.on_progress) options.on_progress(progress);
    } catch (const Error& error) {
      if (!options.keep_going) throw;
      broken = true;
      if (options.on_error) options.on_error(planned.number, error);
    }
  }
  return done;
}

}  // namespace aftershade::pipeline
