#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/frame.h"
#include "core/pipeline/plan.h"
#include "core/pipeline/stage.h"
#include "core/preset/preset.h"

namespace aftershade::pipeline {

/// What a run adds to the files besides the changed layers.
struct Outputs {
  std::optional<std::string> ao_channel;  ///< name of the channel that receives the AO
  /// False: only added channels are wanted; stages that change layers or named channels are left out.
  bool layers = true;
  WorkOptions work;
};

/// What one frame's way through the stages reports.
struct FrameReport {
  struct StageTime {
    std::string id;
    double milliseconds;
  };
  std::vector<std::string> notes, warnings;
  std::vector<StageTime> times;  ///< with the time it took another preset to make what both use (RunOptions::measure)
  size_t shared_bytes = 0;       ///< memory of what it uses and other presets may use too
};

/// A frame that has gone through all the stages it was planned for, or up to the one that failed.
struct FinishedFrame {
  Frame frame;
  bool written;
  FrameReport report;
  std::optional<Error> error;  ///< names the frame
};

/// The stages of a preset at work on one view, frame after frame. A stage that looks ahead holds frames back until it
/// has seen their neighbours, so frames come out later than they go in; those to be written in the same order, except
/// that one that fails comes out at once.
class ViewPipeline {
 public:
  /// Checks every stage's needs against what the view offers. Throws Error(no_input) naming stage and role that is
  /// missing, Error(config) for an order of stages that cannot work (apply before AO, AO not at full resolution).
  ViewPipeline(const preset::Preset& preset, std::string view, const Offer& offer, const Outputs& outputs);

  const std::string& view() const { return view_; }
  size_t stages() const { return stages_.size(); }
  bool makes_ao() const { return makes_ao_; }  ///< at full resolution: Outputs::ao_channel can have it
  std::vector<Dependency> dependencies() const;  ///< in stage order
  RoleSet roles(size_t through) const;           ///< to load of a frame that goes `through` (PlannedFrame)
  bool layers(size_t through) const;             ///< does it need its layers?
  RoleSet previous_roles() const;                ///< to load of the frame before it

  /// Feeds the next frame. A failing stage's Error is in its FinishedFrame; no history and no window of a stage that
  /// the frame does not reach extends over it, all others are as without the failure.
  void push(Frame frame, std::optional<Frame> previous, const PlannedFrame& planned);
  /// Nothing follows: completes the frames that wait, and forgets all history.
  void flush();
  /// The frames completed since the last call.
  std::vector<FinishedFrame> take_finished() { return std::exchange(finished_, {}); }

 private:
  struct Item;
  using ItemPtr = std::unique_ptr<Item>;
  struct Entry {
    std::string id;
    std::unique_ptr<Stage> stage;
    Needs needs;
    std::deque<ItemPtr> waiting;  ///< seen by the stage, which has not run on them yet
  };
  bool sees(size_t stage, size_t through) const;
  /// Completes the frames that wait at stage `first` or later, and forgets these stages' history.
  void settle(size_t first);
  /// A failure ends the frame's way: the stages from `blind` on never see it. False then.
  bool attempt(Item& item, size_t blind, const std::function<void()>& work);
  bool run_stage(size_t stage, Item& item);
  void advance(ItemPtr item, size_t first);
  void halt(ItemPtr item, size_t stage);
  void release(size_t stage);
  void finish(Item& item);

  std::string view_;
  Outputs outputs_;
  std::vector<Entry> stages_;
  std::vector<FinishedFrame> finished_;
  std::optional<Window> display_before_;
  bool makes_ao_ = false;

 public:  // movable, with Item complete only in the source file
  ~ViewPipeline();
  ViewPipeline(ViewPipeline&&) noexcept;
  ViewPipeline& operator=(ViewPipeline&&) noexcept;
};

/// A preset at work: its stages on every view of the sequence (all programs of a run have the same views), and where
/// its frames go.
struct Program {
  std::vector<ViewPipeline>& views;
  FrameSink& sink;
};

/// What a run tells its caller, frame by frame.
struct Progress {
  int number;
  bool written;
  size_t done, total;                ///< frames written so far, and in all; those of all programs count
  double milliseconds;               ///< since this was told of the last frame
  std::vector<FrameReport> reports;  ///< one a view
  size_t program = 0;
  double read_milliseconds = 0;  ///< what reading and decoding the frame took, for all programs at once
  /// RunOptions::measure: the most planes the program had at once so far, in bytes: its own, those of the frames that
  /// its stages hold back, and what it shares with others.
  size_t memory_bytes = 0;
};

struct RunOptions {
  std::vector<int> written;  ///< frames to write, sorted
  std::vector<int> on_disk;  ///< all frames there are, sorted
  int preroll = 40;          ///< (8/9)^40 = 0.9 % of an older history's weight is left
  bool keep_going = false;   ///< a frame that fails is reported and the run goes on without it
  /// How many frames may be in memory at once, besides those that stages hold back: 1 reads, computes and writes one
  /// after the other, 3 reads the next frame and writes the last one while one is computed. Changes no result.
  size_t frames_in_flight = 3;
  bool measure = false;  ///< times and memory are to be compared: nothing goes on beside a stage
  std::function<void(const Progress&)> on_progress;
  std::function<void(const Error&)> on_error;  ///< with keep_going, for each failed frame, which the error names
  std::function<void(int)> on_loaded;  ///< a frame was read, or failed to be: before anything else is told of it
  std::function<bool()> should_stop;   ///< asked before every frame is computed; all before it will be written
};

/// The frame loop: plans, loads, filters and writes. Returns the number of frames written. load() and write() are
/// called on any thread, both at the same time, but each for one frame after the other, in order. Stages see the frames
/// in order, on the caller's thread, where `options`' functions are called too, in an order that depends on the frames
/// alone. Without keep_going the first failure leaves as it is, once the frames before it are written.
///
/// Several programs run side by side: a frame is read once, with all that any of them wants of it, and goes through one
/// after the other, which shares what does not depend on the preset (Geometry). Every program gets what it would get
/// alone, to the bit. The program that a frame begins with changes from
/// frame to frame, so that a machine that is busy for a while treats them alike.
size_t run(std::span<const Program> programs, FrameSource& source, const RunOptions& options);
/// One program.
size_t run(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const RunOptions& options);

}  // namespace aftershade::pipeline
