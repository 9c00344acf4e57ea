#include "app/memory.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "core/base/memory_limit.h"

namespace aftershade::app {

namespace {

constexpr int64_t kFloat = sizeof(float);
/// Planes of a frame's size that stages have at once beside those that were read, their histories too: the most that
/// the shipped presets without a window use, by PlaneMemory::peak.
constexpr int64_t kStagePlanes = 16;
/// Planes that a stage with a window keeps of each frame in it.
constexpr int64_t kPlanesOfNeighbour = 10;
/// The program, its libraries and the buffers of chunks.
constexpr int64_t kFixed = int64_t{64} << 20;

int64_t pixels(Window window) { return int64_t{window.width()} * window.height(); }

int64_t bytes_of(io::PixelType type) { return type == io::PixelType::half ? 2 : 4; }

int64_t decoded_bytes(const io::PartInfo& part) {
  int64_t bytes = 0;
  for (const io::ChannelInfo& channel : part.channels) bytes += pixels(part.data_window) * bytes_of(channel.type);
  return bytes;
}

int64_t role_planes(RoleSet roles, RoleSet available) {
  int64_t planes = 0;
  for (const RoleInfo& role : kRoles)
    if (roles.contains(role.role) && available.contains(role.role)) planes += role.planes;
  return planes;
}

/// Channels of the layers that AO and blur change: the beauty where no option names others.
int64_t layer_planes(const InputArgs& args, const io::FileSource& source, const std::string& view) {
  std::set<std::string> names;
  for (const auto* list : {&args.ao_layers, &args.blur_layers}) {
    names.insert(list->begin(), list->end());
    if (list->empty()) names.insert("beauty");
  }
  int64_t planes = 0;
  for (const std::string& name : names) {
    const auto& layers = source.layers(view);
    const auto found = std::find_if(layers.begin(), layers.end(), [&](const io::ColorBinding& layer) {
      return name == (layer.is_beauty ? "beauty" : layer.layer);
    });
    planes += found == layers.end() ? 4 : static_cast<int64_t>(found->channels.size());
  }
  return planes;
}

/// Frames that stages hold back, and frames in their windows.
struct Windows {
  int64_t waiting = 0, neighbours = 0;
};
Windows windows_of(const pipeline::ViewPipeline& view) {
  Windows windows;
  for (const pipeline::Dependency& stage : view.dependencies()) {
    windows.waiting += stage.frames_after;
    if (stage.frames_before + stage.frames_after > 0)
      windows.neighbours += stage.frames_before + stage.frames_after + 1;
  }
  return windows;
}

}  // namespace

FrameCost frame_cost(const RenderArgs& args, const Job& job) {
  const io::FileInfo& info = job.input.source->info();
  Window window;
  int64_t decoded = 0;
  for (const io::PartInfo& part : info.parts) {
    window = united(window, part.data_window);
    decoded += decoded_bytes(part);
  }
  const int64_t plane = pixels(window) * kFloat;
  FrameCost cost;
  for (const pipeline::ViewPipeline& view : job.views) {
    const bool layers = view.layers(view.stages());
    const int64_t written = layers ? layer_planes(args, *job.input.source, view.view()) : 1;
    const int64_t roles = role_planes(view.roles(view.stages()), job.input.source->available(view.view()));
    const int64_t named = static_cast<int64_t>(job.named_channels);
    const int64_t read = (roles + named + (layers ? written : 0)) * plane;
    const Windows windows = windows_of(view);
    cost.read += read;
    cost.writing += (written + named) * plane;
    if (view.stages() > 0)
      cost.computing += kStagePlanes * plane + windows.waiting * (read + (job.keep_file ? decoded : 0)) +
                        windows.neighbours * kPlanesOfNeighbour * plane;
  }
  if (job.keep_file) cost.read += decoded;
  cost.computing += cost.read;
  cost.writing += 2 * decoded;  // packed as much as unpacked, at most
  return cost;
}

int64_t peak_of(const FrameCost& cost, size_t frames_in_flight) {
  if (frames_in_flight <= 1) return kFixed + std::max(cost.computing, cost.writing);
  const int64_t three = cost.computing + cost.read + cost.writing;
  return kFixed + (frames_in_flight == 2 ? three - cost.read : three);
}

size_t frames_in_flight(const FrameCost& cost, int64_t limit) {
  size_t frames = 3;
  while (frames > 1 && peak_of(cost, frames) > limit) --frames;
  return frames;
}

int64_t memory_limit(const std::string& option) {
  if (option.empty()) {
    const auto usable = usable_memory();
    return usable ? *usable / 2 : std::numeric_limits<int64_t>::max();
  }
  if (const auto size = parse_size(option)) return *size;
  throw Error(ErrorCode::usage, "--memory " + option + " is no size", "a number with K, M, G or T, such as 2G");
}

}  // namespace aftershade::app
