#include <algorithm>
#include <chrono>
#include <map>

#include "core/base/error.h"
#include "core/image/plane_memory.h"
#include "core/pipeline/geometry.h"
#include "core/pipeline/read_ahead.h"

namespace aftershade::pipeline {

namespace {

size_t bytes_of(const std::vector<Plane>& planes) {
  size_t bytes = 0;
  for (const Plane& plane : planes) bytes += sizeof(float) * static_cast<size_t>(plane.width() * plane.height());
  return bytes;
}
size_t bytes_of(const Frame& frame) {
  size_t bytes = 0;
  for (const auto& planes : frame.roles) bytes += bytes_of(planes);
  for (const Layer& layer : frame.layers) bytes += bytes_of(layer.planes);
  return bytes;
}

/// One preset of a run: its plan, its frames that wait for other views, what it costs.
class Lane {
 public:
  Lane(const Program& program, const RunOptions& options)
      : program_(program),
        plan_(plan(options.written, options.on_disk, program.views.front().stages(),  // all views have the same stages
                   program.views.front().dependencies(), options.preroll)) {}

  const std::vector<PlannedFrame>& planned() const { return plan_; }
  FrameSink& sink() const { return program_.sink; }
  size_t memory_bytes() const { return own_->peak + most_frames_bytes_ + most_shared_bytes_; }
  RoleSet previous_roles(size_t view) const { return program_.views[view].previous_roles(); }

  /// What this preset wants of a frame that was loaded for all.
  Frame part_of(Frame frame, size_t view, const PlannedFrame& planned) const {
    const ViewPipeline& stages = program_.views[view];
    return with_only(std::move(frame), stages.roles(planned.through), stages.layers(planned.through));
  }

  void push(size_t view, Frame frame, std::optional<Frame> previous, const PlannedFrame& planned) {
    const OnAccount account(own_);
    inside_bytes_[frame.number] += bytes_of(frame);
    size_t sum = 0;
    for (const auto& [number, bytes] : inside_bytes_) sum += bytes;
    most_frames_bytes_ = std::max(most_frames_bytes_, sum);
    program_.views[view].push(std::move(frame), std::move(previous), planned);
  }

  void flush() {
    const OnAccount account(own_);
    for (ViewPipeline& view : program_.views) view.flush();
  }

  /// The views of the next frame that all views have finished; empty: there is none.
  std::vector<FinishedFrame> next_finished() {
    for (ViewPipeline& view : program_.views)
      for (FinishedFrame& finished : view.take_finished()) {
        most_shared_bytes_ = std::max(most_shared_bytes_, finished.report.shared_bytes);
        pending_[finished.frame.number].push_back(std::move(finished));
      }
    if (pending_.empty() || pending_.begin()->second.size() < program_.views.size()) return {};
    auto node = pending_.extract(pending_.begin());
    inside_bytes_.erase(node.key());
    return std::move(node.mapped());
  }

  bool follows = true;  ///< the last frame could be read

 private:
  Program program_;
  std::vector<PlannedFrame> plan_;
  std::map<int, std::vector<FinishedFrame>> pending_;
  std::shared_ptr<MemoryAccount> own_ = std::make_shared<MemoryAccount>();
  std::map<int, size_t> inside_bytes_;  ///< what the frames in the stages were read as
  size_t most_frames_bytes_ = 0, most_shared_bytes_ = 0;
};

std::vector<Lane> lanes_of(std::span<const Program> programs, const RunOptions& options) {
  std::vector<Lane> lanes;
  for (const Program& program : programs) lanes.emplace_back(program, options);
  return lanes;
}

std::vector<Visit> visits_of(const std::vector<Lane>& lanes) {
  std::vector<std::vector<PlannedFrame>> plans;
  for (const Lane& lane : lanes) plans.push_back(lane.planned());
  return merged(plans);
}

/// One run over the planned frames: reads the next frame while one is pushed through every view, and writes what all
/// views have finished meanwhile. More frames at once would gain nothing, since each of the three works in parallel
/// inside. One thread, the caller's, pushes, and tells the caller everything in the order of the frames, whenever
/// reading and writing happen to end: of a frame first what was noticed in reading it, then that it is written.
class Run {
 public:
  Run(std::span<const Program> programs, FrameSource& source, const RunOptions& options)
      : options_(options),
        frames_in_flight_(options.measure ? 1 : options.frames_in_flight),
        lanes_(lanes_of(programs, options)),
        visits_(visits_of(lanes_)),
        previous_(programs.front().views.size()),
        source_(programs, source, visits_) {}

  size_t go() {
    for (size_t i = 0; i < visits_.size(); ++i) {
      if (options_.should_stop && options_.should_stop()) {
        settle();
        return done_;
      }
      visit(visits_[i], i % lanes_.size());
    }
    for (size_t lane = 0; lane < lanes_.size(); ++lane) finish_what_came_before(lane);
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
    if (!source_.at_end() && !source_.has_begun() && in_flight() < frames_in_flight_) source_.begin();
  }

