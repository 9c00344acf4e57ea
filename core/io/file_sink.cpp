#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/channel_names.h"
#include "core/io/file_source.h"

namespace aftershade::io {

namespace {

/// The part that a view's new channels go to: the beauty's, else the view's first.
int part_of_view(const FileInfo& info, const Frame& frame) {
  for (const Layer& layer : frame.layers)
    if (layer.is_beauty) return layer.part;
  for (size_t part = 0; part < info.parts.size(); ++part)
    if (info.parts[part].view == frame.view) return static_cast<int>(part);
  return 0;
}

/// A layer that is common to several views is written once.
bool has(const std::vector<ChannelWrite>& writes, int part, const std::string& channel) {
  return std::any_of(writes.begin(), writes.end(),
                     [&](const ChannelWrite& w) { return w.part == part && w.channel == channel; });
}

void add_writes(const FileInfo& info, const Frame& frame, std::vector<ChannelWrite>& writes) {
  for (const Layer& layer : frame.layers) {
    if (!layer.receives_ao && !layer.receives_blur) continue;
    for (size_t i = 0; i < layer.planes.size(); ++i)
      if (!has(writes, layer.part, layer.channels[i]))
        writes.push_back({.part = layer.part,
                          .channel = layer.channels[i],
                          .pixels = layer.planes[i],
                          .window = frame.window,
                          .is_new = false});
  }
  const int part = part_of_view(info, frame);
  for (const auto& [name, plane] : frame.added)
    writes.push_back({.part = part,
                      .channel = name_for_view(info, name, frame.view),
                      .pixels = plane,
                      .window = frame.window,
                      .is_new = true});
}

}  // namespace

FileSink::FileSink(const Sequence& sources, SinkOptions options) : sources_(sources), options_(std::move(options)) {}

void FileSink::write(int number, const std::vector<Frame>& views) {
  const std::string* source = sources_.path(number);
  if (!source) throw Error(ErrorCode::internal, cat("frame ", number, " has no source file"));
  const std::string target = options_.path(number);
  with_context(cat("frame ", number, " (", target, ")"), [&] {
    const ExrReader file(*source);
    std::vector<ChannelWrite> writes;
    for (const Frame& frame : views) add_writes(file.info(), frame, writes);
    for (const std::string& note : write_exr(file, writes, target, options_.write))
      if (options_.on_note) options_.on_note(number, note);
  });
}

}  // namespace aftershade::io
