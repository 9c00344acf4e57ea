#include <Iex.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/exr_layout.h"

namespace aftershade::io {

namespace {
/// Coordinates and size in front of a chunk's pixels; multi-part files have the part's number before them.
struct Leader {
  int32_t part = 0, coordinates[4] = {0, 0, 0, 0}, size = 0;
  int64_t bytes = 0;  ///< without the part number
};

Error truncated(const std::string& path, std::string_view why) {
  return {ErrorCode::data, cat(path, " is truncated or still being written: ", why), "render or copy it again"};
}

Leader read_leader(const ExrLayout& layout, const RawPart& part, uint64_t offset, const ByteSource& source) {
  const int coordinates = part.geometry.tiled() ? 4 : 1, first = layout.multi_part() ? 1 : 0;
  int32_t values[6];
  const std::span<int32_t> read(values, static_cast<size_t>(first + coordinates + 1));
  source.read_at(static_cast<int64_t>(offset), {reinterpret_cast<char*>(read.data()), read.size_bytes()});
  Leader leader;
  if (first == 1) leader.part = values[0];
  std::copy_n(values + first, coordinates, leader.coordinates);
  leader.size = values[first + coordinates];
  leader.bytes = 4 * (coordinates + 1);
  return leader;
}

bool is_chunk(const Leader& leader, const Geometry& geometry, int part, int64_t index) {
  if (leader.part != part || leader.size <= 0) return false;
  const int32_t* at = leader.coordinates;
  if (!geometry.tiled()) {
    const int64_t rows = kCompressions[static_cast<size_t>(geometry.compression)].rows;
    return at[0] == geometry.window.min_y + index * rows;
  }
  return at[0] == index % geometry.chunks_across() && at[1] == index / geometry.chunks_across() && at[2] == 0 &&
         at[3] == 0;
}

/// Where the chunk that lies last in the file ends; -1 when its leader is cut off.
int64_t end_of_last_chunk(const ExrLayout& layout, const ByteSource& source) {
  const RawPart* last = nullptr;
  uint64_t offset = 0;
  for (const RawPart& part : layout.parts)
    for (const uint64_t candidate : part.offsets)
      if (candidate >= offset) offset = candidate, last = &part;
  try {
    const Leader leader = read_leader(layout, *last, offset, source);
    return static_cast<int64_t>(offset) + leader.bytes + (layout.multi_part() ? 4 : 0) + std::max(0, leader.size);
  } catch (const Iex::InputExc&) {
    return -1;
  }
}
}  // namespace

void read_offsets(ExrLayout& layout, const ByteSource& source, const std::string& path) {
  int64_t position = layout.table_start;
  for (RawPart& part : layout.parts) {
    const int64_t count = part.geometry.chunk_count();
    if (count > (source.size() - position) / 8) throw truncated(path, "its chunk table is incomplete");
    part.offsets.resize(static_cast<size_t>(count));
    const std::span<uint64_t> offsets(part.offsets);
    source.read_at(position, {reinterpret_cast<char*>(offsets.data()), offsets.size_bytes()});
    position += 8 * count;
  }
  for (const RawPart& part : layout.parts)
    for (const uint64_t offset : part.offsets) {
      if (offset == 0) throw truncated(path, "chunks are missing");
      if (offset < static_cast<uint64_t>(position)) throw Error(ErrorCode::data, cat(path, " is damaged: chunk table"));
      if (offset >= static_cast<uint64_t>(source.size())) throw truncated(path, "chunks lie behind its end");
    }
  const int64_t end = end_of_last_chunk(layout, source);
  if (end < 0 || end > source.size()) throw truncated(path, "its last chunk is incomplete");
}

ChunkPlace find_chunk(const ExrLayout& layout, int part, int64_t index, const ByteSource& source) {
  const RawPart& raw = layout.parts[static_cast<size_t>(part)];
  const uint64_t offset = raw.offsets[static_cast<size_t>(index)];
  const Leader leader = read_leader(layout, raw, offset, source);
  const int64_t start = static_cast<int64_t>(offset) + (layout.multi_part() ? 4 : 0);
  if (!is_chunk(leader, raw.geometry, part, index) || leader.size > source.size() - start - leader.bytes)
    throw Iex::InputExc(cat("chunk ", index, " is damaged"));
  return {start, static_cast<int>(leader.bytes), leader.size};
}

int format_leader(const Geometry& geometry, int64_t index, int packed_bytes, char* target) {
  int32_t values[5] = {geometry.window.min_y + static_cast<int32_t>(index * geometry.rows_in_chunk()), packed_bytes};
  int count = 2;
  if (geometry.tiled()) {
    const int64_t across = geometry.chunks_across();
    const int32_t tile[5] = {static_cast<int32_t>(index % across), static_cast<int32_t>(index / across), 0, 0,
                             packed_bytes};
    count = 5;
    std::copy_n(tile, count, values);
  }
  const auto bytes = sizeof(int32_t) * static_cast<size_t>(count);
  std::memcpy(target, values, bytes);
  return static_cast<int>(bytes);
}

}  // namespace aftershade::io
