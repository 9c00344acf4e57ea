#include <chrono>
#include <map>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/pipeline/pipeline.h"

namespace aftershade::pipeline {

namespace {

/// One run over the planned frames: loads, pushes through every view, writes what all views have finished.
class Run {
 public:
  Run(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const RunOptions& options)
      : views_(views), source_(source), sink_(sink), options_(options) {}

  size_t go() {
    const ViewPipeline& any = views_.front();  // all views have the same stages
    bool follows = true;
    for (PlannedFrame planned :
         plan(options_.written, options_.on_disk, any.stages(), any.dependencies(), options_.preroll)) {
      if (options_.should_stop && options_.should_stop()) return done_;
      planned.restarts = planned.restarts || !follows;
      follows = attempt([&] { visit(planned); });
      write_finished();
    }
    for (ViewPipeline& view : views_) view.flush();
    write_finished();
    return done_;
  }

 private:
  /// With keep_going a failure is reported and costs its frame alone.
  template <class Work>
  bool attempt(Work&& work) {
    try {
      work();
      return true;
    } catch (const Error& error) {
      if (!options_.keep_going) throw;
      if (options_.on_error) options_.on_error(error);
      return false;
    }
  }

  /// Memory that runs out while a frame is read is its failure, like any other.
  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool layers) {
    try {
      return source_.load(number, view, roles, layers);
    } catch (const std::bad_alloc&) {
      throw Error(ErrorCode::memory, cat("frame ", number, ": out of memory"), "fewer --threads need less");
    }
  }

  /// Nothing of a frame that cannot be read goes on its way.
  void visit(const PlannedFrame& planned) {
    struct Loaded {
      Frame frame;
      std::optional<Frame> previous;
    };
    std::vector<Loaded> loaded;
    for (const ViewPipeline& view : views_) {
      auto frame = load(planned.number, view.view(), view.roles(planned.through), view.layers(planned.through));
      if (!frame) throw Error(ErrorCode::no_input, cat("frame ", planned.number, " is missing"));
      std::optional<Frame> previous;
      if (!planned.restarts && !view.previous_roles().empty())
        previous = load(planned.number - 1, view.view(), view.previous_roles(), false);
      loaded.push_back({std::move(*frame), std::move(previous)});
    }
    for (size_t i = 0; i < views_.size(); ++i)
      views_[i].push(std::move(loaded[i].frame), std::move(loaded[i].previous), planned);
  }

  /// A frame is written once all its views are finished. Source and sink name the frame in their own errors.
  void write_finished() {
    for (ViewPipeline& view : views_)
      for (FinishedFrame& finished : view.take_finished())
        pending_[finished.frame.number].push_back(std::move(finished));
    while (!pending_.empty() && pending_.begin()->second.size() == views_.size()) {
      auto node = pending_.extract(pending_.begin());
      attempt([&] { write(node.key(), std::move(node.mapped())); });
    }
  }

  void write(int number, std::vector<FinishedFrame> views) {
    Progress progress{number, views.front().written, done_, options_.written.size(), 0, {}};
    std::vector<Frame> frames;
    for (FinishedFrame& view : views) {
      if (view.error) throw Error(*view.error);
      frames.push_back(std::move(view.frame));
      progress.reports.push_back(std::move(view.report));
    }
    if (progress.written) {
      sink_.write(number, frames);
      progress.done = ++done_;
    }
    const auto now = std::chrono::steady_clock::now();
    progress.milliseconds = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    if (options_.on_progress) options_.on_progress(progress);
  }

  std::vector<ViewPipeline>& views_;
  FrameSource& source_;
  FrameSink& sink_;
  const RunOptions& options_;
  std::map<int, std::vector<FinishedFrame>> pending_;
  size_t done_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

size_t run(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const RunOptions& options) {
  return Run(views, source, sink, options).go();
}

}  // namespace aftershade::pipeline
