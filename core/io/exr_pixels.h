#pragma once
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>

#include <string>
#include <vector>

#include "core/image/plane.h"
#include "core/io/exr_layout.h"

/// Pixels in the types of the file, bit for bit, on their way into a new one.
namespace aftershade::io {

struct PackedChannel {
  RawChannel info;
  std::vector<char> pixels;  ///< rows of the image's window, without padding
};
struct PackedImage {
  Window window;
  std::vector<PackedChannel> channels;
  PackedChannel& add(const RawChannel& info);  ///< all pixels 0
  PackedChannel* find(const std::string& name);
};

/// Puts a plane that covers `window` into a channel of an image that covers `image`. Half: finite values beyond 65504
/// become +-65504, Inf and NaN stay. uint: rounded, clamped, NaN is 0. A pixel whose float has the very bits that
/// decoding the channel gives keeps the channel's bits (NaN payloads, uints above 2^24).
void pack(ConstPlaneView pixels, Window window, PackedChannel& channel, Window image);

/// Gives `value` to the pixels of the image outside of `kept`, which lies inside it.
void fill_outside(PackedChannel& channel, Window image, Window kept, float value);

/// Slices on the channels, in their own types, for decoding into them and encoding from them.
Imf::FrameBuffer frame_buffer(PackedImage& image);

/// Encodes an image as a file of its own with the compression, line order and tiles of `geometry`. Window and channels
/// go into `header`, which brings the rest.
std::vector<char> encode(PackedImage& image, const Geometry& geometry, Imf::Header header);

}  // namespace aftershade::io
