#include "core/io/file_source.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/channel_names.h"
#include "core/io/conversions.h"
#include "core/io/decoded_file.h"
#include "core/io/exr_limits.h"
#include "core/io/source_state.h"

namespace aftershade::io {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What a plane holds where the file has no pixel, before conversion (conventions 5).
float outside(Role role) { return is_depth(role) ? kInfinity : kNan; }

std::optional<float> shutter_angle(const ExrReader& file) {
  for (int part = 0; part < static_cast<int>(file.info().parts.size()); ++part)
    if (const auto angle = file.number(part, "shutterAngle")) return static_cast<float>(*angle);
  return std::nullopt;
}

}  // namespace

struct FileSource::State {
  SourceOptions options;
  Resolved resolved;

  const ViewState& view(const std::string& name) const;
  void check(const FileInfo& frame, const ViewState& view) const;
  /// Files of one frame: the frame's own, and those of the siblings that hold roles.
  struct Files {
    const ExrReader* find(int sibling) const {
      if (sibling < 0) return &frame;
      const auto found = siblings.find(sibling);
      return found == siblings.end() ? nullptr : found->second.get();
    }
    const ExrReader& frame;
    std::map<int, std::unique_ptr<ExrReader>> siblings{};
  };
  void open_siblings(Files& files, const ViewState& offer, RoleSet asked, int number) const;
  void open_sibling(Files& files, const RoleBinding& binding, const std::string& path) const;
  Window working_window(const Files& files, const ViewState& offer) const;
  Frame empty_frame(const Files& files, int number, const std::string& view, std::vector<std::string>& notes) const;
  std::vector<const RoleBinding*> prepare_roles(Frame& frame, const ViewState& offer, RoleSet asked, const Files& files,
                                                PlaneReader& reader, std::vector<std::string>& notes) const;
  void convert(Frame& frame, const RoleBinding& binding) const;
};

const ViewState& FileSource::State::view(const std::string& name) const {
  const auto found = resolved.views.find(name);
  if (found != resolved.views.end()) return found->second;
  const std::vector<std::string> views = views_of(resolved.first);
  if (views.size() == 1 && views.front().empty())
    throw Error(ErrorCode::usage, cat("there is no view \"", name, "\": ", resolved.first.path, " has no views"),
                "leave --view out");
  throw Error(ErrorCode::usage, cat("there is no view \"", name, "\""), "views are " + join(views, ", "));
}

void FileSource::State::check(const FileInfo& frame, const ViewState& view_state) const {
  check_same_shape(frame, resolved.first);
  check_part(frame, resolved.first, view_state.part);
  for (const RoleBinding& binding : view_state.roles)
    for (const ChannelRef& ref : binding.channels)
      if (binding.sibling < 0) check_channel(frame, resolved.first, ref, aftershade::info(binding.role).name);
  for (const LayerChoice& layer : view_state.layers)
    for (const ChannelRef& ref : layer.binding.channels)
      check_channel(frame, resolved.first, ref, layer.binding.is_beauty ? "colour" : layer.binding.layer);
  for (const NamedChoice& named : view_state.named) check_channel(frame, resolved.first, named.ref, "to be filtered");
  check_channel_set(frame, resolved.first);
}

/// All that the frame has, because their windows count whatever is loaded; those of roles asked for must be there.
void FileSource::State::open_siblings(Files& files, const ViewState& offer, RoleSet asked, int number) const {
  for (const RoleBinding& binding : offer.roles) {
    if (binding.sibling < 0 || !offer.available.contains(binding.role)) continue;
    const Sequence& sequence = options.siblings[static_cast<size_t>(binding.sibling)].sequence;
    const std::string* path = sequence.path(number);
    if (path)
      open_sibling(files, binding, *path);
    else if (asked.contains(binding.role))
      throw Error(ErrorCode::no_input,
                  cat("the sequence of --role ", aftershade::info(binding.role).name, " has no frame ", number),
                  cat("it has ", format_frames(sequence.frames())));
  }
}

void FileSource::State::open_sibling(Files& files, const RoleBinding& binding, const std::string& path) const {
  const auto index = static_cast<size_t>(binding.sibling);
  const std::string role(aftershade::info(binding.role).name);
  with_context(cat("--role ", role, " (", path, ")"), [&] {
    auto file = std::make_unique<ExrReader>(path, options.limits);
    check_same_shape(file->info(), resolved.first);
    for (const ChannelRef& ref : binding.channels) check_channel(file->info(), resolved.siblings[index], ref, role);
    files.siblings[binding.sibling] = std::move(file);
  });
}

