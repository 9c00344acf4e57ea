#include "core/io/exr_layout.h"

#include <Iex.h>

#include <algorithm>
#include <unordered_set>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::io {

namespace {
[[noreturn]] void damaged(const std::string& what) { throw Iex::InputExc(what); }

/// Reads values one after the other.
class Cursor {
 public:
  explicit Cursor(const ByteSource& source) : size_(source.size()), stream_(source, "header") {}

  template <class T>
  T value() {
    T value;
    char bytes[sizeof value];
    stream_.read(bytes, sizeof bytes);
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  std::string name() {
    constexpr size_t kLongest = 255;
    std::string text;
    for (char c = value<char>(); c != '\0'; c = value<char>()) {
      text += c;
      if (text.size() > kLongest) damaged("a name in the header is longer than 255 characters");
    }
    return text;
  }
  std::string bytes(int count) {
    if (count < 0 || count > size_ - position()) damaged("an attribute is larger than the file");
    std::string text(static_cast<size_t>(count), '\0');
    stream_.read(text.data(), count);
    return text;
  }
  int64_t position() { return static_cast<int64_t>(stream_.tellg()); }

 private:
  int64_t size_;
  SourceStream stream_;
};

/// `first` is the name of the first attribute, already read.
RawHeader parse_header(Cursor& cursor, std::string first) {
  RawHeader header;
  std::unordered_set<std::string> seen;
  for (std::string name = std::move(first); !name.empty(); name = cursor.name()) {
    if (!seen.insert(name).second) damaged(cat("attribute ", name, " is there twice"));
    std::string type = cursor.name();
    std::string bytes = cursor.bytes(cursor.value<int32_t>());
    header.attributes.push_back({std::move(name), std::move(type), std::move(bytes)});
  }
  return header;
}

template <class T>
T required(const RawHeader& header, std::string_view name, std::string_view type) {
  const auto value = value_of<T>(header.find(name), type);
  if (!value) damaged(cat("the header has no valid attribute ", name));
  return *value;
}

struct TileBytes {
  uint32_t width, height;
  unsigned char mode;
} __attribute__((packed));

void interpret_tiles(RawPart& part) {
  const auto tiles = required<TileBytes>(part.header, "tiles", "tiledesc");
  constexpr uint32_t kLargest = 1U << 30;
  if (tiles.width == 0 || tiles.height == 0 || tiles.width > kLargest || tiles.height > kLargest)
    damaged("the tile size is not valid");
  part.geometry.tile_width = static_cast<int>(tiles.width);
  part.geometry.tile_height = static_cast<int>(tiles.height);
  part.level_mode = tiles.mode & 0xF;
}

std::string text_of(const RawHeader& header, std::string_view name) {
  const RawAttribute* attribute = header.find(name);
  return attribute != nullptr && attribute->type == "string" ? attribute->bytes : std::string();
}

Window interpret_window(const RawHeader& header, std::string_view name) {
  const auto window = required<Window>(header, name, "box2i");
  constexpr int kFarthest = 1 << 30;
  for (const int value : {window.min_x, window.min_y, window.max_x, window.max_y})
    if (value < -kFarthest || value > kFarthest) damaged(cat(name, " is not a valid window"));
  if (window.empty()) damaged(cat(name, " is empty"));
  return window;
}

RawPart interpret(RawHeader header, bool multi_part, bool tiled_flag) {
  RawPart part;
  part.header = std::move(header);
  part.name = text_of(part.header, "name");
  part.type = text_of(part.header, "type");
  const RawAttribute* channels = part.header.find("channels");
  if (channels == nullptr || channels->type != "chlist") damaged("the header has no channels");
  part.channels = parse_channels(channels->bytes);
  part.geometry.window = interpret_window(part.header, "dataWindow");
  interpret_window(part.header, "displayWindow");
  part.geometry.compression = required<uint8_t>(part.header, "compression", "compression");
  if (part.geometry.compression >= static_cast<int>(kCompressions.size())) damaged("the compression is not known");
  part.geometry.line_order = required<uint8_t>(part.header, "lineOrder", "lineOrder");
  if (multi_part && part.type.empty()) damaged("a part has no type");
  const bool deep = part.type.starts_with("deep");
  if (!deep && (multi_part ? part.type == "tiledimage" : tiled_flag)) interpret_tiles(part);
  return part;
}
}  // namespace

const RawAttribute* RawHeader::find(std::string_view name) const {
  const auto found = std::ranges::find(attributes, name, &RawAttribute::name);
  return found == attributes.end() ? nullptr : &*found;
}

void RawHeader::set(std::string_view name, std::string_view type, std::string bytes) {
  const auto found = std::ranges::find(attributes, name, &RawAttribute::name);
  if (found == attributes.end())
    attributes.push_back({std::string(name), std::string(type), std::move(bytes)});
  else
    *found = {std::string(name), std::string(type), std::move(bytes)};
}

bool RawHeader::erase(std::string_view name) {
  return std::erase_if(attributes, [&](const RawAttribute& a) { return a.name == name; }) > 0;
}

std::vector<RawChannel> parse_channels(std::string_view bytes) {
  const MemoryBytes memory({bytes.data(), bytes.size()});
  Cursor cursor(memory);
  std::vector<RawChannel> channels;
  for (std::string name = cursor.name(); !name.empty(); name = cursor.name()) {
    const auto type = cursor.value<int32_t>();
    if (type < 0 || type > 2) damaged(cat("channel ", name, " has an unknown pixel type"));
    constexpr PixelType kTypes[] = {PixelType::uint, PixelType::half, PixelType::single};
    const bool linear = (cursor.value<uint32_t>() & 0xFF) != 0;
    const int x = cursor.value<int32_t>(), y = cursor.value<int32_t>();
    channels.push_back({std::move(name), kTypes[type], linear, x, y});
  }
  return channels;
}

std::string format_channels(std::span<const RawChannel> channels) {
  std::string out;
  for (const RawChannel& c : channels) {
    const int32_t type = c.type == PixelType::uint ? 0 : c.type == PixelType::half ? 1 : 2;
    out += c.name + '\0' + bytes_of(type) + bytes_of(uint32_t{c.perceptually_linear}) + bytes_of(c.x_sampling) +
           bytes_of(c.y_sampling);
  }
  return out + '\0';
}

std::optional<int> compression_from_name(std::string_view name) {
  const auto found = std::ranges::find(kCompressions, name, &CompressionInfo::name);
  if (found == kCompressions.end()) return std::nullopt;
  return static_cast<int>(found - kCompressions.begin());
}

int64_t Geometry::chunks_across() const {
  return tiled() ? (int64_t{window.width()} + tile_width - 1) / tile_width : 1;
}
int64_t Geometry::chunks_down() const { return (int64_t{window.height()} + rows_in_chunk() - 1) / rows_in_chunk(); }
Window Geometry::chunk_window(int64_t index) const {
  const int64_t x = tiled() ? index % chunks_across() * tile_width : 0;
  const int64_t y = (tiled() ? index / chunks_across() : index) * rows_in_chunk();
  const int64_t width = tiled() ? tile_width : window.width();
  const auto last = [](int64_t wanted, int most) { return static_cast<int>(std::min<int64_t>(wanted, most)); };
  return {static_cast<int>(window.min_x + x), static_cast<int>(window.min_y + y),
          last(window.min_x + x + width - 1, window.max_x), last(window.min_y + y + rows_in_chunk() - 1, window.max_y)};
}

int64_t RawPart::bytes_per_pixel() const {
  int64_t sum = 0;
  for (const RawChannel& channel : channels) sum += io::bytes_per_pixel(channel.type);
  return sum;
}

ExrLayout parse_headers(const ByteSource& source, const std::string& path, int max_parts) {
  Cursor cursor(source);
  if (source.size() < 8 || cursor.value<uint32_t>() != ExrLayout::kMagic)
    throw Error(ErrorCode::data, cat(path, " is not an EXR file"));
  ExrLayout layout;
  layout.version = cursor.value<uint32_t>();
  const uint32_t known = ExrLayout::kTiled | ExrLayout::kLongNames | ExrLayout::kDeep | ExrLayout::kMultiPart;
  if ((layout.version & 0xFF) > 2 || (layout.version & ~(known | 0xFF)) != 0)
    throw Error(ErrorCode::data, cat(path, " is an EXR file of a version that is not known"));
  const bool tiled = (layout.version & ExrLayout::kTiled) != 0;
  do {
    std::string first = cursor.name();
    if (first.empty() && layout.multi_part()) break;
    if (static_cast<int>(layout.parts.size()) == max_parts) damaged(cat("it has more than ", max_parts, " parts"));
    layout.parts.push_back(interpret(parse_header(cursor, std::move(first)), layout.multi_part(), tiled));
  } while (layout.multi_part());
  if (layout.parts.empty()) damaged("it has no parts");
  layout.table_start = cursor.position();
  return layout;
}

std::string format_headers(uint32_t version, std::span<const RawHeader> headers) {
  std::string out = bytes_of(ExrLayout::kMagic) + bytes_of(version);
  for (const RawHeader& header : headers) {
    for (const RawAttribute& a : header.attributes)
      out += a.name + '\0' + a.type + '\0' + bytes_of(static_cast<int32_t>(a.bytes.size())) + a.bytes;
    out += '\0';
  }
  if ((version & ExrLayout::kMultiPart) != 0) out += '\0';
  return out;
}

}  // namespace aftershade::io
