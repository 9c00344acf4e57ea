#include "core/io/exr_plan.h"

#include <algorithm>
#include <set>

#include "core/io/exr_limits.h"

namespace aftershade::io {

namespace {
const CompressionInfo& info_of(int compression) { return kCompressions[static_cast<size_t>(compression)]; }

std::string part_label(const RawPart& part, size_t index, size_t count) {
  if (count == 1) return "";
  return part.name.empty() ? cat("part ", index, ": ") : cat("part ", part.name, ": ");
}

/// The compression of a part that is encoded again: the source's, ZIP in place of a lossy one, or what the user wants.
int choose_compression(int source, const std::optional<std::string>& wanted, const std::string& label,
                       std::vector<std::string>& notes) {
  const int chosen = wanted && *wanted != "keep" ? *compression_from_name(*wanted) : source;
  const std::string name(info_of(chosen).name);
  const bool rounds = info_of(chosen).lossy || name == "pxr24";  // 24 bits of a float
  if (wanted && rounds)
    notes.push_back(cat(label, "compression ", name, " loses precision, in the part's unchanged channels too"));
  if (wanted || !info_of(source).lossy) return chosen;
  notes.push_back(cat(label, "compression ", name, " is lossy, written as zip"));
  return *compression_from_name("zip");
}

/// Attributes that speak of the unchanged picture.
void drop_stale(RawHeader& header, const std::string& label, std::vector<std::string>& notes) {
  if (header.erase("preview")) notes.push_back(cat(label, "attribute preview dropped: it shows the picture as it was"));
  if (header.erase("acesImageContainerFlag"))
    notes.push_back(cat(label, "attribute acesImageContainerFlag dropped: the file is no longer an ACES container"));
}

void check_write(const ExrReader::Handles& source, const ChannelWrite& write, bool may_exist) {
  const auto fail = [&](std::string_view what) {
    throw Error(ErrorCode::internal, cat("channel ", write.channel, " of ", part_text(source.info, write.part), what));
  };
  if (write.part < 0 || static_cast<size_t>(write.part) >= source.info.parts.size()) fail(": there is no such part");
  const PartInfo& part = source.info.parts[static_cast<size_t>(write.part)];
  const bool exists = part.find(write.channel) != nullptr;
  if (write.is_new && exists && !may_exist) fail(" is to be added but exists");
  if (!write.is_new && !exists) fail(" is to be changed but does not exist");
  if (write.pixels.width < write.window.width() || write.pixels.height < write.window.height())
    fail(": the pixels do not cover their window");
}

Window window_of(const PlannedPart& part, const ExrReader::Handles& source, DataWindowPolicy policy) {
  Window window = part.geometry.window;
  if (policy == DataWindowPolicy::grow)
    for (const PlannedPart::Write& write : part.writes) window = united(window, write.write->window);
  check_window(window, cat("the new dataWindow of ", part_text(source.info, part.source_part)), source.limits);
  return window;
}

/// Brings the header in line with channels and geometry. Attributes whose value stays are not touched.
void update_header(PlannedPart& part, const Geometry& before, bool channels_changed) {
  RawHeader& header = part.header;
  const Geometry& now = part.geometry;
  if (channels_changed) header.set("channels", "chlist", format_channels(part.channels));
  if (now.compression != before.compression)
    header.set("compression", "compression", bytes_of(static_cast<uint8_t>(now.compression)));
  if (now.line_order != before.line_order)
    header.set("lineOrder", "lineOrder", bytes_of(static_cast<uint8_t>(now.line_order)));
  if (now.window != before.window) header.set("dataWindow", "box2i", bytes_of(now.window));
  if (header.find("chunkCount") != nullptr)
    header.set("chunkCount", "int", bytes_of(static_cast<int32_t>(now.chunk_count())));
}

PlannedPart plan_part(const RawPart& raw, int index, std::span<const ChannelWrite> writes) {
  PlannedPart part{index, raw.header, raw.geometry, raw.channels, true, {}, false};
  for (const ChannelWrite& write : writes)
    if (write.part == index) part.writes.push_back({write.channel, &write});
  return part;
}

Plan plan_all_parts(const ExrReader::Handles& source, std::span<const ChannelWrite> writes,
                    const WriteOptions& options) {
  Plan plan{source.layout.version, {}, {}};
  const auto& parts = source.layout.parts;
  for (size_t i = 0; i < parts.size(); ++i) {
    const std::string label = part_label(parts[i], i, parts.size());
    PlannedPart part = plan_part(parts[i], static_cast<int>(i), writes);
    if (!writes.empty()) drop_stale(part.header, label, plan.notes);
    part.encode = options.recode || !part.writes.empty();
    if (part.encode) {
      for (const PlannedPart::Write& write : part.writes)
        if (write.write->is_new) part.channels.push_back(RawChannel{write.channel});
      std::ranges::sort(part.channels, {}, &RawChannel::name);  // OpenEXR encodes them in this order
      part.geometry.window = window_of(part, source, options.data_window);
      part.geometry.compression = choose_compression(part.geometry.compression, options.compression, label, plan.notes);
      update_header(part, parts[i].geometry, part.channels != parts[i].channels);
    }
    plan.parts.push_back(std::move(part));
  }
  return plan;
}

/// Channels of several parts (views) may share a name; in one part each needs its own, so the view goes in front, as
/// multi-view files have it.
std::string unique_name(const ExrReader::Handles& source, const ChannelWrite& write,
                        const std::set<std::string>& used) {
  if (!used.contains(write.channel)) return write.channel;
  const PartInfo& part = source.info.parts[static_cast<size_t>(write.part)];
  return cat(part.view.empty() ? part.name : part.view, ".", write.channel);
}

Plan plan_new_channels(const ExrReader::Handles& source, std::span<const ChannelWrite> writes,
                       const WriteOptions& options) {
  const auto first = std::ranges::find_if(writes, &ChannelWrite::is_new);
  if (first == writes.end()) throw Error(ErrorCode::internal, cat("there is no new channel for ", source.info.path));
  const RawPart& raw = source.layout.parts[static_cast<size_t>(first->part)];
  Plan plan{2, {}, {}};
  PlannedPart part{first->part, raw.header, raw.geometry, {}, false, {}, true};
  std::set<std::string> used;
  for (const ChannelWrite& write : writes) {
    if (!write.is_new) continue;
    const std::string name = unique_name(source, write, used);
    if (!used.insert(name).second) throw Error(ErrorCode::internal, cat("two new channels are called ", name));
    part.writes.push_back({name, &write});
    part.channels.push_back(RawChannel{name});
    const Window other = source.layout.parts[static_cast<size_t>(write.part)].geometry.window;
    part.geometry.window = united(part.geometry.window, other);
  }
  std::ranges::sort(part.channels, {}, &RawChannel::name);
  for (const std::string_view name : {"name", "type", "chunkCount", "view", "multiView", "tiles"})
    part.header.erase(name);
  drop_stale(part.header, "", plan.notes);
  part.geometry.window = window_of(part, source, options.data_window);
  part.geometry.compression = choose_compression(part.geometry.compression, options.compression, "", plan.notes);
  part.geometry.tile_width = part.geometry.tile_height = part.geometry.line_order = 0;
  update_header(part, raw.geometry, true);
  plan.parts.push_back(std::move(part));
  return plan;
}

/// The flag that allows names of more than 31 characters.
uint32_t long_names_flag(const Plan& plan) {
  constexpr size_t kShort = 31;
  for (const PlannedPart& part : plan.parts) {
    for (const RawChannel& channel : part.channels)
      if (channel.name.size() > kShort) return ExrLayout::kLongNames;
    for (const RawAttribute& attribute : part.header.attributes)
      if (attribute.name.size() > kShort || attribute.type.size() > kShort) return ExrLayout::kLongNames;
  }
  return 0;
}
}  // namespace

void check_compression(const std::string& name) {
  if (name == "keep" || compression_from_name(name)) return;
  std::string names;
  for (const CompressionInfo& known : kCompressions) names += cat(known.name, ", ");
  throw Error(ErrorCode::usage, cat("unknown compression \"", name, "\""), cat("one of ", names, "keep"));
}

Plan plan_output(const ExrReader::Handles& source, std::span<const ChannelWrite> writes, const WriteOptions& options) {
  if (options.compression) check_compression(*options.compression);
  for (const ChannelWrite& write : writes) check_write(source, write, options.only_new_channels);
  Plan plan =
      options.only_new_channels ? plan_new_channels(source, writes, options) : plan_all_parts(source, writes, options);
  plan.version |= long_names_flag(plan);
  return plan;
}

}  // namespace aftershade::io