  LoadedFrame next_frame() {
    if (!source_.has_begun()) {
      if (in_flight() >= frames_in_flight_) settle();
      source_.begin();
    }
    return source_.take();
  }

  /// Every program in turn, the one at `first` first.
  void visit(const Visit& visit, size_t first) {
    LoadedFrame loaded = next_frame();
    read_ms_[visit.number] = loaded.milliseconds;
    std::vector<size_t> turns;
    for (size_t i = 0; i < lanes_.size(); ++i)
      if (const size_t lane = (first + i) % lanes_.size(); visit.programs[lane]) turns.push_back(lane);
    if (turns.size() > 1)
      for (Frame& frame : loaded.views) frame.geometry = std::make_shared<Geometry>();
    for (const size_t lane : turns) {
      PlannedFrame planned = *visit.programs[lane];
      planned.restarts = planned.restarts || !lanes_[lane].follows;
      computing_ = true;
      read_ahead();
      if (!loaded.failure) undisturbed([&] { push(loaded, lane, planned, lane == turns.back()); });
      settle();
      if (lane == turns.front() && options_.on_loaded) options_.on_loaded(visit.number);
      read_ahead();
      computing_ = false;
      if (loaded.failure) break;
      lanes_[lane].follows = true;
      write_finished(lane);
    }
    previous_ = std::move(loaded.for_next);
    if (loaded.failure) fail(loaded.failure, visit);
  }

  /// The frame could not be read, and nothing of it goes on its way.
  void fail(const std::exception_ptr& failure, const Visit& visit) {
    for (size_t lane = 0; lane < lanes_.size(); ++lane) {
      const auto& planned = visit.programs[lane];
      if (!options_.keep_going && (!planned || planned->restarts || !lanes_[lane].follows))
        finish_what_came_before(lane);
      if (planned) lanes_[lane].follows = false;
    }
    attempt([&] { std::rethrow_exception(failure); });
  }

  /// `last`: nobody needs the loaded frame after this program.
  void push(LoadedFrame& loaded, size_t index, const PlannedFrame& planned, bool last) {
    Lane& lane = lanes_[index];
    for (size_t view = 0; view < loaded.views.size(); ++view) {
      std::optional<Frame> previous;
      const RoleSet wanted = lane.previous_roles(view);
      if (!planned.restarts && !wanted.empty() && view < previous_.size() && previous_[view])
        previous = with_only(shared(*previous_[view]), wanted, false);
      Frame frame = last ? std::move(loaded.views[view]) : shared(loaded.views[view]);
      lane.push(view, lane.part_of(std::move(frame), view, planned), std::move(previous), planned);
    }
  }

  /// Frames that wait for neighbours do not wait for those behind a gap, or the end.
  void finish_what_came_before(size_t lane) {
    undisturbed([&] { lanes_[lane].flush(); });
    write_finished(lane);
    settle();
  }

  /// A frame is written once all its views are finished. Source and sink name the frame in their own errors.
  void write_finished(size_t lane) {
    for (auto views = lanes_[lane].next_finished(); !views.empty(); views = lanes_[lane].next_finished()) {
      settle();
      attempt([&] { begin_writing(lane, std::move(views)); });
    }
  }

  void begin_writing(size_t lane, std::vector<FinishedFrame> views) {
    auto writing = std::make_unique<Writing>();
    const int number = views.front().frame.number;
    writing->progress = {number, views.front().written, done_, options_.written.size() * lanes_.size(), 0, {}, lane};
    writing->progress.read_milliseconds = read_ms_[number];
    writing->progress.memory_bytes = lanes_[lane].memory_bytes();
    for (FinishedFrame& view : views) {
      if (view.error) throw Error(*view.error);
      for (auto& planes : view.frame.roles) planes.clear();  // only stages read them
      view.frame.geometry.reset();
      writing->frames.push_back(std::move(view.frame));
      writing->progress.reports.push_back(std::move(view.report));
    }
    if (!writing->progress.written) return tell(writing->progress);
    writing->task.emplace([&sink = lanes_[lane].sink(), number, &frames = writing->frames] {
      sink.write(number, frames);
      frames.clear();
    });
    writing_ = std::move(writing);
    if (frames_in_flight_ <= 1) settle();
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

  const RunOptions& options_;
  const size_t frames_in_flight_;
  std::vector<Lane> lanes_;
  const std::vector<Visit> visits_;
  std::vector<std::optional<Frame>> previous_;  ///< one a view: of the frame visited last
  std::map<int, double> read_ms_;
  size_t done_ = 0;
  bool computing_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::unique_ptr<Writing> writing_;
  ReadAhead source_;
};

}  // namespace

size_t run(std::span<const Program> programs, FrameSource& source, const RunOptions& options) {
  return Run(programs, source, options).go();
}

size_t run(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const RunOptions& options) {
  const Program program{views, sink};
  return run({&program, 1}, source, options);
}

}  // namespace aftershade::pipeline