/// The union of the windows of everything that the view could load from these files, and of the part that added
/// channels go to.
Window FileSource::State::working_window(const Files& files, const ViewState& offer) const {
  Window window = data_window(files.frame, offer.part);
  for (const RoleBinding& binding : offer.roles)
    if (const ExrReader* file = files.find(binding.sibling); file && offer.available.contains(binding.role))
      for (const ChannelRef& ref : binding.channels) window = united(window, data_window(*file, ref.part));
  for (const LayerChoice& layer : offer.layers)
    for (const ChannelRef& ref : layer.binding.channels) window = united(window, data_window(files.frame, ref.part));
  for (const NamedChoice& named : offer.named) window = united(window, data_window(files.frame, named.ref.part));
  constexpr std::string_view kWhat = "the union of all data windows";
  check_window(window, kWhat, options.limits);
  if (int64_t{window.width()} * window.height() > options.limits.max_frame_bytes / int64_t{sizeof(float)})
    throw Error(ErrorCode::data, cat(kWhat, " is ", window_text(window), ", too large for ",
                                     options.limits.max_frame_bytes >> 20, " MiB"));
  return window;
}

/// What the headers say, without pixels.
Frame FileSource::State::empty_frame(const Files& files, int number, const std::string& view_name,
                                     std::vector<std::string>& notes) const {
  const ExrReader& file = files.frame;
  Frame frame;
  frame.number = number;
  frame.view = view_name;
  frame.part = view(view_name).part;
  frame.window = working_window(files, view(view_name));
  frame.display = file.info().display_window;
  frame.pixel_aspect = file.info().pixel_aspect;
  frame.shutter_angle_deg = shutter_angle(file);
  std::string note;
  frame.camera = find_camera(file, options, number, view_name, &note);
  if (!note.empty()) notes.push_back(std::move(note));
  if (view(view_name).header_camera && !(frame.camera && frame.camera->world_to_camera))
    throw Error(ErrorCode::data,
                cat("the camera matrices are missing; the first frame (", resolved.first.path, ") has them"),
                "render the frame again, or give --camera FILE");
  return frame;
}

/// The roles that will be read: their planes registered with `reader`, not yet allocated.
std::vector<const RoleBinding*> FileSource::State::prepare_roles(Frame& frame, const ViewState& offer, RoleSet asked,
                                                                 const Files& files, PlaneReader& reader,
                                                                 std::vector<std::string>& notes) const {
  std::vector<const RoleBinding*> roles;
  for (const RoleBinding& binding : offer.roles) {
    if (!asked.contains(binding.role)) continue;
    if (!offer.available.contains(binding.role)) {
      notes.push_back("the normals are in world space; without the camera's position they are not used");
      continue;
    }
    roles.push_back(&binding);
    auto& planes = frame.planes(binding.role);
    planes.resize(binding.channels.size());
    for (size_t i = 0; i < planes.size(); ++i)
      reader.add(*files.find(binding.sibling), binding.channels[i], planes[i], outside(binding.role),
                 is_depth(binding.role));
  }
  return roles;
}

void FileSource::State::convert(Frame& frame, const RoleBinding& binding) const {
  auto& planes = frame.planes(binding.role);
  switch (binding.role) {
    case Role::depth:
      return convert_depth(planes[0], binding.encoding, depth_context(options, frame.camera, frame.window));
    case Role::depth2:
      convert_depth(planes[0], binding.encoding, depth_context(options, frame.camera, frame.window));
      if (frame.has(Role::depth)) drop_not_beyond(planes[0], frame.depth());
      return;
    case Role::normal:
      return convert_normals(planes, binding.encoding, frame.camera, frame.window);
    case Role::velocity_prev:
    case Role::velocity_next:
      return convert_velocity(planes, binding.encoding, frame.display);
    case Role::ambient:
      return convert_values(planes, binding.encoding, 0.0F);
    case Role::ao:
      return convert_values(planes, binding.encoding, 1.0F);
  }
}

