#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/window.h"
#include "core/io/bytes.h"
#include "core/io/exr_reader.h"

/// An EXR file as bytes: attributes, offset tables and chunks, without decoding a pixel. OpenEXR's own header objects
/// add, drop and re-type attributes; here they stay what they are. Source: OpenEXR File Layout.
namespace aftershade::io {

static_assert(std::endian::native == std::endian::little, "EXR files are little-endian");

struct RawAttribute {
  std::string name, type, bytes;
};

/// The value of an attribute, if it is there with this type and size.
template <class T>
std::optional<T> value_of(const RawAttribute* attribute, std::string_view type) {
  if (attribute == nullptr || attribute->type != type || attribute->bytes.size() != sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, attribute->bytes.data(), sizeof value);
  return value;
}
template <class T>
std::string bytes_of(const T& value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

struct RawHeader {
  std::vector<RawAttribute> attributes;
  const RawAttribute* find(std::string_view name) const;
  /// Replaces the bytes of an attribute, where it stands; adds it at the end when it is not there.
  void set(std::string_view name, std::string_view type, std::string bytes);
  bool erase(std::string_view name);
};

/// One entry of a `chlist` attribute.
struct RawChannel {
  std::string name;
  PixelType type = PixelType::half;
  bool perceptually_linear = false;
  int x_sampling = 1, y_sampling = 1;
  bool operator==(const RawChannel&) const = default;
};
std::vector<RawChannel> parse_channels(std::string_view bytes);     ///< throws Iex::InputExc
std::string format_channels(std::span<const RawChannel> channels);  ///< in the order given
inline int64_t bytes_per_pixel(PixelType type) { return type == PixelType::half ? 2 : 4; }

/// What each compression (index: the attribute's value) is called and does.
struct CompressionInfo {
  std::string_view name;
  int rows;          ///< scanlines in one chunk
  bool lossy;        ///< cannot be encoded again without loss
  double max_ratio;  ///< most bytes of pixels that one byte of file can declare; 0: no bound. reliability 1.3
};
inline constexpr std::array<CompressionInfo, 10> kCompressions{{{"none", 1, false, 1.1},
                                                                {"rle", 1, false, 70},
                                                                {"zips", 1, false, 1200},
                                                                {"zip", 16, false, 1200},
                                                                {"piz", 32, false, 0},
                                                                {"pxr24", 16, false, 1200},
                                                                {"b44", 32, true, 4},
                                                                {"b44a", 32, true, 16},
                                                                {"dwaa", 32, true, 0},
                                                                {"dwab", 256, true, 0}}};
std::optional<int> compression_from_name(std::string_view name);

/// How a part's pixels are cut into chunks.
struct Geometry {
  Window window;
  int compression = 0;
  int line_order = 0;                   ///< 0 increasing, 1 decreasing, 2 random
  int tile_width = 0, tile_height = 0;  ///< 0: scanlines
  bool tiled() const { return tile_width > 0; }
  int64_t chunks_across() const;
  int64_t chunks_down() const;
  int64_t chunk_count() const { return chunks_across() * chunks_down(); }
  int rows_in_chunk() const { return tiled() ? tile_height : kCompressions[static_cast<size_t>(compression)].rows; }
  Window chunk_window(int64_t index) const;  ///< the pixels of a chunk; those at the borders have fewer
  bool operator==(const Geometry&) const = default;
};

/// One part: its header, what the header says, and where its chunks lie.
struct RawPart {
  RawHeader header;
  std::vector<RawChannel> channels;
  Geometry geometry;
  int level_mode = 0;  ///< 0 one level, 1 mip-mapped, 2 rip-mapped
  std::string name, type;
  std::vector<uint64_t> offsets;  ///< empty until read_offsets()
  int64_t bytes_per_pixel() const;
};

struct ExrLayout {
  static constexpr uint32_t kMagic = 20000630;
  static constexpr uint32_t kTiled = 0x200, kLongNames = 0x400, kDeep = 0x800, kMultiPart = 0x1000;
  uint32_t version = 2;  ///< version number and flags
  std::vector<RawPart> parts;
  int64_t table_start = 0;  ///< where the offset tables begin
  bool multi_part() const { return (version & kMultiPart) != 0; }
};

/// Reads the headers. Throws Iex::InputExc when they are damaged, Error(data) when it is not an EXR file or of a kind
/// that cannot be read.
ExrLayout parse_headers(const ByteSource& source, const std::string& path, int max_parts);

/// Reads the offset tables and checks that every chunk lies in the file; throws Error(data) when it was cut off or is
/// still being written.
void read_offsets(ExrLayout& layout, const ByteSource& source, const std::string& path);

/// Where a chunk stands in its file, without the part number: coordinates and size, then the packed pixels.
struct ChunkPlace {
  int64_t start = 0;
  int leader_bytes = 0, packed_bytes = 0;
  int64_t bytes() const { return int64_t{leader_bytes} + packed_bytes; }
};
/// Throws Iex::InputExc when it is not the chunk it should be or does not lie in the file.
ChunkPlace find_chunk(const ExrLayout& layout, int part, int64_t index, const ByteSource& source);

/// Coordinates and size as they stand before the packed pixels of a chunk; `target` has room for 20 bytes. Returns how
/// many it takes.
int format_leader(const Geometry& geometry, int64_t index, int packed_bytes, char* target);

/// Magic, version, headers; the offset tables come next.
std::string format_headers(uint32_t version, std::span<const RawHeader> headers);

}  // namespace aftershade::io
