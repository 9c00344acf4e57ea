#include "core/io/exr_encode.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>

#include "core/io/exr_codec.h"
#include "core/parallel/rows.h"

namespace aftershade::io {

namespace {
/// Depth of pixels that nothing wrote is background; every other channel's is 0 (black, transparent, no motion, no id).
float outside_value(const RawChannel& channel) {
  const bool is_depth = channel.name == "Z" || channel.name.ends_with(".Z");
  return is_depth && channel.type != PixelType::uint ? std::numeric_limits<float>::infinity() : 0.0F;
}

/// Rows of the output: the source's pixels with the writes over them.
class Rows {
 public:
  Rows(const PlannedPart& part, const PackedImage* decoded) : layout_(part.channels), decoded_(decoded) {
    for (const RawChannel& channel : layout_.channels) {
      const auto write = std::ranges::find(part.writes, channel.name, &PlannedPart::Write::channel);
      channels_.push_back({.source = decoded != nullptr ? decoded->layout.find(channel.name) : -1,
                           .write = write != part.writes.end() ? write->write : nullptr,
                           .outside = decoded != nullptr ? outside_value(channel) : 0.0F});
    }
  }
  const RowLayout& layout() const { return layout_; }

  /// The pixels of a channel in one row, where they are or composed in `scratch`. Sets `changed` when they are not the
  /// source's.
  const char* pixels(size_t c, Window row, std::vector<char>& scratch, bool& changed) const {
    const Channel& channel = channels_[c];
    const bool whole = channel.source >= 0 && intersection(row, decoded_->window) == row;
    const bool written = channel.write != nullptr && !intersection(row, channel.write->window).empty();
    if (whole && !written) return source_pixel(channel, row.min_x, row.min_y);
    scratch.resize(static_cast<size_t>(row.width() * bytes_per_pixel(layout_.channels[c].type)));
    if (!whole) fill_outside(c, row, scratch.data());
    copy_source(c, row, scratch.data());
    if (written) changed |= write(c, row, scratch.data());
    return scratch.data();
  }

 private:
  struct Channel {
    int source;  ///< index in the decoded part, or -1
    const ChannelWrite* write;
    float outside;
  };
  const char* source_pixel(const Channel& channel, int x, int y) const {
    return decoded_->pixel(static_cast<size_t>(channel.source), x, y);
  }
  /// What lies outside of the source's window; new channels are 0 inside.
  void fill_outside(size_t c, Window row, char* pixels) const {
    const RawChannel& channel = layout_.channels[c];
    const auto size = static_cast<size_t>(bytes_per_pixel(channel.type));
    char value[4] = {}, zero[4] = {};
    pack_row(channel.type, &channels_[c].outside, 1, value);
    for (int x = row.min_x; x <= row.max_x; ++x, pixels += size)
      std::memcpy(pixels, decoded_ != nullptr && !decoded_->window.contains(x, row.min_y) ? value : zero, size);
  }
  void copy_source(size_t c, Window row, char* pixels) const {
    const Channel& channel = channels_[c];
    if (channel.source < 0) return;
    const Window both = intersection(row, decoded_->window);
    if (both.empty()) return;
    const int64_t size = bytes_per_pixel(layout_.channels[c].type);
    std::memcpy(pixels + (both.min_x - row.min_x) * size, source_pixel(channel, both.min_x, row.min_y),
                static_cast<size_t>(both.width() * size));
  }
  bool write(size_t c, Window row, char* pixels) const {
    const ChannelWrite& write = *channels_[c].write;
    const Window both = intersection(row, write.window);
    const PixelType type = layout_.channels[c].type;
    return pack_row(type, write.pixels.row(row.min_y - write.window.min_y) + (both.min_x - write.window.min_x),
                    both.width(), pixels + (both.min_x - row.min_x) * bytes_per_pixel(type));
  }

