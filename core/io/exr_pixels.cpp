#include "core/io/exr_pixels.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/io/exr_handles.h"

namespace aftershade::io {

namespace {
constexpr float kLargestHalf = 65504.0F;

uint16_t to_half(float value) {
  if (std::isfinite(value)) value = std::clamp(value, -kLargestHalf, kLargestHalf);
  return half(value).bits();
}
float from_half(uint16_t bits) {
  half value;
  value.setBits(bits);
  return value;
}

uint32_t to_uint(float value) {
  if (!(value > 0)) return 0;  // also NaN
  constexpr float kPastLargest = 4294967296.0F;
  return value >= kPastLargest ? 0xFFFFFFFFU : static_cast<uint32_t>(std::nearbyint(value));
}
float from_uint(uint32_t bits) { return static_cast<float>(bits); }

uint32_t to_single(float value) { return std::bit_cast<uint32_t>(value); }
float from_single(uint32_t bits) { return std::bit_cast<float>(bits); }

/// One row: `stored` are pixels in the file's type.
template <class Bits, class To, class From>
void pack_row(const float* pixels, int count, char* stored, To to, From from) {
  for (int x = 0; x < count; ++x) {
    Bits bits;
    std::memcpy(&bits, stored + sizeof bits * static_cast<size_t>(x), sizeof bits);
    if (std::bit_cast<uint32_t>(from(bits)) == std::bit_cast<uint32_t>(pixels[x])) continue;
    bits = to(pixels[x]);
    std::memcpy(stored + sizeof bits * static_cast<size_t>(x), &bits, sizeof bits);
  }
}

void pack_row(const float* pixels, int count, char* stored, PixelType type) {
  switch (type) {
    case PixelType::half:
      return pack_row<uint16_t>(pixels, count, stored, to_half, from_half);
    case PixelType::single:
      return pack_row<uint32_t>(pixels, count, stored, to_single, from_single);
    case PixelType::uint:
      return pack_row<uint32_t>(pixels, count, stored, to_uint, from_uint);
  }
}

char* pixel(PackedChannel& channel, Window image, int x, int y) {
  const int64_t index = int64_t{y - image.min_y} * image.width() + (x - image.min_x);
  return channel.pixels.data() + index * bytes_per_pixel(channel.info.type);
}

Imf::PixelType imf_type(PixelType type) {
  return type == PixelType::half ? Imf::HALF : type == PixelType::single ? Imf::FLOAT : Imf::UINT;
}

void write_chunks(MemoryStream& stream, const Imf::Header& header, const Imf::FrameBuffer& pixels, bool tiled) {
  if (!tiled) {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(pixels);
    file.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
    return;
  }
  Imf::TiledOutputFile file(stream, header);
  file.setFrameBuffer(pixels);
  file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
}
}  // namespace

PackedChannel& PackedImage::add(const RawChannel& info) {
  const int64_t count = int64_t{window.width()} * window.height();
  channels.push_back({info, std::vector<char>(static_cast<size_t>(count * bytes_per_pixel(info.type)))});
  return channels.back();
}

PackedChannel* PackedImage::find(const std::string& name) {
  const auto found = std::ranges::find(channels, name, [](const PackedChannel& c) { return c.info.name; });
  return found == channels.end() ? nullptr : &*found;
}

void pack(ConstPlaneView pixels, Window window, PackedChannel& channel, Window image) {
  const Window both = intersection(window, image);
  if (both.empty()) return;
  for (int y = both.min_y; y <= both.max_y; ++y)
    pack_row(pixels.row(y - window.min_y) + (both.min_x - window.min_x), both.width(),
             pixel(channel, image, both.min_x, y), channel.info.type);
}

void fill_outside(PackedChannel& channel, Window image, Window kept, float value) {
  const std::vector<float> row(static_cast<size_t>(image.width()), value);
  for (int y = image.min_y; y <= image.max_y; ++y) {
    const bool crosses = y >= kept.min_y && y <= kept.max_y;
    const int left = crosses ? kept.min_x - image.min_x : image.width();
    pack_row(row.data(), left, pixel(channel, image, image.min_x, y), channel.info.type);
    if (crosses)
      pack_row(row.data(), image.max_x - kept.max_x,
               pixel(channel, image, kept.max_x, y) + bytes_per_pixel(channel.info.type), channel.info.type);
  }
}

Imf::FrameBuffer frame_buffer(PackedImage& image) {
  Imf::FrameBuffer buffer;
  for (PackedChannel& channel : image.channels) {
    const auto size = static_cast<size_t>(bytes_per_pixel(channel.info.type));
    buffer.insert(channel.info.name, slice(imf_type(channel.info.type), channel.pixels.data(), image.window, size,
                                           size * static_cast<size_t>(image.window.width())));
  }
  return buffer;
}

std::vector<char> encode(PackedImage& image, const Geometry& geometry, Imf::Header header) {
  const Window w = image.window;
  header.dataWindow() = {{w.min_x, w.min_y}, {w.max_x, w.max_y}};
  header.compression() = static_cast<Imf::Compression>(geometry.compression);
  header.lineOrder() = static_cast<Imf::LineOrder>(geometry.line_order);
  if (geometry.tiled())
    header.setTileDescription(
        {static_cast<unsigned>(geometry.tile_width), static_cast<unsigned>(geometry.tile_height), Imf::ONE_LEVEL});
  for (const PackedChannel& channel : image.channels)
    header.channels().insert(channel.info.name,
                             Imf::Channel(imf_type(channel.info.type), 1, 1, channel.info.perceptually_linear));
  MemoryStream stream;
  write_chunks(stream, header, frame_buffer(image), geometry.tiled());
  return std::move(stream.bytes());
}

}  // namespace aftershade::io
