#pragma once
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>

#include <string>
#include <vector>

#include "core/image/plane.h"
#include "core/io/buffer.h"
#include "core/io/exr_layout.h"

/// Pixels in the types of the file, bit for bit, on their way into planes or a new file.
namespace aftershade::io {

/// How the channels of a part lie in memory, as they do in a chunk: a row of the first, the same row of the second ...,
/// then the next row. OpenEXR orders channels by name, whatever the header does.
struct RowLayout {
  explicit RowLayout(std::vector<RawChannel> in_any_order);
  std::vector<RawChannel> channels;
  std::vector<int64_t> offsets;  ///< bytes per pixel of the channels before each
  int64_t pixel_bytes = 0;       ///< of all channels

  /// Index of a channel, or -1.
  int find(std::string_view name) const;
  /// Where the first pixel of row `y` of a channel lies among the bytes of `window`.
  int64_t at(size_t channel, Window window, int y) const {
    return window.width() * (int64_t{y - window.min_y} * pixel_bytes + offsets[channel]);
  }
  int64_t bytes(Window window) const { return int64_t{window.width()} * window.height() * pixel_bytes; }
};

/// Decoded pixels of a part. What they are at first is anything.
struct PackedImage {
  PackedImage(Window image_window, std::vector<RawChannel> channels);
  Window window;
  RowLayout layout;
  Buffer pixels;
  char* row(size_t channel, int y) const { return pixels.data() + layout.at(channel, window, y); }
  char* pixel(size_t channel, int x, int y) const;
};

/// Slices on the channels, in their own types, for OpenEXR to decode into them and encode from them.
Imf::FrameBuffer frame_buffer(const PackedImage& image);

/// Encodes an image with OpenEXR as a file of its own with the compression, line order and tiles of `geometry`. Window
/// and channels go into `header`, which brings the rest.
std::vector<char> encode(const PackedImage& image, const Geometry& geometry, Imf::Header header);

}  // namespace aftershade::io
