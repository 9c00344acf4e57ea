#pragma once
#include <functional>
#include <memory>
#include <optional>
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
  bool layers = true;  ///< false: only added channels are wanted, stages that change layers are left out
  WorkOptions work;
};

/// The stages of a preset at work on one view, frame after frame.
class ViewPipeline {
 public:
  /// Checks every stage's needs against what the view offers. Throws Error(no_input) naming stage and role that is
  /// missing, Error(config) for an order of stages that cannot work (apply before AO, AO not at full resolution).
  ViewPipeline(const preset::Preset& preset, std::string view, const Offer& offer, const Outputs& outputs);

  const std::string& view() const { return view_; }
  bool recursive() const { return last_recursive_ >= 0; }
  bool changes_layers() const;
  RoleSet roles(bool written) const;  ///< to load of the frame itself
  RoleSet previous_roles() const;     ///< to load of the frame before it

  struct StageTime {
    std::string id;
    double milliseconds;
  };
  struct Result {
    std::vector<std::string> notes, warnings;
    std::vector<StageTime> times;
  };
  /// Runs the stages over `frame` in place; a frame that is not written only feeds the history.
  Result run(Frame& frame, const Frame* previous, bool written, bool restart);

 private:
  struct Entry {
    std::string id;
    std::unique_ptr<Stage> stage;
    Needs needs;
  };
  std::string view_;
  Outputs outputs_;
  std::vector<Entry> stages_;
  int last_recursive_ = -1;  ///< index of the last stage with history, or -1
  std::optional<Window> display_before_;
};

/// What a run tells its caller, frame by frame.
struct Progress {
  int number;
  bool written;
  size_t done, total;  ///< written frames so far, and in all
  double milliseconds;
  std::vector<ViewPipeline::Result> results;  ///< one a view
};

struct RunOptions {
  std::vector<int> written;  ///< frames to write, sorted
  std::vector<int> on_disk;  ///< all frames there are, sorted
  int preroll = 40;          ///< (8/9)^40 = 0.9 % of an older history's weight is left
  bool keep_going = false;   ///< a frame that fails is reported and the run goes on without it
  std::function<void(const Progress&)> on_progress;
  std::function<void(int frame, const Error&)> on_error;  ///< with keep_going, for each failed frame
  std::function<bool()> should_stop;                      ///< asked before every frame
};

/// The frame loop: plans, loads, filters and writes. Returns the number of frames written.
size_t run(std::vector<ViewPipeline>& views, FrameSource& source, FrameSink& sink, const RunOptions& options);

}  // namespace aftershade::pipeline
