#include <algorithm>
#include <iterator>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/source_state.h"

namespace aftershade::io {

std::string window_text(Window w) { return cat("(", w.min_x, ", ", w.min_y, ")-(", w.max_x, ", ", w.max_y, ")"); }

namespace {

[[noreturn]] void differs(std::string_view what, std::string_view here, std::string_view there, const FileInfo& first) {
  throw Error(ErrorCode::data, cat(what, " is ", here, ", but ", there, " in the first frame (", first.path, ")"),
              "a sequence must keep its shape; process the frames before and after the change separately");
}

}  // namespace

void check_same_shape(const FileInfo& frame, const FileInfo& first) {
  if (frame.display_window != first.display_window)
    differs("the displayWindow", window_text(frame.display_window), window_text(first.display_window), first);
  if (frame.pixel_aspect != first.pixel_aspect)
    differs("pixelAspectRatio", cat(frame.pixel_aspect), cat(first.pixel_aspect), first);
}

void check_part(const FileInfo& frame, const FileInfo& first, int part) {
  if (static_cast<size_t>(part) >= frame.parts.size())
    differs("the number of parts", cat(frame.parts.size()), cat(first.parts.size()), first);
}

void check_channel(const FileInfo& frame, const FileInfo& first, const ChannelRef& ref, std::string_view use) {
  const auto part = static_cast<size_t>(ref.part);
  if (part < frame.parts.size() && frame.parts[part].find(ref.channel)) return;
  const std::string where =
      first.parts.size() > 1 ? cat(" in part ", ref.part, " (\"", first.parts[part].name, "\")") : "";
  throw Error(ErrorCode::data,
              cat("channel ", ref.channel, where, " (", use, ") is missing; the first frame (", first.path, ") has it"),
              "render the frame again, or leave it out with --frames");
}

void check_channel_set(const FileInfo& frame, const FileInfo& first) {
  const auto names_of = [](const FileInfo& info) {
    std::set<std::string> names;
    for (size_t part = 0; part < info.parts.size(); ++part)
      for (const ChannelInfo& channel : info.parts[part].channels)
        names.insert(
            cat(channel.name, " (", to_text(channel.type), info.parts.size() > 1 ? cat(", part ", part) : "", ")"));
    return names;
  };
  const std::set<std::string> here = names_of(frame), there = names_of(first);
  std::vector<std::string> more, fewer;
  std::ranges::set_difference(here, there, std::back_inserter(more));
  std::ranges::set_difference(there, here, std::back_inserter(fewer));
  if (more.empty() && fewer.empty()) return;
  throw Error(ErrorCode::data,
              cat("the channels differ from those of the first frame (", first.path,
                  "):", more.empty() ? "" : " here only " + join(more, ", "), more.empty() || fewer.empty() ? "" : ";",
                  fewer.empty() ? "" : " there only " + join(fewer, ", ")),
              "a sequence must keep its shape; process the frames before and after the change separately");
}

}  // namespace aftershade::io
