#include <algorithm>

#include "app/job.h"
#include "app/log.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"

namespace aftershade::app {

io::HashDigits hash_digits(const std::string& name) {
  return name == "oiio" ? io::HashDigits::oiio : io::HashDigits::one;
}

namespace {

/// "depth=foo.Z" -> {"depth", "foo.Z"}; the role must exist ("color" is accepted with `color`).
std::pair<std::string, std::string> split_role(const std::string& text, std::string_view option, bool color) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size())
    throw Error(ErrorCode::usage, cat(option, " ", text, " has no value"),
                "write it as ROLE=NAME, such as depth=foo.Z");
  const std::string role = text.substr(0, equals);
  std::vector<std::string> known;
  if (color) known.emplace_back("color");
  for (const RoleInfo& entry : kRoles) known.emplace_back(entry.name);
  if (std::find(known.begin(), known.end(), role) == known.end()) {
    const std::string hint = did_you_mean(role, known);
    throw Error(ErrorCode::usage, cat(option, ": \"", role, "\" is not a role"),
                hint.empty() ? "roles: " + join(known, ", ") : hint);
  }
  return {role, text.substr(equals + 1)};
}

/// The frames asked for, split into those that exist and those that do not.
void select_frames(const InputArgs& args, Input& input) {
  const io::FrameNumbers on_disk = input.found.sequence.frames();
  io::FrameNumbers asked = on_disk;
  if (!args.frames.empty())
    asked = io::parse_frames(args.frames);
  else if (input.found.pattern.range)
    asked = *input.found.pattern.range;
  else
    input.holes = input.found.sequence.holes();
  for (const int frame : asked) (input.found.sequence.path(frame) ? input.frames : input.holes).push_back(frame);
  if (input.frames.empty())
    throw Error(ErrorCode::no_input,
                cat("none of the frames ", io::format_frames(asked), " exists in ", input.found.pattern.text()),
                "on disk: " + io::format_frames(on_disk));
  if (input.holes.empty()) return;
  const std::string text = cat(input.found.pattern.text(), ": frames ", io::format_frames(input.holes), " are missing");
  if (args.missing == "error") throw Error(ErrorCode::no_input, text, "--missing skip goes on without them");
  log().warning(text);
}

io::Detected choose_profile(const InputArgs& args, const std::string& first_frame) {
  if (!args.profile.empty()) return {io::load_profile(args.profile), "--profile " + args.profile};
  return io::detect_profile(io::ExrReader(first_frame));
}

/// The unit of length: option, camera file, profile.
void choose_unit(const InputArgs& args, const io::CameraFile* camera, Input& input) {
  input.unit = input.producer.profile.unit;
  input.unit_origin = "profile " + input.producer.profile.name;
  if (camera && camera->unit()) input.unit = *camera->unit(), input.unit_origin = args.camera;
  if (!args.unit.empty()) input.unit = args.unit, input.unit_origin = "--unit";
}

}  // namespace

Input open_input(const InputArgs& args, const std::vector<std::string>& named_channels) {
  Input input;
  input.found = io::find_sequence(args.input, hash_digits(args.hash_digits));
  select_frames(args, input);
  const std::string first = *input.found.sequence.path(input.frames.front());
  input.producer = with_context(first, [&] { return choose_profile(args, first); });

  io::SourceOptions options;
  if (!args.camera.empty()) options.camera_file = std::make_shared<io::CameraFile>(args.camera);
  choose_unit(args, options.camera_file.get(), input);
  options.sequence = input.found.sequence;
  options.first_frame = input.frames.front();
  options.profile = input.producer.profile;
  for (const std::string& text : args.channels) options.channel_overrides.insert(split_role(text, "--channel", true));
  for (const std::string& text : args.roles) {
    const auto [role, pattern] = split_role(text, "--role", false);
    input.siblings.push_back(io::find_sequence(pattern, hash_digits(args.hash_digits)).sequence);
    options.siblings.push_back({*role_from_name(role), input.siblings.back()});
  }
  options.depth_kind = io::depth_kind_named(args.depth_kind);
  options.near_plane = args.near_plane;
  options.far_plane = args.far_plane;
  options.metres_per_unit = metres_per_unit(input.unit);
  options.fov_deg = args.fov_deg;
  if (args.fov_deg && !(*args.fov_deg > 0 && *args.fov_deg < 180))
    throw Error(ErrorCode::usage, cat("--fov ", *args.fov_deg, " is out of range"), "between 0 and 180 degrees");
  options.ao_layers = args.ao_layers;
  options.blur_layers = args.blur_layers;
  options.named_channels = named_channels;
  options.nan_is_error = args.nan == "error";
  input.source = std::make_unique<io::FileSource>(std::move(options));
  input.source->on_note = [](int frame, const std::string& text) { log().note(text, cat("frame ", frame, ": ")); };

  input.views = args.views.empty() ? input.source->views() : args.views;
  return input;
}

pipeline::Offer offer_of(const Input& input, const std::string& view) {
  pipeline::Offer offer;
  offer.roles = input.source->available(view);
  const auto frame = input.source->load(input.frames.front(), view, {}, false);
  offer.lens = frame && frame->camera;
  offer.position = offer.lens && frame->camera->world_to_camera;
  return offer;
}

preset::Resolved resolve_preset(const PresetArgs& args) {
  preset::Resolved resolved = preset::load_preset(args.preset.empty() ? kDefaultPreset : args.preset, args.sets);
  std::vector<std::string> ids;
  for (const auto& stage : resolved.preset.stages) ids.push_back(stage.id);
  for (const auto* list : {&args.only, &args.skip})
    for (const std::string& id : *list)
      if (std::find(ids.begin(), ids.end(), id) == ids.end())
        throw Error(ErrorCode::usage, cat("preset ", resolved.preset.name, " has no stage \"", id, "\""),
                    "stages: " + join(ids, ", "));
  std::erase_if(resolved.preset.stages, [&](const preset::StageDescription& stage) {
    const auto in = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), stage.id) != list.end();
    };
    return in(args.skip) || (!args.only.empty() && !in(args.only));
  });
  if (resolved.preset.stages.empty())
    throw Error(ErrorCode::usage, "no stage of the preset is left", "stages: " + join(ids, ", "));
  return resolved;
}

}  // namespace aftershade::app