  RowLayout layout_;
  const PackedImage* decoded_;
  std::vector<Channel> channels_;
};

/// What one thread needs for a chunk.
struct Scratch {
  ChunkEncoder encoder;
  std::vector<char> row, packed;
};
Scratch& scratch() {
  thread_local Scratch mine;
  return mine;
}

constexpr int kHeadBytes = 24;  // part number, coordinates, size

class PartEncoder {
 public:
  PartEncoder(const ExrReader::Handles& source, const PlannedPart& part, const PackedImage* decoded,
              std::optional<int32_t> part_number, bool recode)
      : source_(source),
        part_(part),
        raw_(source.layout.parts[static_cast<size_t>(part.source_part)]),
        rows_(part, decoded),
        part_number_(part_number),
        may_keep_(!recode && decoded != nullptr && raw_.geometry == part.geometry && raw_.channels == part.channels) {}

  /// Packed chunks lie in memory in the order in which they were finished, so that only as much is used as they take.
  PartChunks encode() {
    const int64_t count = part_.geometry.chunk_count();
    const int64_t most = rows_.layout().bytes(part_.geometry.window) + count * kHeadBytes;
    PartChunks out{std::vector<std::span<const char>>(static_cast<size_t>(count)), order(),
                   Buffer(static_cast<size_t>(most))};
    std::atomic<size_t> used = 0;
    for_rows(static_cast<int>(count), [&](int index) {
      const std::span<const char> chunk = encode_chunk(index);
      char* const target = out.memory.data() + used.fetch_add(chunk.size());
      std::memcpy(target, chunk.data(), chunk.size());
      out.bytes[static_cast<size_t>(index)] = {target, chunk.size()};
    });
    return out;
  }

 private:
  /// OpenEXR writes the rows of decreasing line order from the last on.
  std::vector<int64_t> order() const {
    const Geometry& geometry = part_.geometry;
    constexpr int kDecreasing = 1;
    std::vector<int64_t> order(static_cast<size_t>(geometry.chunk_count()));
    std::iota(order.begin(), order.end(), 0);
    if (geometry.line_order == kDecreasing)
      std::ranges::stable_sort(order, std::greater(), [&](int64_t i) { return i / geometry.chunks_across(); });
    return order;
  }

  /// In this thread's scratch.
  std::span<const char> encode_chunk(int64_t index) const {
    const Window window = part_.geometry.chunk_window(index);
    const auto bytes = static_cast<size_t>(rows_.layout().bytes(window));
    Scratch& mine = scratch();
    mine.packed.resize(kHeadBytes + bytes);
    char* const packed = mine.packed.data() + kHeadBytes;
    if (may_keep_ && !is_written(window)) return keep_chunk(index, packed);
    mine.encoder.start(bytes, rows_.layout().channels.size());
    bool changed = false;
    for (int y = window.min_y; y <= window.max_y; ++y)
      for (size_t c = 0; c < rows_.layout().channels.size(); ++c)
        mine.encoder.add(rows_.pixels(c, {window.min_x, y, window.max_x, y}, mine.row, changed),
                         static_cast<size_t>(window.width() * bytes_per_pixel(rows_.layout().channels[c].type)));
    if (may_keep_ && !changed) return keep_chunk(index, packed);
    return with_head(index, packed, mine.encoder.finish(part_.geometry.compression, packed));
  }

  bool is_written(Window window) const {
    return std::ranges::any_of(part_.writes, [&](const PlannedPart::Write& write) {
      return !intersection(window, write.write->window).empty();
    });
  }

  /// The source's own chunk. A stored one may be longer than its pixels: what counts of it is as long as they are.
  std::span<const char> keep_chunk(int64_t index, char* packed) const {
    const ChunkPlace place = find_chunk(source_.layout, part_.source_part, index, source_.bytes);
    const auto most = static_cast<size_t>(rows_.layout().bytes(part_.geometry.chunk_window(index)));
    const std::span<char> bytes(packed, std::min(static_cast<size_t>(place.packed_bytes), most));
    source_.bytes.read_at(place.start + place.leader_bytes, bytes);
    return with_head(index, packed, bytes.size());
  }

