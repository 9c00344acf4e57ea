#include "app/compare_job.h"

#include <algorithm>
#include <filesystem>

#include "app/log.h"
#include "app/memory.h"
#include "core/base/error.h"
#include "core/base/memory_limit.h"
#include "core/base/text.h"
#include "core/pipeline/named_channels.h"

namespace aftershade::app {

namespace {

namespace fs = std::filesystem;

bool contains(const std::vector<std::string>& list, const std::string& text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

/// "a,b" "c" -> a b c; "all" is every shipped preset.
std::vector<std::string> preset_names(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists)
    for (const std::string& name : split(list, ',')) {
      if (name.empty())
        throw Error(ErrorCode::usage, cat("--presets ", list, " names an empty preset"),
                    "write them as a,b,c.json, without blanks");
      if (name == "all")
        for (const std::string& shipped : preset::shipped_presets()) names.push_back(shipped);
      else
        names.push_back(name);
    }
  return names;
}

/// --set, --only and --skip of the stages that the preset has; `met` collects the stage ids that any preset has.
preset::Preset load(const std::string& name, const CompareArgs& args, std::vector<std::string>& met) {
  std::vector<std::string> ids;
  for (const auto& stage : preset::load_preset(name).preset.stages) ids.push_back(stage.id);
  met.insert(met.end(), ids.begin(), ids.end());
  PresetArgs own;
  own.preset = name;
  for (const std::string& set : args.sets)
    if (contains(ids, set.substr(0, set.find('.')))) own.sets.push_back(set);
  for (const std::string& id : args.only)
    if (contains(ids, id)) own.only.push_back(id);
  for (const std::string& id : args.skip)
    if (contains(ids, id)) own.skip.push_back(id);
  if (!args.only.empty() && own.only.empty())
    throw Error(ErrorCode::usage, cat("preset ", name, " has none of the stages of --only"),
                "stages: " + join(ids, ", "));
  return resolve_preset(own).preset;
}

/// Stages of --set, --only and --skip must be in some preset.
void check_stages(const CompareArgs& args, const std::vector<std::string>& met) {
  const auto check = [&](const char* option, const std::string& text, const std::string& id) {
    if (!contains(met, id))
      throw Error(ErrorCode::usage, cat(option, " ", text, ": no preset has a stage \"", id, "\""),
                  did_you_mean(id, met));
  };
  for (const std::string& text : args.sets) check("--set", text, text.substr(0, text.find('.')));
  for (const std::string& id : args.only) check("--only", id, id);
  for (const std::string& id : args.skip) check("--skip", id, id);
}

std::vector<preset::Preset> load_all(const CompareArgs& args) {
  std::vector<preset::Preset> presets;
  std::vector<std::string> met;
  for (const std::string& name : preset_names(args.presets)) {
    presets.push_back(load(name, args, met));
    for (size_t i = 0; i + 1 < presets.size(); ++i)
      if (presets[i].name == presets.back().name)
        throw Error(ErrorCode::usage, cat("two presets are called ", presets.back().name),
                    "name each once; a preset file has the name of its file");
  }
  check_stages(args, met);
  for (const preset::Preset& preset : presets)
    if (preset.name.empty() || preset.name == "." || preset.name == ".." || preset.name.starts_with("report."))
      throw Error(ErrorCode::usage,
                  cat("\"", preset.name, "\" cannot be the name of a preset here: its frames' folder has it"),
                  "rename its file");
  return presets;
}

/// Is it the name of a preset, rather than of a sequence?
bool is_preset(const std::string& text) {
  const auto shipped = preset::shipped_presets();
  return text.ends_with(".json") || contains(shipped, text);
}

/// The options of the sequence apart from those that say what is in INPUT's files.
InputArgs beside(const CompareArgs& args, const std::string& input) {
  InputArgs out;
  out.input = input;
  out.frames = args.frames;
  out.hash_digits = args.hash_digits;
  out.missing = args.missing;
  return out;
}

void open_references(const CompareArgs& args, std::vector<preset::Preset>& presets, CompareJob& job) {
  job.compared = presets.size();
  for (const std::string& text : args.references) {
    if (!is_preset(text)) {
      job.references.push_back(open_scored_side(beside(args, text)));
      continue;
    }
    if (args.references.size() > 1)
      throw Error(ErrorCode::usage, "a preset is the reference of everything, beside it there can be no other",
                  "give --reference once, or sequences only");
    std::vector<std::string> met;
    const preset::Preset reference = load(text, args, met);
    const auto same = [&](const preset::Preset& preset) { return preset.name == reference.name; };
    job.reference = static_cast<size_t>(std::find_if(presets.begin(), presets.end(), same) - presets.begin());
    if (*job.reference == presets.size()) presets.push_back(reference);
  }
  bool color = false, ao = false;
  for (const ScoredSide& side : job.references) {
    if ((color || !side.color) && (ao || !side.ao))
      throw Error(ErrorCode::usage, cat("the reference ", side.input.found.pattern.text(), " would not be used"),
                  "those before it have colour and AO already, or it has neither");
    color = color || side.color;
    ao = ao || side.ao;
  }
  job.reference_text = join(args.references, ", ");
}

/// All that any of the presets filters.
std::vector<std::string> named_channels(const std::vector<preset::Preset>& presets) {
  std::vector<std::string> names;
  for (const preset::Preset& preset : presets)
    for (const std::string& name : pipeline::named_channels(preset))
      if (!contains(names, name)) names.push_back(name);
  return names;
}

Contender contender_of(const preset::Preset& preset, const Input& input, const std::optional<std::string>& ao_channel) {
  Contender out{preset, {}, {}};
  for (const std::string& view : input.views)
    with_context("preset " + preset.name, [&] {
      pipeline::Outputs outputs;
      pipeline::ViewPipeline stages(preset, view, offer_of(input, view), outputs);
      if (ao_channel && stages.makes_ao()) {
        outputs.ao_channel = ao_channel;
        stages = pipeline::ViewPipeline(preset, view, offer_of(input, view), outputs);
      }
      if (stages.layers(stages.stages())) input.source->check_layers_and_named(view);
      out.views.push_back(std::move(stages));
    });
  return out;
}

void add_contenders(const CompareArgs& args, const std::vector<preset::Preset>& presets, CompareJob& job) {
  const bool only_writes = args.no_report && args.sheet.empty() && contains(args.metrics, "none");
  job.write_ao = args.ao;
  if (job.write_ao || !only_writes) job.ao_channel = ao_channel_for(job.input.source->info());
  for (const preset::Preset& preset : presets) {
    job.contenders.push_back(contender_of(preset, job.input, job.ao_channel));
    if (job.write_ao && !job.contenders.back().views.front().makes_ao())
      log().warning(cat("preset ", preset.name, " makes no AO at full resolution: its frames have none"));
  }
}

/// The frames that every reference has too.
void choose_frames(const CompareArgs& args, CompareJob& job) {
  job.frames = job.input.frames;
  for (const ScoredSide& side : job.references) {
    std::vector<int> missing;
    for (const int frame : job.frames)
      if (!side.input.found.sequence.path(frame)) missing.push_back(frame);
    if (missing.empty()) continue;
    const std::string text =
        cat("the reference ", side.input.found.pattern.text(), " lacks frames ", io::format_frames(missing));
    if (args.missing == "error")
      throw Error(ErrorCode::no_input, text, "--frames chooses frames, --missing skip compares those that both have");
    log().warning(text);
    std::erase_if(job.frames,
                  [&](int frame) { return std::find(missing.begin(), missing.end(), frame) != missing.end(); });
  }
  if (job.frames.empty())
    throw Error(ErrorCode::no_input, "the reference has none of the frames", "their frame numbers must agree");
}

void choose_metrics(const CompareArgs& args, CompareJob& job) {
  if (contains(args.metrics, "none")) {
    if (args.metrics.size() > 1) throw Error(ErrorCode::usage, "--metric none excludes other metrics");
    return;
  }
  const auto makes_ao = [](const Contender& c) { return c.views.front().makes_ao(); };
  const auto side_has = [&](auto member) {
    return job.references.empty() || std::any_of(job.references.begin(), job.references.end(), member);
  };
  const auto& layers = job.input.source->layers(job.view);
  const bool color = std::any_of(layers.begin(), layers.end(), [](const auto& layer) { return layer.is_beauty; });
  Scorable scorable{color && side_has([](const ScoredSide& s) { return s.color; }),
                    std::any_of(job.contenders.begin(), job.contenders.end(), makes_ao) &&
                        (!job.reference || makes_ao(job.contenders[*job.reference])) &&
                        side_has([](const ScoredSide& s) { return s.ao; }),
                    job.reference || !job.references.empty(), false, false};
  add_geometry(job.input, job.view, scorable);
  job.geometry = job.input.source->available(job.view).contains(Role::depth);
  try {
    job.metrics = metrics_to_score(args.metrics, scorable);
  } catch (const Error& error) {
    if (!args.metrics.empty()) throw;
    log().note("nothing can be scored: without a reference and without motion");
  }
}

void choose_mask(const CompareArgs& args, CompareJob& job) {
  if (args.mask.empty() && !args.mask_from.empty())
    throw Error(ErrorCode::usage, "--mask-from without --mask", "--mask alpha, or a channel, or cryptomatte:NAME");
  if (args.mask.empty()) return;
  const bool own = args.mask_from.empty();
  const Input from = own ? open_input(args) : open_input(beside(args, args.mask_from));
  job.mask.emplace(args.mask, from, own ? job.view : from.views.front());
}

void choose_outputs(const CompareArgs& args, CompareJob& job) {
  check_folder(args.output.ends_with('/') ? args.output.substr(0, args.output.size() - 1) : args.output);
  const fs::path folder(args.output);
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw Error(ErrorCode::cannot_create, cat("-o ", args.output, " is no folder"), "name a folder for the reports");
  if (!args.write_frames) return;
  for (size_t i = 0; i < job.compared; ++i) {
    Contender& contender = job.contenders[i];
    contender.output_path = [own = folder / contender.preset.name, input = job.input.found.pattern](int frame) {
      return (own / input.name(frame)).string();
    };
    check_not_input(job.input, job.frames, contender.output_path);
  }
}

void choose_sheet(const CompareArgs& args, CompareJob& job) {
  const auto makes_ao = [](const Contender& c) { return c.views.front().makes_ao(); };
  const auto compared = job.contenders.begin() + static_cast<std::ptrdiff_t>(job.compared);
  if (args.sheet == "ao" && std::none_of(job.contenders.begin(), compared, makes_ao))
    throw Error(ErrorCode::usage, "--sheet ao: no preset makes AO", "--sheet color shows what they make");
  const auto& info = job.input.source->info();
  job.sheet = sheet_plan(args, job.frames, info.display_window, info.pixel_aspect);
}

int look_ahead(const Contender& contender) {
  int frames = 0;
  for (const pipeline::Dependency& stage : contender.views.front().dependencies()) frames += stage.frames_after;
  return frames;
}

/// A frame's results wait until all have finished it.
void warn_of_waiting(const CompareJob& job) {
  constexpr int64_t kPlanes = 4;  // colour and AO
  const auto farthest = std::max_element(job.contenders.begin(), job.contenders.end(),
                                         [](const auto& a, const auto& b) { return look_ahead(a) < look_ahead(b); });
  const Window display = job.input.source->info().display_window;
  const int64_t plane = int64_t{display.width()} * display.height() * static_cast<int64_t>(sizeof(float));
  const int64_t waiting = look_ahead(*farthest) * static_cast<int64_t>(job.contenders.size()) * kPlanes * plane;
  if (job.ao_channel && waiting > memory_limit(""))
    log().warning(cat("results of ", look_ahead(*farthest), " frames wait for preset ", farthest->preset.name,
                      ", which looks so far ahead: ", size_text(waiting),
                      ", more than half the machine's memory; compare it in a run of its own"));
}

}  // namespace

CompareJob resolve_comparison(const CompareArgs& args) {
  if (args.ao && !args.write_frames)
    throw Error(ErrorCode::usage, "--ao says what frames have, and none are written", "add --write-frames");
  CompareJob job;
  std::vector<preset::Preset> presets = load_all(args);
  open_references(args, presets, job);
  job.input = open_input(args, named_channels(presets));
  job.view = job.input.views.front();
  if (!args.write_frames) job.input.views.resize(1);
  if (job.input.source->views().size() > 1 && args.views.size() != 1)
    log().note(cat(args.input, " has several views: view ", job.view, " is compared"));
  add_contenders(args, presets, job);
  warn_of_waiting(job);
  choose_frames(args, job);
  choose_metrics(args, job);
  choose_mask(args, job);
  choose_outputs(args, job);
  choose_sheet(args, job);
  job.preroll = preroll_of(args.preroll);
  job.pictures = !args.no_report;
  job.measure = !args.no_cost;
  job.input.source->keep_files(args.write_frames);
  return job;
}

}  // namespace aftershade::app
