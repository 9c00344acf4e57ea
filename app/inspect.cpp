#include <cmath>
#include <cstdio>
#include <filesystem>

#include "app/job.h"
#include "app/lengths.h"
#include "app/statistics.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::app {

namespace {

using params::Json;

std::string text_of(Window w) {
  return cat(w.width(), "x", w.height(), w.min_x < 0 ? "" : "+", w.min_x, w.min_y < 0 ? "" : "+", w.min_y);
}

Json file_report(const io::FileInfo& info) {
  Json parts = Json::array();
  for (const io::PartInfo& part : info.parts) {
    std::vector<std::string> channels;
    for (const io::ChannelInfo& channel : part.channels)
      channels.push_back(cat(channel.name, " (", io::to_text(channel.type), ")"));
    parts.push_back({{"name", part.name},
                     {"view", part.view},
                     {"data_window", text_of(part.data_window)},
                     {"compression", part.compression},
                     {"tiled", part.tiled},
                     {"channels", channels}});
  }
  return {{"path", info.path},
          {"display_window", text_of(info.display_window)},
          {"pixel_aspect", params::json_of(info.pixel_aspect)},
          {"parts", parts}};
}

std::string channels_of(const std::vector<io::ChannelRef>& refs) {
  std::vector<std::string> names;
  for (const io::ChannelRef& ref : refs) names.push_back(ref.channel);
  return join(names, ", ");
}

Json roles_report(const Input& input, const std::string& view) {
  Json roles = Json::object();
  for (const io::ColorBinding& color : input.source->layers(view))
    if (color.is_beauty) roles["color"] = channels_of(color.channels);
  for (const io::RoleBinding& binding : input.source->roles(view))
    roles[std::string(info(binding.role).name)] = channels_of(binding.channels) + " (" + binding.why + ")";
  return roles;
}

Json layers_report(const Input& input, const std::string& view) {
  Json layers = Json::array();
  for (const io::ColorBinding& color : input.source->layers(view))
    if (!color.is_beauty) layers.push_back(color.layer);
  return layers;
}

Json camera_report(const Frame& frame) {
  if (!frame.camera) return "none: give --fov DEGREES or --camera FILE.json for AO and reprojection";
  const Camera& camera = *frame.camera;
  Json report = {{"position", camera.world_to_camera ? "known" : "unknown"},
                 {"projection", camera.orthographic ? "orthographic" : "perspective"}};
  if (!camera.orthographic)
    report["horizontal_fov_deg"] =
        parse_number(fixed(2 * std::atan(0.5 * frame.display.width() / camera.fx) * 180 / M_PI, 3)).value();
  report["principal_point_px"] = {camera.cx, camera.cy};
  return report;
}

Json view_report(const Input& input, const std::string& view, int number, const preset::Preset& preset) {
  Json report = {{"name", view}, {"roles", roles_report(input, view)}, {"layers", layers_report(input, view)}};
  const auto frame = input.source->load(number, view, input.source->available(view), false);
  if (!frame) return report;
  report["camera"] = camera_report(*frame);
  if (frame->shutter_angle_deg) report["shutter_angle_deg"] = params::json_of(*frame->shutter_angle_deg);
  std::optional<DepthStatistics> depth;
  if (frame->has(Role::depth)) depth = depth_statistics(frame->depth());
  if (depth) report["depth"] = text_of(*depth);
  if (frame->has(Role::depth2)) report["depth2"] = text_of(depth_statistics(frame->planes(Role::depth2)[0]));
  for (const Role role : {Role::velocity_prev, Role::velocity_next})
    if (frame->has(role))
      report[std::string(info(role).name)] =
          text_of(velocity_statistics(frame->planes(role)[0], frame->planes(role)[1]));
  if (depth && depth->foreground > 0 && frame->camera)
    report["lengths at the median depth"] = lengths_report(preset, *frame, depth->median_m);
  return report;
}

/// JSON as indented lines for people: "key: value".
void print_tree(const Json& node, size_t indent) {
  const std::string blanks(indent, ' ');
  for (const auto& [key, value] : node.items()) {
    const std::string name = node.is_array() ? "-" : key + ":";
    if (value.is_structured() && !value.empty()) {
      std::printf("%s%s\n", blanks.c_str(), name.c_str());
      print_tree(value, indent + 2);
    } else {
      const std::string text = value.is_string()       ? value.get<std::string>()
                               : value.is_structured() ? "none"
                                                       : value.dump();
      std::printf("%s%s %s\n", blanks.c_str(), name.c_str(), text.c_str());
    }
  }
}

/// The frame to look at: the one named, if INPUT is a file, else the first.
int frame_to_inspect(const InspectArgs& args, const Input& input) {
  const std::filesystem::path path(args.input);
  if (args.frames.empty() && std::filesystem::is_regular_file(path))
    if (const auto frame = io::frame_of_name(input.found.pattern, path.filename().string())) return *frame;
  return input.frames.front();
}

}  // namespace

int inspect(const InspectArgs& args) {
  InspectArgs tolerant = args;
  tolerant.missing = "skip";  // holes are reported, not refused
  const Input input = open_input(tolerant);
  const preset::Resolved preset = resolve_preset(args);
  const int number = frame_to_inspect(args, input);
  Json report = {{"sequence", input.found.pattern.text()},
                 {"frames", io::format_frames(input.frames)},
                 {"holes", io::format_frames(input.holes)},
                 {"inspected_frame", number},
                 {"profile", {{"name", input.producer.profile.name}, {"recognised_by", input.producer.why}}},
                 {"unit", {{"unit", input.unit}, {"from", input.unit_origin}}},
                 {"file", file_report(io::ExrReader(*input.found.sequence.path(number)).info())},
                 {"preset", preset.preset.name},
                 {"views", Json::array()}};
  for (const std::string& view : input.views)
    report["views"].push_back(view_report(input, view, number, preset.preset));
  if (args.json)
    std::printf("%s\n", report.dump(2).c_str());
  else
    print_tree(report, 0);
  return 0;
}

}  // namespace aftershade::app
