#pragma once
#include <memory>
#include <string>
#include <vector>

#include "app/job.h"
#include "core/tune/cost_table.h"
#include "core/tune/trial.h"

/// What aftershade tune will do, resolved from what was typed.
namespace aftershade::app {

/// Everything that a search needs, with the frames read on demand.
struct TuneJob {
  Input input;
  preset::Preset preset;
  std::string stage;
  tune::Axes axes;
  std::vector<int> frames, holdout;
  tune::Budget budget;
  std::unique_ptr<tune::FramesInMemory> source;
  std::unique_ptr<tune::Trial> trial;
  tune::Targets targets, holdout_targets;
  std::string output, front_output;

  int measured_frame() const { return frames[frames.size() / 2]; }
};

/// Throws for everything that is wrong before anything is tried. Reads the reference, or makes it, if it is a preset.
TuneJob resolve_tune(const TuneArgs& args);

/// The costs of --cost-table, if they fit the job. Throws Error(config), Error(no_input).
tune::CostTable read_cost_table(const std::string& path, const TuneJob& job);

/// The stage of `preset`. Throws Error(usage) that lists those there are.
const preset::StageDescription& stage_named(const preset::Preset& preset, const std::string& id);

/// The parameters to search: those that --parameters names ("radius_m,taps=3:30"), or all numbers above 0. Throws
/// Error(usage, config).
tune::Axes axes_of(const preset::StageDescription& stage, const std::vector<std::string>& parameters);

}  // namespace aftershade::app