  std::span<const char> with_head(int64_t index, char* packed, size_t bytes) const {
    char head[kHeadBytes];
    size_t size = 0;
    if (part_number_) std::memcpy(head, &*part_number_, size = sizeof(int32_t));
    size += static_cast<size_t>(format_leader(part_.geometry, index, static_cast<int>(bytes), head + size));
    std::memcpy(packed - size, head, size);
    return {packed - size, size + bytes};
  }

  const ExrReader::Handles& source_;
  const PlannedPart& part_;
  const RawPart& raw_;
  Rows rows_;
  std::optional<int32_t> part_number_;
  bool may_keep_;
};

/// A header for encoding alone: what OpenEXR needs to know and the packed image does not say.
Imf::Header encoding_header(const PlannedPart& part) {
  Imf::Header header;
  if (const auto level = value_of<float>(part.header.find("dwaCompressionLevel"), "float"))
    header.dwaCompressionLevel() = *level;
  return header;
}

/// By way of a file of its own that OpenEXR makes, whose chunks are taken over.
PartChunks encode_with_openexr(const PlannedPart& part, const PackedImage* decoded,
                               std::optional<int32_t> part_number) {
  const Rows rows(part, decoded);
  const PackedImage image(part.geometry.window, part.channels);
  for_rows(image.window.height(), [&](int i) {
    const int y = image.window.min_y + i;
    std::vector<char> scratch_row;
    bool changed = false;
    for (size_t c = 0; c < rows.layout().channels.size(); ++c)
      std::memcpy(image.row(c, y), rows.pixels(c, {image.window.min_x, y, image.window.max_x, y}, scratch_row, changed),
                  static_cast<size_t>(image.window.width() * bytes_per_pixel(rows.layout().channels[c].type)));
  });
  const std::vector<char> file = encode(image, part.geometry, encoding_header(part));
  const MemoryBytes memory(file);
  ExrLayout layout = parse_headers(memory, "encoded part", 1);
  read_offsets(layout, memory, "encoded part");
  return copy_chunks(layout, 0, memory, part_number);
}
}  // namespace

PartChunks copy_chunks(const ExrLayout& layout, int part, const ByteSource& source,
                       std::optional<int32_t> part_number) {
  const std::vector<uint64_t>& offsets = layout.parts[static_cast<size_t>(part)].offsets;
  const int64_t extra = part_number ? sizeof *part_number : 0;
  std::vector<ChunkPlace> places;
  std::vector<int64_t> starts{0};
  for (size_t i = 0; i < offsets.size(); ++i) {
    places.push_back(find_chunk(layout, part, static_cast<int64_t>(i), source));
    starts.push_back(starts.back() + extra + places.back().bytes());
  }
  PartChunks out{std::vector<std::span<const char>>(offsets.size()), std::vector<int64_t>(offsets.size()),
                 Buffer(static_cast<size_t>(starts.back()))};
  std::iota(out.order.begin(), out.order.end(), 0);
  std::ranges::sort(out.order, {}, [&](int64_t index) { return offsets[static_cast<size_t>(index)]; });
  for (size_t i = 0; i < offsets.size(); ++i) {
    char* const at = out.memory.data() + starts[i];
    if (part_number) std::memcpy(at, &*part_number, sizeof *part_number);
    source.read_at(places[i].start, {at + extra, static_cast<size_t>(places[i].bytes())});
    out.bytes[i] = {at, static_cast<size_t>(extra + places[i].bytes())};
  }
  return out;
}

PartChunks encode_chunks(const ExrReader::Handles& source, const PlannedPart& part, const PackedImage* decoded,
                         std::optional<int32_t> part_number, bool recode) {
  if (!source.uses_codecs(part.geometry.compression)) return encode_with_openexr(part, decoded, part_number);
  return PartEncoder(source, part, decoded, part_number, recode).encode();
}

}  // namespace aftershade::io
