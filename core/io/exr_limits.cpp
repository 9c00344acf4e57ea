#include "core/io/exr_limits.h"

#include <limits>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/exr_handles.h"

namespace aftershade::io {

namespace {
[[noreturn]] void refuse(const std::string& part, const std::string& what, const std::string& hint = {}) {
  throw Error(ErrorCode::data, cat(part, " ", what), hint);
}

void check_kind(const RawPart& part, const std::string& text, bool multi_part) {
  if (part.type.starts_with("deep")) refuse(text, "is deep; only flat images can be read", "flatten it first");
  if (multi_part && part.type != "scanlineimage" && part.type != "tiledimage")
    refuse(text, cat("has the unknown type \"", part.type, "\""));
  if (part.level_mode != 0)
    refuse(text, cat("is ", part.level_mode == 1 ? "mip" : "rip", "-mapped; only images of one level can be read"),
           "write it without mip levels");
}

void check_channels(const RawPart& part, const std::string& text, int most) {
  if (part.channels.empty()) refuse(text, "has no channels");
  if (static_cast<int>(part.channels.size()) > most) refuse(text, cat("has more than ", most, " channels"));
  std::set<std::string_view> names;
  for (const RawChannel& channel : part.channels) {
    if (!names.insert(channel.name).second) refuse(text, cat("has two channels ", channel.name));
    if (channel.x_sampling != 1 || channel.y_sampling != 1)
      refuse(text, cat("has the subsampled channel ", channel.name, "; only full resolution can be read"),
             "convert it to RGB first");
  }
}

void check_size(const RawPart& part, const std::string& text, const ReadLimits& limits, int64_t file_size) {
  const Geometry& geometry = part.geometry;
  check_window(geometry.window, text, limits);
  const int64_t width = geometry.window.width(), height = geometry.window.height();
  const std::string size = cat(width, "x", height);
  const int64_t pixel = part.bytes_per_pixel(), bytes = width * height * pixel;
  if (bytes > limits.max_frame_bytes)
    refuse(text, cat("holds ", bytes >> 20, " MiB of pixels, more than ", limits.max_frame_bytes >> 20, " MiB"));
  const CompressionInfo& compression = kCompressions[static_cast<size_t>(geometry.compression)];
  const int64_t chunk_pixels =
      geometry.tiled() ? int64_t{geometry.tile_width} * geometry.tile_height : width * compression.rows;
  const int64_t largest = std::min(limits.max_frame_bytes, int64_t{std::numeric_limits<int>::max()});
  if (chunk_pixels > largest / pixel) refuse(text, cat("has chunks of more than ", largest >> 20, " MiB"));
  constexpr double kSlack = 16 << 20;
  if (compression.max_ratio > 0 &&
      static_cast<double>(bytes) > compression.max_ratio * static_cast<double>(file_size) + kSlack)
    refuse(text, cat("claims to hold ", size, " pixels, which ", file_size, " bytes of file cannot"));
}

void check_chunk_count(const RawPart& part, const std::string& text) {
  const auto declared = value_of<int32_t>(part.header.find("chunkCount"), "int");
  if (declared && *declared != part.geometry.chunk_count())
    refuse(text, cat("declares ", *declared, " chunks and must have ", part.geometry.chunk_count()));
}
}  // namespace

void check_window(Window window, std::string_view what, const ReadLimits& limits) {
  const int64_t width = int64_t{window.max_x} - window.min_x + 1, height = int64_t{window.max_y} - window.min_y + 1;
  if (width > limits.max_width || height > limits.max_height)
    refuse(std::string(what),
           cat("is ", width, "x", height, " pixels, larger than ", limits.max_width, "x", limits.max_height));
}

void check_parts(const ExrLayout& layout, const ReadLimits& limits, int64_t file_size, const FileInfo& info) {
  if ((layout.version & ExrLayout::kDeep) != 0 && !layout.multi_part() && layout.parts[0].type.empty())
    refuse(info.path, "is deep; only flat images can be read", "flatten it first");
  for (size_t i = 0; i < layout.parts.size(); ++i) {
    const RawPart& part = layout.parts[i];
    const std::string text = part_text(info, static_cast<int>(i));
    check_kind(part, text, layout.multi_part());
    check_channels(part, text, limits.max_channels);
    check_size(part, text, limits, file_size);
    if (layout.multi_part()) check_chunk_count(part, text);
  }
  check_window(info.display_window, cat("the displayWindow of ", info.path), limits);
}

}  // namespace aftershade::io
