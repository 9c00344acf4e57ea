#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/channel_names.h"
#include "core/io/source_state.h"

namespace aftershade::io {

namespace {

bool is_in_view(const PartInfo& part, const std::string& view) { return part.view.empty() || part.view == view; }

/// The view of a sibling file that goes with `view`: one-file-per-AOV renderers may leave the view out.
std::string view_in(const FileInfo& info, const std::string& view) {
  const auto views = views_of(info);
  return std::find(views.begin(), views.end(), view) != views.end() ? view : views.front();
}

/// Channels of a file that holds one AOV under colour names ("R" of depth.1001.exr), or one channel alone.
std::optional<std::vector<ChannelRef>> bind_any_names(const FileInfo& info, const std::string& view,
                                                      const RoleInfo& role) {
  const ViewChannels channels(info, view);
  const auto planes = static_cast<size_t>(role.planes);
  if (planes == 1 && channels.all().size() == 1) return std::vector{channels.all().front().ref};
  for (const char* suffixes : {"XYZ", "RGB"})
    for (const std::string prefix : {"", "*."}) {
      std::vector<std::string> patterns;
      for (size_t i = 0; i < planes; ++i) patterns.push_back(prefix + suffixes[i]);
      const bool is_z = planes == 1 && suffixes[0] == 'X';  // a lone X is no depth
      if (is_z) continue;
      if (auto refs = channels.bind(
              patterns, planes, [](const NamedChannel&) { return true; }, /*one_part=*/true))
        return refs;
    }
  return std::nullopt;
}

RoleBinding bind_sibling(const FileInfo& info, const std::string& main_view, const SourceOptions& options,
                         size_t index) {
  const RoleInfo& role = aftershade::info(options.siblings[index].role);
  const std::string view = view_in(info, main_view);
  std::map<std::string, std::string> overrides;
  if (const auto names = options.channel_overrides.find(std::string(role.name));
      names != options.channel_overrides.end())
    overrides.insert(*names);
  auto bindings = resolve_roles(info, view, options.profile, overrides);
  const auto found =
      std::find_if(bindings.begin(), bindings.end(), [&](const RoleBinding& b) { return b.role == role.role; });
  RoleBinding out{.role = role.role, .channels = {}, .encoding = {}, .why = {}, .sibling = static_cast<int>(index)};
  if (found != bindings.end()) {
    out.channels = found->channels;
    out.encoding = found->encoding;
    out.why = found->why;
  } else {
    auto refs = bind_any_names(info, view, role);
    if (!refs)
      throw Error(ErrorCode::no_input, cat(info.path, " has no channel for ", role.name),
                  cat("name it with --channel ", role.name, "=NAME; the file has ", ViewChannels(info, view).listed()));
    const auto& candidates = options.profile.roles[static_cast<size_t>(role.role)];
    out.channels = std::move(*refs);
    if (!candidates.empty()) out.encoding = candidates.front().encoding;
    out.encoding.multiply = false;
    out.why = "the only channels there";
  }
  out.why = cat("--role ", role.name, "=", info.path, ": ", out.why);
  return out;
}

/// How depth is stored, the second like the first: as its channel says, without one as the profile's first candidate.
Encoding depth_encoding(const std::vector<RoleBinding>& roles, const SourceOptions& options) {
  const auto& candidates = options.profile.roles[static_cast<size_t>(Role::depth)];
  Encoding encoding = candidates.empty() ? Encoding{} : candidates.front().encoding;
  if (const auto depth = std::ranges::find(roles, Role::depth, &RoleBinding::role); depth != roles.end())
    encoding = depth->encoding;
  if (options.depth_kind) encoding.depth_kind = *options.depth_kind;
  return encoding;
}

std::vector<RoleBinding> bind_roles(const Resolved& resolved, const SourceOptions& options, const std::string& view) {
  auto overrides = options.channel_overrides;
  for (const Sibling& sibling : options.siblings) overrides.erase(std::string(info(sibling.role).name));
  auto roles = resolve_roles(resolved.first, view, options.profile, overrides);
  for (size_t i = 0; i < options.siblings.size(); ++i) {
    std::erase_if(roles, [&](const RoleBinding& b) { return b.role == options.siblings[i].role; });
    roles.push_back(bind_sibling(resolved.siblings[i], view, options, i));
  }
  std::sort(roles.begin(), roles.end(), [](const RoleBinding& a, const RoleBinding& b) { return a.role < b.role; });
  Encoding depth = depth_encoding(roles, options);
  for (RoleBinding& binding : roles)
    if (is_depth(binding.role)) binding.encoding = depth;
  return roles;
}

bool overlap(const ColorBinding& a, const ColorBinding& b) {
  return std::ranges::find_first_of(a.channels, b.channels) != a.channels.end();
}

LayerChoice& choice_for(std::vector<LayerChoice>& layers, const ColorBinding& binding) {
  for (LayerChoice& layer : layers) {
    if (layer.binding.layer == binding.layer && layer.binding.is_beauty == binding.is_beauty) return layer;
    if (overlap(layer.binding, binding))
      throw Error(ErrorCode::usage,
                  cat("layers \"", layer.binding.is_beauty ? "beauty" : layer.binding.layer, "\" and \"",
                      binding.is_beauty ? "beauty" : binding.layer, "\" share channels"),
                  "name each channel once");
  }
  return layers.emplace_back(LayerChoice{binding});
}

/// The beauty's part, else the view's first, else the file's.
int part_of_view(const FileInfo& info, const std::string& view, const std::vector<ColorBinding>& colors) {
  if (!colors.empty() && colors.front().is_beauty) return colors.front().channels.front().part;
  const auto own = std::ranges::find(info.parts, view, &PartInfo::view);
  return own == info.parts.end() ? 0 : static_cast<int>(own - info.parts.begin());
}

/// Light, lengths and vectors are fractions; whole numbers are ids or masks.
void refuse_uint(const FileInfo& info, const std::vector<ChannelRef>& channels, std::string_view use) {
  for (const ChannelRef& ref : channels)
    if (info.parts[static_cast<size_t>(ref.part)].find(ref.channel)->type == PixelType::uint)
      throw Error(ErrorCode::data, cat(info.path, ": channel ", ref.channel, " (", use, ") holds whole numbers (uint)"),
                  "name half or float channels with --channel or choose other layers");
}

std::vector<LayerChoice> choose_layers(const FileInfo& info, const std::string& view,
                                       const std::vector<ColorBinding>& colors, const SourceOptions& options,
                                       const std::vector<std::string>& cryptomattes) {
  std::vector<LayerChoice> layers;
  const auto choose = [&](const std::vector<std::string>& names, bool LayerChoice::*effect) {
    for (const std::string& name : names)
      choice_for(layers, find_layer(info, view, colors, name, cryptomattes)).*effect = true;
    if (names.empty() && !colors.empty() && colors.front().is_beauty) choice_for(layers, colors.front()).*effect = true;
  };
  choose(options.ao_layers, &LayerChoice::ao);
  choose(options.blur_layers, &LayerChoice::blur);
  for (const LayerChoice& layer : layers) refuse_uint(info, layer.binding.channels, "colour");
  return layers;
}

std::vector<NamedChoice> choose_named(const FileInfo& info, const std::string& view, const SourceOptions& options,
                                      const std::vector<std::string>& cryptomattes) {
  std::vector<NamedChoice> named;
  for (const std::string& name : options.named_channels) {
    const ChannelRef ref = find_channel(info, view, name, cryptomattes);
    refuse_uint(info, {ref}, "to be filtered");
    for (const NamedChoice& other : named)
      if (other.ref == ref)
        throw Error(ErrorCode::usage, cat("\"", other.name, "\" and \"", name, "\" are the same channel"),
                    "call it by one name");
    named.push_back({name, ref});
  }
  return named;
}

}  // namespace

bool has_header_camera(const ExrReader& file, const SourceOptions& options, const std::string& view) {
  for (int part = 0; part < static_cast<int>(file.info().parts.size()); ++part)
    if (is_in_view(file.info().parts[static_cast<size_t>(part)], view) &&
        camera_from_header(file, part, options.profile.camera, options.metres_per_unit))
      return true;
  return false;
}

std::optional<Camera> find_camera(const ExrReader& file, const SourceOptions& options, int number,
                                  const std::string& view, std::string* note) {
  const FileInfo& info = file.info();
  std::optional<Camera> camera;
  for (int part = 0; part < static_cast<int>(info.parts.size()) && !camera; ++part)
    if (is_in_view(info.parts[static_cast<size_t>(part)], view))
      camera = camera_from_header(file, part, options.profile.camera, options.metres_per_unit, note);
  if (!camera && options.camera_file)
    camera = options.camera_file->camera(number, info.display_window, info.pixel_aspect, options.metres_per_unit, note);
  if (!camera && options.fov_deg)
    camera = camera_from_fov(*options.fov_deg, info.pixel_aspect, info.display_window.min_x, info.display_window.min_y,
                             info.display_window.width(), info.display_window.height());
  if (camera && options.near_plane) camera->near_m = *options.near_plane * options.metres_per_unit;
  if (camera && options.far_plane) camera->far_m = *options.far_plane * options.metres_per_unit;
  return camera;
}

DepthContext depth_context(const SourceOptions& options, const std::optional<Camera>& camera, Window window) {
  DepthContext depth{camera, options.near_plane, options.far_plane, options.metres_per_unit, window};
  if (camera && camera->near_m) depth.near_plane = *camera->near_m / options.metres_per_unit;
  if (camera && camera->far_m) depth.far_plane = *camera->far_m / options.metres_per_unit;
  return depth;
}

namespace {

/// The file of the first frame; a sibling sequence that lacks it is judged by the first that it has.
const std::string& first_path(const Sequence& sequence, int number) {
  const std::string* path = sequence.path(number);
  return path ? *path : sequence.entries().front().path;
}

/// What can be loaded with the camera there is, and whether depth can be made planar with it.
void check_roles(ViewState& state, const SourceOptions& options, const std::optional<Camera>& camera) {
  for (const RoleBinding& binding : state.roles) {
    // Ray distances that only a profile guessed are left aside without a lens; asked for, they are an error.
    if (is_depth(binding.role) && binding.encoding.depth_kind == DepthKind::ray && !camera && !options.depth_kind)
      continue;
    if (is_depth(binding.role))
      with_context(cat(info(binding.role).name, " (", binding.why, ")"),
                   [&] { check_depth(binding.encoding, depth_context(options, camera, {})); });
    const bool needs_position = binding.role == Role::normal && binding.encoding.normal_space == NormalSpace::world;
    if (!needs_position || (camera && camera->world_to_camera)) state.available.insert(binding.role);
  }
}

}  // namespace

Resolved resolve(const SourceOptions& options) {
  if (options.sequence.empty()) throw Error(ErrorCode::no_input, "the input has no frames");
  const int number = options.first_frame.value_or(options.sequence.entries().front().frame);
  const std::string* path = options.sequence.path(number);
  if (!path) throw Error(ErrorCode::no_input, cat("the input has no frame ", number));
  const ExrReader file(*path, options.limits);
  Resolved out;
  out.first = file.info();
  for (const Sibling& sibling : options.siblings) {
    if (sibling.sequence.empty())
      throw Error(ErrorCode::no_input, cat("--role ", info(sibling.role).name, ": there are no frames"));
    out.siblings.push_back(ExrReader(first_path(sibling.sequence, number), options.limits).info());
    with_context(cat("--role ", info(sibling.role).name, " (", out.siblings.back().path, ")"),
                 [&] { check_same_shape(out.siblings.back(), out.first); });
  }
  const auto cryptomattes = cryptomatte_names(file);
  for (const std::string& view : views_of(out.first)) {
    ViewState state;
    state.roles = bind_roles(out, options, view);
    for (const RoleBinding& binding : state.roles)
      refuse_uint(binding.sibling < 0 ? out.first : out.siblings[static_cast<size_t>(binding.sibling)],
                  binding.channels, info(binding.role).name);
    state.colors = resolve_colors(out.first, view, options.profile, options.channel_overrides, cryptomattes);
    state.part = part_of_view(out.first, view, state.colors);
    state.layers = choose_layers(out.first, view, state.colors, options, cryptomattes);
    state.named = choose_named(out.first, view, options, cryptomattes);
    const auto camera = with_context(out.first.path, [&] { return find_camera(file, options, number, view, nullptr); });
    state.header_camera = has_header_camera(file, options, view);
    check_roles(state, options, camera);
    out.views[view] = std::move(state);
  }
  return out;
}

}  // namespace aftershade::io
