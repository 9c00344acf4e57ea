#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/option_table.h"

/// What was typed, per command (not yet what will be done: see app/job.h), and the commands themselves.
namespace aftershade::app {

/// How INPUT becomes canonical frames: shared by render, inspect and sheet.
struct InputArgs {
  std::string input;
  std::string frames;
  std::string hash_digits = "one";
  std::string missing = "error";
  std::vector<std::string> views;
  std::string profile;
  std::vector<std::string> channels, roles;
  std::string depth_kind, unit, camera;
  std::optional<double> near_plane, far_plane, fov_deg;
  std::vector<std::string> ao_layers, blur_layers;
  std::string nan = "keep";
};

inline constexpr const char* kDefaultPreset = "high-dx11";
inline constexpr const char* kDefaultPreroll = "40";

struct PresetArgs {
  std::string preset;  ///< "": kDefaultPreset
  std::vector<std::string> sets, only, skip;
};

struct CommonArgs {
  int threads = 0;
  bool quiet = false, verbose = false;
};

struct RenderArgs : InputArgs, PresetArgs, CommonArgs {
  std::string output;
  bool ao = false, ao_only = false;
  std::vector<std::string> aovs;
  std::string data_window = "keep", compression, existing = "overwrite", progress = "auto";
  bool keep_going = false, dry_run = false, print_config = false, recode = false;
  std::string preroll = kDefaultPreroll, memory, fsync = "on";
};

/// What score returns when a requirement is not met.
inline constexpr int kRequirementFailed = 1;

/// `input` is RESULT.
struct ScoreArgs : InputArgs, CommonArgs {
  std::string reference, geometry, mask, mask_from, reference_profile;
  std::vector<std::string> metrics, requirements, frame_requirements, reference_channels;
  bool json = false, csv = false;
};

struct InspectArgs : InputArgs, PresetArgs, CommonArgs {
  bool json = false;
};

struct SheetArgs : InputArgs, PresetArgs, CommonArgs {
  std::string after, output;
  std::vector<std::string> aovs;
  std::string preroll = kDefaultPreroll;
  int cell_width = 480;
};

struct TuneArgs : InputArgs, PresetArgs, CommonArgs {
  std::string reference, stage, output, metric, mask, holdout, cost_table, preroll = "2";
  std::vector<std::string> parameters;
  std::optional<double> budget_ms, budget_mb;
  int evaluations = 150, seed = 1;
};

struct CompareArgs : InputArgs, CommonArgs {
  std::vector<std::string> presets, sets, only, skip, references, metrics;
  std::string output, mask, mask_from, preroll = kDefaultPreroll, page_budget = "24M", ocio, view_transform;
  std::string sheet, sheet_frames, sheet_region;
  std::string progress = "auto";
  bool write_frames = false, ao = false, no_cost = false, no_report = false;
};

struct PresetsArgs {
  std::string action;
  std::vector<std::string> names;
  std::vector<std::string> sets;
};

const std::vector<Option<RenderArgs>>& render_options();
const std::vector<Option<CompareArgs>>& compare_options();
const std::vector<Option<ScoreArgs>>& score_options();
const std::vector<Option<InspectArgs>>& inspect_options();
const std::vector<Option<SheetArgs>>& sheet_options();
const std::vector<Option<TuneArgs>>& tune_options();
const std::vector<Option<PresetsArgs>>& presets_options();

/// Each runs one command to its end and returns the exit status; failures leave as Error.
int render(const RenderArgs& args);
int compare(const CompareArgs& args);
int score(const ScoreArgs& args);
int inspect(const InspectArgs& args);
int sheet(const SheetArgs& args);
int tune(const TuneArgs& args);
int presets(const PresetsArgs& args);

/// A command as help and manual show it.
struct CommandText {
  std::string name, synopsis, summary;
  std::vector<OptionText> options;
  std::vector<std::string> examples;
};
const std::vector<CommandText>& command_texts();

/// Parses the command line and runs it; returns the exit status. Writes errors to stderr.
int run_program(int argc, char** argv);

}  // namespace aftershade::app
