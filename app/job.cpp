#include "app/job.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "app/log.h"
#include "app/memory.h"
#include "core/base/error.h"
#include "core/base/memory_limit.h"
#include "core/base/text.h"
#include "core/io/publish.h"
#include "core/parallel/rows.h"
#include "core/pipeline/named_channels.h"

namespace aftershade::app {

namespace {

namespace fs = std::filesystem;

/// Where frames go: a pattern with a frame token, a folder, or a file for one frame.
std::function<std::string(int)> output_paths(const RenderArgs& args, const io::Pattern& input, size_t frames) {
  if (fs::is_directory(args.output) || args.output.ends_with('/'))
    return [folder = fs::path(args.output), input](int frame) { return (folder / input.name(frame)).string(); };
  if (const auto pattern = io::parse_pattern(args.output, hash_digits(args.hash_digits)))
    return [pattern](int frame) { return pattern->path(frame); };
  if (frames > 1)
    throw Error(ErrorCode::usage, cat("-o ", args.output, " names one file, but ", frames, " frames are to be written"),
                "put a frame token into it (out.####.exr), or name an existing folder");
  return [path = args.output](int) { return path; };
}

void check_name(const std::string& path) {
  if (to_lower(path).ends_with(".exr")) return;
  throw Error(ErrorCode::usage, cat("-o ", path, ": frames are written as EXR, and this name does not say so"),
              "let it end in .exr");
}

bool is_complete(const std::string& path) {
  try {
    io::ExrReader reader(path);
    return true;
  } catch (const Error&) {
    return false;
  }
}

/// Applies --existing to the frames to write.
void apply_existing(const std::string& policy, Job& job) {
  if (policy == "overwrite") return;
  if (policy == "error") {
    for (const int frame : job.written)
      if (fs::exists(job.output_path(frame)))
        throw Error(ErrorCode::cannot_create, cat("frame ", frame, ": the output ", job.output_path(frame), " exists"),
                    "--existing overwrite or --existing skip");
    return;
  }
  const size_t before = job.written.size();
  std::erase_if(job.written, [&](int frame) { return is_complete(job.output_path(frame)); });
  if (job.written.size() < before)
    log().note(cat(before - job.written.size(), " frames exist and are complete: skipped"));
}

/// Options that say what effects do, beside --recode, which has none.
void check_recode(const RenderArgs& args) {
  const std::pair<const char*, bool> given[] = {{"--preset", !args.preset.empty()},
                                                {"--set", !args.sets.empty()},
                                                {"--only", !args.only.empty()},
                                                {"--skip", !args.skip.empty()},
                                                {"--ao", args.ao},
                                                {"--ao-only", args.ao_only},
                                                {"--aov", !args.aovs.empty()},
                                                {"--data-window", args.data_window != "keep"},
                                                {"--preroll", args.preroll != kDefaultPreroll},
                                                {"--print-config", args.print_config},
                                                {"--ao-layers", !args.ao_layers.empty()},
                                                {"--blur-layers", !args.blur_layers.empty()}};
  for (const auto& [name, is_given] : given)
    if (is_given)
      throw Error(ErrorCode::usage, cat("--recode runs no effect, and ", name, " would do nothing"),
                  cat("leave out --recode or ", name));
}

/// How many frames there can be at once, from what they cost.
void plan_memory(const RenderArgs& args, Job& job) {
  const int64_t limit = memory_limit(args.memory);
  const FrameCost cost = frame_cost(args, job);
  // With one thread nothing can go on beside anything.
  job.frames_in_flight = thread_count() == 1 ? 1 : frames_in_flight(cost, limit);
  const int64_t peak = peak_of(cost, job.frames_in_flight);
  if (peak > limit)
    log().warning(cat("one frame at a time may need ", size_text(peak), ", more than the ", size_text(limit), " of ",
                      args.memory.empty() ? "half the machine's memory" : "--memory"));
  log().detail(cat("up to ", job.frames_in_flight, " frames at once, ", size_text(peak), " of ", size_text(limit)));
}

pipeline::Outputs outputs_of(const RenderArgs& args, const preset::Preset& preset, const io::FileInfo& info) {
  pipeline::Outputs outputs;
  if (args.ao || args.ao_only) outputs.ao_channel = ao_channel_for(info);
  outputs.layers = !args.ao_only;
  outputs.work.aovs = pipeline::aovs_from_names(args.aovs, pipeline::aovs_of(preset, outputs.layers));
  outputs.work.grow_data_window = args.data_window == "grow";
  return outputs;
}

/// What is filtered as a named channel must not be written by others too.
void check_channels(const Job& job, const pipeline::Outputs& outputs, const std::vector<std::string>& channels) {
  const pipeline::ViewPipeline& view = job.views.back();
  if (view.layers(view.stages())) job.input.source->check_layers_and_named(view.view());
  if (outputs.ao_channel && std::ranges::find(channels, *outputs.ao_channel) != channels.end())
    throw Error(ErrorCode::usage, cat("the AO goes to channel ", *outputs.ao_channel, ", which the preset filters"),
                "filter the channel in a run of its own");
}

/// Decoded bytes travel with a frame, unless many frames wait for those behind them.
bool keeps_files(const std::vector<pipeline::ViewPipeline>& views) {
  constexpr int kFewFrames = 1;
  int waiting = 0;
  for (const pipeline::Dependency& stage : views.front().dependencies()) waiting += stage.frames_after;
  return waiting <= kFewFrames && views.front().layers(views.front().stages());
}

}  // namespace

void check_folder(const std::string& path) {
  fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (!fs::is_directory(folder))
    throw Error(ErrorCode::cannot_create, cat("the output folder ", folder.string(), " does not exist"),
                "create it first");
  if (access(folder.c_str(), W_OK) != 0)
    throw Error(ErrorCode::cannot_create, cat("the output folder ", folder.string(), " cannot be written to"),
                "check its permissions");
}

int preroll_of(const std::string& text) {
  if (text == "all") return pipeline::kPrerollAll;
  const auto frames = parse_integer(text);
  if (frames && *frames >= 0) return *frames;
  throw Error(ErrorCode::usage, cat("--preroll ", text, " is not a number of frames"), "a number, or all");
}

void check_not_input(const Input& input, const std::vector<int>& written,
                     const std::function<std::string(int)>& output_path) {
  std::map<io::FileId, std::string> inputs;
  const auto add = [&](const io::Sequence& sequence) {
    for (const auto& entry : sequence.entries())
      if (const auto id = io::file_id(entry.path)) inputs.emplace(*id, entry.path);
  };
  add(input.found.sequence);
  for (const io::Sequence& sibling : input.siblings) add(sibling);
  for (const int frame : written) {
    const auto id = io::file_id(output_path(frame));
    const auto source = id ? inputs.find(*id) : inputs.end();
    if (source != inputs.end())
      throw Error(ErrorCode::usage, cat("the output ", output_path(frame), " is the input frame ", source->second),
                  "write to another folder or another name");
  }
}

std::string ao_channel_for(const io::FileInfo& info) {
  for (const std::string& view : io::views_of(info))
    if (has_channel(info, view, "AO") || has_channel(info, view, kOwnAoChannel)) return kOwnAoChannel;
  return "AO";
}

bool has_channel(const io::FileInfo& info, const std::string& view, const std::string& name) {
  for (size_t part = 0; part < info.parts.size(); ++part)
    for (const io::ChannelInfo& channel : info.parts[part].channels)
      if (io::name_in_view(info, static_cast<int>(part), channel.name, view) == name) return true;
  return false;
}

Job resolve_job(const RenderArgs& args) {
  Job job;
  if (args.recode)
    check_recode(args);
  else
    job.preset = resolve_preset(args);
  std::vector<std::string> channels;
  if (!args.ao_only) channels = pipeline::named_channels(job.preset.preset);
  job.input = open_input(args, channels);
  job.named_channels = channels.size();
  job.preroll = preroll_of(args.preroll);
  job.written = job.input.frames;
  job.output_path = output_paths(args, job.input.found.pattern, job.written.size());
  for (const int frame : job.written) {
    check_name(job.output_path(frame));
    check_folder(job.output_path(frame));
  }
  check_not_input(job.input, job.written, job.output_path);
  apply_existing(args.existing, job);
  if (!args.compression.empty()) {
    io::check_compression(args.compression);
    job.write.compression = args.compression;
  }
  job.write.data_window = args.data_window == "grow" ? io::DataWindowPolicy::grow : io::DataWindowPolicy::keep;
  job.write.only_new_channels = args.ao_only;
  job.write.recode = args.recode;
  job.write.fsync = args.fsync == "on";
  const pipeline::Outputs outputs = outputs_of(args, job.preset.preset, job.input.source->info());
  if (!args.camera.empty() && job.input.source->has_header_camera(job.input.views.front()))
    log().note("--camera is not used: the frames have camera matrices in their headers");
  for (const std::string& view : job.input.views)
    with_context(view.empty() ? job.input.found.pattern.text() : "view " + view, [&] {
      job.views.emplace_back(job.preset.preset, view, offer_of(job.input, view), outputs);
      check_channels(job, outputs, channels);
    });
  job.keep_file = keeps_files(job.views);
  job.input.source->keep_files(job.keep_file);
  plan_memory(args, job);
  return job;
}

}  // namespace aftershade::app
