#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/channel_names.h"
#include "core/io/decoded_file.h"
#include "core/io/file_source.h"

namespace aftershade::io {

namespace {

bool has(const std::vector<ChannelWrite>& writes, int part, const std::string& channel) {
  return std::ranges::any_of(writes, [&](const ChannelWrite& w) { return w.part == part && w.channel == channel; });
}

/// The pixels of `wanted` that a plane of the frame has.
ChannelWrite write_of(int part, const std::string& channel, const Frame& frame, ConstPlaneView plane, Window wanted) {
  ChannelWrite write{.part = part, .channel = channel, .pixels = {}, .window = intersection(frame.window, wanted)};
  if (!write.window.empty())
    write.pixels = {plane.row(write.window.min_y - frame.window.min_y) + (write.window.min_x - frame.window.min_x),
                    write.window.width(), write.window.height(), plane.stride};
  return write;
}

/// A layer that is common to several views is written once.
void add_layers(const Frame& frame, std::vector<ChannelWrite>& writes) {
  for (const Layer& layer : frame.layers)
    for (size_t i = 0; layer.changed && i < layer.planes.size(); ++i)
      if (!has(writes, layer.part, layer.channels[i]))
        writes.push_back(write_of(layer.part, layer.channels[i], frame, layer.planes[i], layer.data_window));
}

/// The data window of Frame::part, or what the beauty makes of it.
Window window_of_added(const PartInfo& part, const Frame& frame) {
  Window window = part.data_window;
  for (const Layer& layer : frame.layers)
    if (layer.is_beauty && layer.changed && layer.part == frame.part) window = united(window, layer.data_window);
  return window;
}

/// A channel of the file that a filter has changed. One that is common to several views is written once.
void add_named(const FileInfo& info, const Frame& frame, const std::string& name, const Plane& plane,
               std::vector<ChannelWrite>& writes) {
  const ChannelRef ref = find_channel(info, frame.view, name);
  if (!has(writes, ref.part, ref.channel))
    writes.push_back(
        write_of(ref.part, ref.channel, frame, plane, info.parts.at(static_cast<size_t>(ref.part)).data_window));
}

/// `alone`: the file will have the added channels alone, so that none of them exists.
void add_channels(const FileInfo& info, const Frame& frame, bool alone, std::vector<ChannelWrite>& writes) {
  const PartInfo& part = info.parts.at(static_cast<size_t>(frame.part));
  for (const auto& [name, plane] : frame.added) {
    if (frame.named.contains(name)) {
      if (!alone) add_named(info, frame, name, plane, writes);
      continue;
    }
    std::string channel = name_for_view(info, name, frame.view);
    if (has(writes, frame.part, channel)) channel = cat(frame.view, ".", channel);  // several views in one part
    writes.push_back(write_of(frame.part, channel, frame, plane, window_of_added(part, frame)));
    writes.back().is_new = alone || part.find(channel) == nullptr;
  }
}

}  // namespace

namespace {

/// The open file that came with the frames, and all their decoded parts; null when they have none of this file.
std::shared_ptr<const DecodedFile> file_of(const std::vector<Frame>& views, const std::string& path,
                                           PackedParts& parts) {
  std::shared_ptr<const DecodedFile> first;
  for (const Frame& frame : views) {
    const auto file = std::dynamic_pointer_cast<const DecodedFile>(frame.file);
    if (!file || file->reader.info().path != path) continue;
    parts.insert(file->parts.begin(), file->parts.end());
    if (!first) first = file;
  }
  return first;
}

}  // namespace

FileSink::FileSink(const Sequence& sources, SinkOptions options) : sources_(sources), options_(std::move(options)) {}

void FileSink::write(int number, const std::vector<Frame>& views) {
  const std::string* source = sources_.path(number);
  if (!source) throw Error(ErrorCode::internal, cat("frame ", number, " has no source file"));
  const std::string target = options_.path(number);
  with_context(cat("frame ", number, " (", target, ")"), [&] {
    PackedParts decoded;
    const auto kept = file_of(views, *source, decoded);
    std::optional<ExrReader> opened;
    const ExrReader& file = kept ? kept->reader : opened.emplace(*source, options_.limits);
    std::vector<ChannelWrite> writes;
    for (const Frame& frame : views) add_layers(frame, writes);
    for (const Frame& frame : views) add_channels(file.info(), frame, options_.write.only_new_channels, writes);
    for (const std::string& note : write_exr(file, writes, target, options_.write, decoded))
      if (options_.on_note) options_.on_note(number, note);
  });
}

}  // namespace aftershade::io
