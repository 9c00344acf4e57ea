#include "core/io/exr_pixels.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>

#include <algorithm>

#include "core/io/exr_handles.h"

namespace aftershade::io {

namespace {
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

RowLayout::RowLayout(std::vector<RawChannel> in_any_order) : channels(std::move(in_any_order)) {
  std::ranges::sort(channels, {}, &RawChannel::name);
  for (const RawChannel& channel : channels) {
    offsets.push_back(pixel_bytes);
    pixel_bytes += bytes_per_pixel(channel.type);
  }
}

int RowLayout::find(std::string_view name) const {
  const auto found = std::ranges::lower_bound(channels, name, {}, &RawChannel::name);
  return found == channels.end() || found->name != name ? -1 : static_cast<int>(found - channels.begin());
}

PackedImage::PackedImage(Window image_window, std::vector<RawChannel> channels)
    : window(image_window), layout(std::move(channels)), pixels(static_cast<size_t>(layout.bytes(window))) {}

char* PackedImage::pixel(size_t channel, int x, int y) const {
  return row(channel, y) + int64_t{x - window.min_x} * bytes_per_pixel(layout.channels[channel].type);
}

Imf::FrameBuffer frame_buffer(const PackedImage& image) {
  Imf::FrameBuffer buffer;
  const auto row_bytes = static_cast<size_t>(image.layout.pixel_bytes * image.window.width());
  for (size_t c = 0; c < image.layout.channels.size(); ++c) {
    const RawChannel& channel = image.layout.channels[c];
    buffer.insert(channel.name, slice(imf_type(channel.type), image.row(c, image.window.min_y), image.window,
                                      static_cast<size_t>(bytes_per_pixel(channel.type)), row_bytes));
  }
  return buffer;
}

std::vector<char> encode(const PackedImage& image, const Geometry& geometry, Imf::Header header) {
  const Window w = image.window;
  header.dataWindow() = {{w.min_x, w.min_y}, {w.max_x, w.max_y}};
  header.compression() = static_cast<Imf::Compression>(geometry.compression);
  header.lineOrder() = static_cast<Imf::LineOrder>(geometry.line_order);
  if (geometry.tiled())
    header.setTileDescription(
        {static_cast<unsigned>(geometry.tile_width), static_cast<unsigned>(geometry.tile_height), Imf::ONE_LEVEL});
  for (const RawChannel& channel : image.layout.channels)
    header.channels().insert(channel.name, Imf::Channel(imf_type(channel.type), 1, 1, channel.perceptually_linear));
  MemoryStream stream;
  write_chunks(stream, header, frame_buffer(image), geometry.tiled());
  return std::move(stream.bytes());
}

}  // namespace aftershade::io
