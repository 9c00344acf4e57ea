#include "core/io/file_source.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/channel_names.h"
#include "core/io/conversions.h"
#include "core/io/source_state.h"

namespace aftershade::io {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What a plane holds where the file has no pixel, before conversion (conventions 5).
float outside(Role role) { return role == Role::depth ? kInfinity : kNan; }

std::optional<float> shutter_angle(const ExrReader& file) {
  for (int part = 0; part < static_cast<int>(file.info().parts.size()); ++part)
    if (const auto angle = file.number(part, "shutterAngle")) return static_cast<float>(*angle);
  return std::nullopt;
}

}  // namespace

struct FileSource::State {
  SourceOptions options;
  Resolved resolved;
  std::mutex mutex;
  std::set<std::string> said;

  const ViewState& view(const std::string& name) const;
  bool is_new(const std::string& note);
  void check(const FileInfo& frame, const ViewState& view) const;
  /// Files of one frame: the frame's own, and those of the siblings that hold roles.
  struct Files {
    explicit Files(ExrReader own) : frame(std::move(own)) {}
    const ExrReader& of(int sibling) const { return sibling < 0 ? frame : *siblings.at(sibling); }
    ExrReader frame;
    std::map<int, std::unique_ptr<ExrReader>> siblings;
  };
  void open_sibling(Files& files, const RoleBinding& binding, int number) const;
  Frame empty_frame(const ExrReader& file, int number, const std::string& view, std::vector<std::string>& notes) const;
  std::vector<const RoleBinding*> prepare_roles(Frame& frame, const ViewState& offer, RoleSet asked, Files& files,
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

bool FileSource::State::is_new(const std::string& note) {
  const std::lock_guard lock(mutex);
  return said.insert(note).second;
}

void FileSource::State::check(const FileInfo& frame, const ViewState& view_state) const {
  check_same_shape(frame, resolved.first);
  for (const RoleBinding& binding : view_state.roles)
    for (const ChannelRef& ref : binding.channels)
      if (binding.sibling < 0) check_channel(frame, resolved.first, ref, aftershade::info(binding.role).name);
  for (const LayerChoice& layer : view_state.layers)
    for (const ChannelRef& ref : layer.binding.channels)
      check_channel(frame, resolved.first, ref, layer.binding.is_beauty ? "colour" : layer.binding.layer);
}

void FileSource::State::open_sibling(Files& files, const RoleBinding& binding, int number) const {
  if (binding.sibling < 0 || files.siblings.contains(binding.sibling)) return;
  const auto index = static_cast<size_t>(binding.sibling);
  const std::string* path = options.siblings[index].sequence.path(number);
  const std::string role(aftershade::info(binding.role).name);
  if (!path)
    throw Error(ErrorCode::no_input, cat("the sequence of --role ", role, " has no frame ", number),
                cat("it has ", format_frames(options.siblings[index].sequence.frames())));
  with_context(cat("--role ", role, " (", *path, ")"), [&] {
    auto file = std::make_unique<ExrReader>(*path, options.limits);
    check_same_shape(file->info(), resolved.first);
    for (const ChannelRef& ref : binding.channels) check_channel(file->info(), resolved.siblings[index], ref, role);
    files.siblings[binding.sibling] = std::move(file);
  });
}

/// What the header says, without pixels.
Frame FileSource::State::empty_frame(const ExrReader& file, int number, const std::string& view_name,
                                     std::vector<std::string>& notes) const {
  Frame frame;
  frame.number = number;
  frame.view = view_name;
  frame.display = file.info().display_window;
  frame.pixel_aspect = file.info().pixel_aspect;
  frame.shutter_angle_deg = shutter_angle(file);
  std::string note;
  frame.camera = find_camera(file, options, number, view_name, &note);
  if (!note.empty()) notes.push_back(std::move(note));
  if (view(view_name).header_camera && !(frame.camera && frame.camera->world_to_camera))
    throw Error(ErrorCode::data,
                cat("the camera matrices are missing; the first file (", resolved.first.path, ") has them"),
                "render the frame again, or give --camera FILE");
  return frame;
}

/// The roles that will be read: their files opened, their planes registered with `reader`, not yet allocated.
std::vector<const RoleBinding*> FileSource::State::prepare_roles(Frame& frame, const ViewState& offer, RoleSet asked,
                                                                 Files& files, PlaneReader& reader,
                                                                 std::vector<std::string>& notes) const {
  std::vector<const RoleBinding*> roles;
  for (const RoleBinding& binding : offer.roles) {
    if (!asked.contains(binding.role)) continue;
    if (!offer.available.contains(binding.role)) {
      notes.push_back("the normals are in world space; without the camera's position they are not used");
      continue;
    }
    open_sibling(files, binding, frame.number);
    roles.push_back(&binding);
    auto& planes = frame.planes(binding.role);
    planes.resize(binding.channels.size());
    for (size_t i = 0; i < planes.size(); ++i)
      reader.add(files.of(binding.sibling), binding.channels[i], planes[i], binding.role == Role::depth);
  }
  return roles;
}

void FileSource::State::convert(Frame& frame, const RoleBinding& binding) const {
  auto& planes = frame.planes(binding.role);
  DepthContext depth{frame.camera, options.near_plane, options.far_plane, options.metres_per_unit, frame.window};
  if (frame.camera && frame.camera->near_m) depth.near_plane = *frame.camera->near_m / options.metres_per_unit;
  if (frame.camera && frame.camera->far_m) depth.far_plane = *frame.camera->far_m / options.metres_per_unit;
  switch (binding.role) {
    case Role::depth:
      return convert_depth(planes[0], binding.encoding, depth);
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

/// Empty layers and planes of the frame's window, registered with `reader`.
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
                .receives_ao = choice.ao,
                .receives_blur = choice.blur,
                .is_beauty = choice.binding.is_beauty};
    for (const ChannelRef& ref : choice.binding.channels) layer.channels.push_back(ref.channel);
    frame.layers.push_back(std::move(layer));
  }
  for (size_t i = 0; i < frame.layers.size(); ++i)
    for (size_t c = 0; c < frame.layers[i].planes.size(); ++c)
      reader.add(file, view.layers[i].binding.channels[c], frame.layers[i].planes[c], false);
}

void allocate(Frame& frame, const std::vector<const RoleBinding*>& roles) {
  for (const RoleBinding* binding : roles)
    for (Plane& plane : frame.planes(binding->role))
      plane = Plane(frame.window.width(), frame.window.height(), outside(binding->role));
  for (Layer& layer : frame.layers)
    for (Plane& plane : layer.planes) plane = Plane(frame.window.width(), frame.window.height(), 0.0F);
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
  return with_context(cat("frame ", number, " (", *path, ")"), [&]() -> std::optional<Frame> {
    const State& state = *state_;
    const ViewState& offer = state.view(view);
    State::Files files{ExrReader(*path, state.options.limits)};
    state.check(files.frame.info(), offer);
    std::vector<std::string> notes;
    Frame frame = state.empty_frame(files.frame, number, view, notes);
    PlaneReader reader;
    const auto roles = state.prepare_roles(frame, offer, asked, files, reader, notes);
    if (with_layers) prepare_layers(frame, offer, files.frame, reader);
    frame.window = reader.data_window();
    if (frame.window.empty()) frame.window = files.frame.info().parts.front().data_window;
    allocate(frame, roles);
    const NanReport report = reader.read(frame.window, state.options.nan_is_error);
    if (on_nan && !(report.nan.empty() && report.infinite.empty())) on_nan(number, report);
    for (const RoleBinding* binding : roles) state.convert(frame, *binding);
    for (const std::string& note : notes)
      if (on_note && state_->is_new(note)) on_note(number, note);
    return frame;
  });
}

const FileInfo& FileSource::info() const { return state_->resolved.first; }
std::vector<std::string> FileSource::views() const { return views_of(state_->resolved.first); }
const std::vector<RoleBinding>& FileSource::roles(const std::string& view) const { return state_->view(view).roles; }
const std::vector<ColorBinding>& FileSource::layers(const std::string& view) const { return state_->view(view).colors; }
RoleSet FileSource::available(const std::string& view) const { return state_->view(view).available; }

}  // namespace aftershade::io
