#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/io/exr_pixels.h"
#include "core/io/exr_plan.h"

namespace aftershade::io {

/// The chunks of one part of the output.
struct PartChunks {
  std::vector<std::span<const char>> bytes;  ///< by index: part number, if the file has several, leader, packed pixels
  std::vector<int64_t> order;                ///< in which they lie in the file
  Buffer memory;
};

/// The chunks of a part as another file has them. Throws Iex::InputExc when they are damaged.
PartChunks copy_chunks(const ExrLayout& layout, int part, const ByteSource& source, std::optional<int32_t> part_number);

/// Encodes a part with its writes, on all threads. `decoded` are the source part's pixels, null when nothing of them is
/// copied. A chunk whose pixels come out as they were keeps its packed bytes, unless `recode`.
PartChunks encode_chunks(const ExrReader::Handles& source, const PlannedPart& part, const PackedImage* decoded,
                         std::optional<int32_t> part_number, bool recode);

}  // namespace aftershade::io
