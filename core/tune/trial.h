#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/metrics/sequence_scores.h"
#include "core/pipeline/pipeline.h"
#include "core/tune/frames_in_memory.h"
#include "core/tune/search.h"

/// Presets at work on frames in memory: what they score, and what a stage of theirs costs.
namespace aftershade::tune {

/// What is compared of a frame, in its display window; what the metric does not look at is empty.
struct Compared {
  Plane ao;
  std::vector<Plane> color;  ///< red, green, blue, scene-linear
};
/// Of several frames, by number.
using Results = std::map<int, Compared>;

/// What a frame of a result is scored with: the reference, where there is depth, motion and a camera these too, and
/// where to count (empty: everywhere). All planes have the size of the display window.
struct Target {
  Compared truth;
  Plane depth, velocity_x, velocity_y, mask;
  std::optional<Camera> camera;
  int origin_x = 0, origin_y = 0;  ///< corner of the display window
};
using Targets = std::map<int, Target>;

/// The frames that presets are tried on.
struct TrialSetup {
  std::string view;
  pipeline::Offer offer;
  std::vector<int> on_disk;  ///< all that there are, sorted
  int preroll = 2;           ///< frames filtered before each of the scored ones
  metrics::MetricInfo metric;
  std::function<bool()> should_stop;  ///< asked before each frame
};

/// The metric of this name. Throws Error(usage): unknown (with "did you mean").
const metrics::MetricInfo& metric_named(const std::string& name);

/// The roles and layers that trials of `preset` load.
struct Wanted {
  RoleSet roles;
  bool layers = false;
};
Wanted wanted_by(const preset::Preset& preset, const TrialSetup& setup);

class Trial {
 public:
  Trial(TrialSetup setup, FramesInMemory& source) : setup_(std::move(setup)), source_(source) {}

  const TrialSetup& setup() const { return setup_; }

  /// What `preset` makes of the frames, for others to be compared with.
  Results results(const preset::Preset& preset, const std::vector<int>& frames) const;
  /// The score of `preset` over the targets' frames; NaN when stopped midway, or when there is nothing to count.
  double score(const preset::Preset& preset, const Targets& targets) const;

  /// What stage `stage` took for `frame`, behind one frame of history, and the most that planes held until it was done
  /// (those of frames in the stages included). The stages after it are not run.
  Cost cost(const preset::Preset& preset, const std::string& stage, int frame) const;

 private:
  TrialSetup setup_;
  FramesInMemory& source_;
};

}  // namespace aftershade::tune
