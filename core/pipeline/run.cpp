#include <chrono>
#include <map>

#include "core/base/error.h"
#include "core/pipeline/read_ahead.h"

namespace aftershade::pipeline {

namespace {

/// One run over the planned frames: reads the next frame while one is pushed through every view, and writes what all
/// views have finished meanwhile. More frames at once would gain nothing, since each of the three works in parallel
/// inside. One thread, the caller's, pushes, and tells the caller everything in the order of the frames, whenever
/// reading and writing happen to end: of a frame first what was noticed in reading it, then that it is written.
class Run {
 public:
  Run(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const RunOptions& options)
      : views_(views),
        sink_(sink),
        options_(options),
        planned_(plan(options.written, options.on_disk, views.front().stages(),  // all views have the same stages
                      views.front().dependencies(), options.preroll)),
        previous_(views.size()),
        source_(views, source, planned_) {}

  size_t go() {
    bool follows = true;
    for (PlannedFrame planned : planned_) {
      if (options_.should_stop && options_.should_stop()) {
        settle();
        return done_;
      }
      planned.restarts = planned.restarts || !follows;
      follows = visit(planned);
      write_finished();
    }
    finish_what_came_before();
    return done_;
  }

 private:
  struct Writing {
    Progress progress;
    std::vector<Frame> frames;
    std::optional<Background> task;
  };

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

  /// Frames that this run keeps in memory, those aside that stages hold back.
  size_t in_flight() const { return (source_.has_begun() ? 1 : 0) + (computing_ ? 1 : 0) + (writing_ ? 1 : 0); }

  void read_ahead() {
    if (!source_.at_end() && !source_.has_begun() && in_flight() < options_.frames_in_flight) source_.begin();
  }

  LoadedFrame next_frame() {
    if (!source_.has_begun()) {
      if (in_flight() >= options_.frames_in_flight) settle();
      source_.begin();
    }
    return source_.take();
  }

  /// False: the frame could not be read, and nothing of it goes on its way.
  bool visit(const PlannedFrame& planned) {
    LoadedFrame loaded = next_frame();
    computing_ = true;
    read_ahead();
    if (!loaded.failure) undisturbed([&] { push(loaded, planned); });
    settle();
    if (options_.on_loaded) options_.on_loaded(planned.number);
    read_ahead();
    computing_ = false;
    return attempt([&] {
      if (!loaded.failure) return;
      if (!options_.keep_going && planned.restarts) finish_what_came_before();
      std::rethrow_exception(loaded.failure);
    });
  }

  void push(LoadedFrame& loaded, const PlannedFrame& planned) {
    for (size_t i = 0; i < views_.size(); ++i) {
      if (planned.restarts) previous_[i].reset();
      views_[i].push(std::move(loaded.views[i]), std::exchange(previous_[i], std::move(loaded.for_next[i])), planned);
    }
  }

  /// Frames that wait for neighbours do not wait for those behind a gap, or the end.
  void finish_what_came_before() {
    undisturbed([&] {
      for (ViewPipeline& view : views_) view.flush();
    });
    write_finished();
    settle();
  }

  /// A frame is written once all its views are finished. Source and sink name the frame in their own errors.
  void write_finished() {
    for (ViewPipeline& view : views_)
      for (FinishedFrame& finished : view.take_finished())
        pending_[finished.frame.number].push_back(std::move(finished));
    while (!pending_.empty() && pending_.begin()->second.size() == views_.size()) {
      auto node = pending_.extract(pending_.begin());
      settle();
      attempt([&] { begin_writing(node.key(), std::move(node.mapped())); });
    }
  }

  void begin_writing(int number, std::vector<FinishedFrame> views) {
    auto writing = std::make_unique<Writing>();
    writing->progress = {number, views.front().written, done_, options_.written.size(), 0, {}};
    for (FinishedFrame& view : views) {
      if (view.error) throw Error(*view.error);
      for (auto& planes : view.frame.roles) planes.clear();  // only stages read them
      writing->frames.push_back(std::move(view.frame));
      writing->progress.reports.push_back(std::move(view.report));
    }
    if (!writing->progress.written) return tell(writing->progress);
    writing->task.emplace([this, number, &frames = writing->frames] {
      sink_.write(number, frames);
      frames.clear();
    });
    writing_ = std::move(writing);
    if (options_.frames_in_flight <= 1) settle();
  }

  /// The frame that is being written is complete after this, and the caller knows, or has failed.
  void settle() {
    if (!writing_) return;
    const std::unique_ptr<Writing> writing = std::move(writing_);
    attempt([&] {
      writing->task->wait();
      writing->progress.done = ++done_;
      tell(writing->progress);
    });
  }

  void tell(Progress& progress) {
    const auto now = std::chrono::steady_clock::now();
    progress.milliseconds = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    if (options_.on_progress) options_.on_progress(progress);
  }

  std::vector<ViewPipeline>& views_;
  FrameSink& sink_;
  const RunOptions& options_;
  const std::vector<PlannedFrame> planned_;
  std::vector<std::optional<Frame>> previous_;  ///< one a view: of the frame pushed last
  std::map<int, std::vector<FinishedFrame>> pending_;
  size_t done_ = 0;
  bool computing_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::unique_ptr<Writing> writing_;
  ReadAhead source_;
};

}  // namespace

size_t run(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const RunOptions& options) {
  return Run(views, source, sink, options).go();
}

}  // namespace aftershade::pipeline
