#include "app/tune_job.h"

#include <algorithm>
#include <filesystem>

#include "app/log.h"
#include "app/mask.h"
#include "app/memory.h"
#include "app/scored_input.h"
#include "app/signals.h"
#include "core/base/error.h"
#include "core/base/memory_limit.h"
#include "core/base/text.h"
#include "core/io/json.h"
#include "core/io/publish.h"
#include "core/pipeline/stage.h"
#include "core/tune/measure.h"

namespace aftershade::app {

namespace {

namespace fs = std::filesystem;
constexpr size_t kFramesByDefault = 4;

bool is_preset(const std::string& reference) {
  const std::vector<std::string> shipped = preset::shipped_presets();
  return reference.ends_with(".json") || std::ranges::find(shipped, reference) != shipped.end();
}

/// kFramesByDefault of the frames, evenly spread.
std::vector<int> spread(const std::vector<int>& frames) {
  if (frames.size() <= kFramesByDefault) return frames;
  std::vector<int> out;
  for (size_t i = 0; i < kFramesByDefault; ++i)
    out.push_back(frames[(2 * i + 1) * frames.size() / (2 * kFramesByDefault)]);
  return out;
}

/// The metric that is meant, which must be able to see what the stage does.
const metrics::MetricInfo& metric_for(const TuneArgs& args, const Input& input, const preset::StageDescription& stage,
                                      const pipeline::Offer& offer) {
  const pipeline::Needs needs = pipeline::make_stage(stage.params)->needs(offer);
  const std::string method(preset::method_of(stage.params));
  if (!needs.channels.empty())
    throw Error(ErrorCode::usage,
                cat("stage ", stage.id, " (", method, ") filters channel ", needs.channels.front(),
                    ", which no metric looks at"),
                "tune another stage");
  Scorable scorable{true, true, true};
  add_geometry(input, input.views.front(), scorable);
  const std::string name = !args.metric.empty() ? args.metric : needs.layers ? "psnr" : "ao_rmse";
  const metrics::MetricInfo& metric = tune::metric_named(metrics_to_score({name}, scorable).front());
  if (metric.of_ao && needs.layers)
    throw Error(ErrorCode::usage,
                cat("stage ", stage.id, " (", method, ") changes colours, and ", metric.name, " looks at the AO"),
                "choose a metric of colour, such as --metric psnr");
  return metric;
}

void choose_outputs(const TuneArgs& args, TuneJob& job) {
  if (!to_lower(args.output).ends_with(".json"))
    throw Error(ErrorCode::usage, cat("-o ", args.output, ": presets are JSON, and this name does not say so"),
                "let it end in .json");
  check_folder(args.output);
  const auto start = io::file_id(args.preset), output = io::file_id(args.output);
  if (start && output && *start == *output)
    throw Error(ErrorCode::usage, cat("the output ", args.output, " is the preset to start from"),
                "write to another name");
  job.output = args.output;
  job.front_output = args.output.substr(0, args.output.size() - 5) + ".front.json";
}

double positive(std::string_view option, const std::optional<double>& value, double otherwise) {
  if (value && !(*value > 0))
    throw Error(ErrorCode::usage, cat(option, " ", *value, " is no budget"), "a number above 0");
  return value.value_or(otherwise);
}

tune::Budget budget_of(const TuneArgs& args) {
  tune::Budget budget;
  budget.milliseconds = positive("--budget-ms", args.budget_ms, budget.milliseconds);
  budget.bytes = positive("--budget-mb", args.budget_mb, budget.bytes) * (1 << 20);
  return budget;
}

/// The frames to tune on and to hold out, which the input has, and the reference (empty: a preset).
void choose_frames(const TuneArgs& args, const io::Sequence& reference, TuneJob& job) {
  const auto lacks = [&](int frame) { return !reference.empty() && !reference.path(frame); };
  job.frames = job.input.frames;
  std::vector<int> common = job.frames;
  std::erase_if(common, lacks);
  if (common.empty())
    throw Error(ErrorCode::no_input, cat(args.input, " and ", args.reference, " have no frame in common"),
                "their frame numbers must agree; frames of the reference: " + io::format_frames(reference.frames()));
  if (!args.holdout.empty()) job.holdout = io::parse_frames(args.holdout);
  std::erase_if(common, [&](int frame) { return std::ranges::binary_search(job.holdout, frame); });
  if (args.frames.empty()) job.frames = spread(common);
  std::vector<int> both = job.frames, missing;
  both.insert(both.end(), job.holdout.begin(), job.holdout.end());
  std::ranges::sort(both);
  if (job.frames.empty() || std::ranges::adjacent_find(both) != both.end())
    throw Error(ErrorCode::usage, cat("--holdout ", args.holdout, " names frames that are tuned on"),
                "hold out others: what a score is worth is seen on frames that the search has not seen");
  for (const int frame : both)
    if (lacks(frame) || !job.input.found.sequence.path(frame)) missing.push_back(frame);
  if (!missing.empty())
    throw Error(ErrorCode::no_input,
                cat(lacks(missing.front()) ? args.reference : args.input, " lacks frames ", io::format_frames(missing)),
                "choose --frames and --holdout that are there");
}

/// All that is decoded stays in memory.
void check_memory(const TuneJob& job, const preset::Preset& preset) {
  pipeline::Outputs outputs;
  outputs.layers = !job.trial->setup().metric.of_ao;
  const auto& setup = job.trial->setup();
  const pipeline::ViewPipeline view(preset, setup.view, setup.offer, outputs);
  const size_t frames =
      pipeline::plan(job.frames, setup.on_disk, view.stages(), view.dependencies(), setup.preroll).size();
  RoleSet all;
  for (const RoleInfo& role : kRoles) all.insert(role.role);
  const auto first = job.source->load(job.frames.front(), setup.view, all, true);
  int64_t planes = 0;
  for (const auto& role : first->roles) planes += static_cast<int64_t>(role.size());
  for (const Layer& layer : first->layers) planes += static_cast<int64_t>(layer.planes.size());
  const int64_t bytes = planes * first->window.width() * first->window.height() * 4 * static_cast<int64_t>(frames);
  const int64_t limit = memory_limit("");
  if (bytes > limit)
    throw Error(ErrorCode::memory,
                cat("the ", frames, " frames that this needs take ", size_text(bytes),
                    ", more than half the machine's ", "memory"),
                "choose fewer with --frames, or a shorter --preroll");
  log().detail(cat(frames, " frames in memory, ", size_text(bytes)));
}

tune::Compared compared(SidePlanes planes) {
  tune::Compared out{std::move(planes.ao), {}};
  for (Plane& plane : planes.color) out.color.push_back(std::move(plane));
  return out;
}

/// The reference's planes of these frames, from its files.
class FileReference {
 public:
  FileReference(const TuneArgs& args, const std::vector<int>& frames, const metrics::MetricInfo& metric)
      : metric_(metric), side_(open(args, frames)) {
    if (metric.of_ao ? !side_.ao : !side_.color)
      throw Error(ErrorCode::no_input,
                  cat(args.reference, " has no ", metric.of_ao ? "AO" : "colour", ", which ", metric.name, " looks at"),
                  "give a reference that has it, or choose another --metric");
  }
  tune::Compared load(int frame, const Window& display) const {
    SidePlanes planes = load_side(side_, frame, !metric_.of_ao, metric_.of_ao);
    if (planes.display.width() != display.width() || planes.display.height() != display.height())
      throw Error(ErrorCode::data,
                  cat("frame ", frame, ": ", planes.path, " is ", planes.display.width(), "x", planes.display.height(),
                      ", the input ", display.width(), "x", display.height()),
                  "display windows must have the same size");
    return compared(std::move(planes));
  }