namespace {

/// Layers whose planes are registered with `reader`, not yet allocated.
void prepare_layers(Frame& frame, const ViewState& view, const ExrReader& file, PlaneReader& reader) {
  if (view.layers.empty())
    throw Error(
        ErrorCode::no_input, "there are no colour channels",
        cat("name them with --channel color=R,G,B; the file has ", ViewChannels(file.info(), frame.view).listed()));
  for (const LayerChoice& choice : view.layers) {
    Layer layer{.name = choice.binding.layer,
                .channels = {},
                .planes = std::vector<Plane>(choice.binding.channels.size()),
                .alpha = choice.binding.alpha,
                .part = choice.binding.channels.front().part,
                .data_window = data_window(file, choice.binding.channels.front().part),
                .receives_ao = choice.ao,
                .receives_blur = choice.blur,
                .is_beauty = choice.binding.is_beauty,
                .changed = false};
    for (const ChannelRef& ref : choice.binding.channels) layer.channels.push_back(ref.channel);
    frame.layers.push_back(std::move(layer));
  }
  for (size_t i = 0; i < frame.layers.size(); ++i)
    for (size_t c = 0; c < frame.layers[i].planes.size(); ++c)
      reader.add(file, view.layers[i].binding.channels[c], frame.layers[i].planes[c], 0.0F);
}

/// The same for named channels.
void prepare_named(Frame& frame, const ViewState& view, const ExrReader& file, PlaneReader& reader) {
  for (const NamedChoice& named : view.named) reader.add(file, named.ref, frame.named[named.name], kNan);
}

/// The parts that a sink will write again, as far as this view tells: still without pixels.
PackedParts parts_to_keep(const Frame& frame, const ViewState& view) {
  PackedParts parts{{frame.part, nullptr}};
  for (const Layer& layer : frame.layers) parts[layer.part] = nullptr;
  for (const NamedChoice& named : view.named) parts[named.ref.part] = nullptr;
  return parts;
}

}  // namespace

FileSource::FileSource(SourceOptions options) : state_(std::make_unique<State>()) {
  state_->resolved = resolve(options);
  state_->options = std::move(options);
}
FileSource::~FileSource() = default;

std::optional<Frame> FileSource::load(int number, const std::string& view, RoleSet asked, bool with_layers) {
  const std::string* path = state_->options.sequence.path(number);
  if (!path) return std::nullopt;
  if (asked.contains(Role::depth2)) asked.insert(Role::depth);
  return with_context(cat("frame ", number, " (", *path, ")"), [&]() -> std::optional<Frame> {
    const State& state = *state_;
    const ViewState& offer = state.view(view);
    const auto file = std::make_shared<DecodedFile>(ExrReader(*path, state.options.limits));
    State::Files files{file->reader};
    state.check(files.frame.info(), offer);
    std::vector<std::string> notes;
    state.open_siblings(files, offer, asked, number);
    Frame frame = state.empty_frame(files, number, view, notes);
    PlaneReader reader;
    const auto roles = state.prepare_roles(frame, offer, asked, files, reader, notes);
    if (with_layers) prepare_layers(frame, offer, files.frame, reader);
    prepare_named(frame, offer, files.frame, reader);
    if (with_layers && state.options.keep_file) {
      file->parts = parts_to_keep(frame, offer);
      frame.file = file;
    }
    const NanReport report = reader.read(frame.window, state.options.nan_is_error, &file->reader, &file->parts);
    std::erase_if(file->parts, [](const auto& part) { return part.second == nullptr; });
    if (on_nan && !(report.nan.empty() && report.infinite.empty())) on_nan(number, report);
    for (const RoleBinding* binding : roles) state.convert(frame, *binding);
    for (const std::string& note : notes)
      if (on_note) on_note(number, note);
    return frame;
  });
}

void FileSource::check_layers_and_named(const std::string& view) const {
  const ViewState& offer = state_->view(view);
  for (const NamedChoice& named : offer.named)
    for (const LayerChoice& layer : offer.layers)
      if (std::ranges::find(layer.binding.channels, named.ref) != layer.binding.channels.end())
        throw Error(
            ErrorCode::usage,
            cat("channel \"", named.name, "\" is to be filtered, but it belongs to the layer \"",
                layer.binding.is_beauty ? "beauty" : layer.binding.layer, "\", which other stages change"),
            "choose other layers with --ao-layers and --blur-layers, or filter the channel in a run of its own");
}

void FileSource::keep_files(bool keep) { state_->options.keep_file = keep; }
const FileInfo& FileSource::info() const { return state_->resolved.first; }
std::vector<std::string> FileSource::views() const { return views_of(state_->resolved.first); }
const std::vector<RoleBinding>& FileSource::roles(const std::string& view) const { return state_->view(view).roles; }
const std::vector<ColorBinding>& FileSource::layers(const std::string& view) const { return state_->view(view).colors; }
bool FileSource::has_header_camera(const std::string& view) const { return state_->view(view).header_camera; }

RoleSet FileSource::available(const std::string& view) const { return state_->view(view).available; }

}  // namespace aftershade::io