 private:
  static ScoredSide open(const TuneArgs& args, const std::vector<int>& frames) {
    InputArgs side;
    side.input = args.reference;
    side.frames = io::format_frames(frames);
    side.hash_digits = args.hash_digits;
    return open_scored_side(side);
  }
  const metrics::MetricInfo& metric_;
  ScoredSide side_;
};

/// The targets without their truth: what the scene says.
tune::Targets scene_targets(const TuneArgs& args, const TuneJob& job, const std::vector<int>& frames) {
  const tune::TrialSetup& setup = job.trial->setup();
  std::optional<MaskReader> mask;
  if (!args.mask.empty()) mask.emplace(args.mask, job.input, setup.view);
  tune::Targets targets;
  for (const int frame : frames) {
    tune::Target& target = targets[frame];
    if (setup.offer.roles.contains(Role::depth)) {
      GeometryPlanes scene = load_geometry(job.input, setup.view, frame);
      target.depth = std::move(scene.depth);
      target.velocity_x = std::move(scene.velocity_x), target.velocity_y = std::move(scene.velocity_y);
      target.camera = scene.camera;
    }
    const auto header = job.source->load(frame, setup.view, {}, false);
    target.origin_x = header->display.min_x, target.origin_y = header->display.min_y;
    if (mask) target.mask = mask->load(frame);
  }
  return targets;
}

void add_truth(const TuneArgs& args, TuneJob& job) {
  std::vector<int> all = job.frames;
  all.insert(all.end(), job.holdout.begin(), job.holdout.end());
  std::ranges::sort(all);
  tune::Results truth;
  if (is_preset(args.reference)) {
    log().note(cat("making the reference: preset ", args.reference));
    truth = job.trial->results(preset::load_preset(args.reference).preset, all);
    if (stop_signal() != 0) end_by_signal(stop_signal());
  } else {
    const FileReference reference(args, all, job.trial->setup().metric);
    for (const int frame : all) {
      const auto header = job.source->load(frame, job.trial->setup().view, {}, false);
      truth.emplace(frame, reference.load(frame, header->display));
    }
  }
  for (tune::Targets* targets : {&job.targets, &job.holdout_targets})
    for (auto& [frame, target] : *targets) target.truth = std::move(truth.at(frame));
}

Input open(const TuneArgs& args) {
  InputArgs input = args;
  if (input.frames.empty()) input.missing = "skip";
  return open_input(input);
}

}  // namespace

TuneJob resolve_tune(const TuneArgs& args) {
  TuneJob job;
  job.preset = resolve_preset(args).preset;
  const preset::StageDescription& stage = stage_named(job.preset, args.stage);
  job.stage = stage.id;
  job.axes = axes_of(stage, args.parameters);
  job.budget = budget_of(args);
  choose_outputs(args, job);
  job.input = open(args);
  tune::TrialSetup setup;
  setup.view = job.input.views.front();
  setup.offer = offer_of(job.input, setup.view);
  setup.on_disk = job.input.found.sequence.frames();
  setup.preroll = preroll_of(args.preroll);
  setup.metric = metric_for(args, job.input, stage, setup.offer);
  setup.should_stop = [] { return stop_signal() != 0; };
  const bool preset_reference = is_preset(args.reference);
  choose_frames(
      args,
      preset_reference ? io::Sequence() : io::find_sequence(args.reference, hash_digits(args.hash_digits)).sequence,
      job);
  tune::Wanted wanted = tune::wanted_by(job.preset, setup);
  if (preset_reference) {
    const tune::Wanted more = tune::wanted_by(preset::load_preset(args.reference).preset, setup);
    wanted.roles.insert(more.roles);
    wanted.layers = wanted.layers || more.layers;
  }
  job.source = std::make_unique<tune::FramesInMemory>(*job.input.source, wanted.roles, wanted.layers);
  job.trial = std::make_unique<tune::Trial>(std::move(setup), *job.source);
  check_memory(job, job.preset);
  job.targets = scene_targets(args, job, job.frames);
  job.holdout_targets = scene_targets(args, job, job.holdout);
  add_truth(args, job);
  return job;
}

tune::CostTable read_cost_table(const std::string& path, const TuneJob& job) {
  if (!fs::is_regular_file(path))
    throw Error(ErrorCode::no_input, cat("the cost table ", path, " does not exist"),
                "leave out --cost-table to measure costs");
  params::Json json;
  try {
    json = params::Json::parse(io::read_text_file(path));
  } catch (const params::Json::exception& error) {
    throw Error(ErrorCode::config, cat(path, ": ", error.what()), "the file is not valid JSON");
  }
  const bool inside = json.is_object() && json.contains("cost_table");
  const tune::CostTable table = tune::cost_table_of(inside ? json.at("cost_table") : json, path);
  const auto frame = job.source->load(job.measured_frame(), job.trial->setup().view, {}, false);
  tune::check_fits(table, tune::blank_table({job.preset, job.stage, job.axes, job.measured_frame()}, *frame), job.axes,
                   path);
  return table;
}

}  // namespace aftershade::app
