#include "core/io/exr_decode.h"

#include <ImfInputPart.h>
#include <ImfTiledInputPart.h>

#include <algorithm>
#include <mutex>

#include "core/io/exr_codec.h"
#include "core/parallel/rows.h"

namespace aftershade::io {

namespace {
/// What one thread needs for a chunk.
struct Scratch {
  ChunkDecoder decoder;
  std::vector<char> pixels;
};
Scratch& scratch() {
  thread_local Scratch mine;
  return mine;
}

/// Pixels that lie in memory as `layout` says, of `window`.
struct Block {
  const RowLayout& layout;
  Window window;
  const char* bytes;
};

class PartDecoder {
 public:
  PartDecoder(const ExrReader::Handles& handles, int part, std::span<Wanted> wanted, Window window, PackedImage* keep)
      : handles_(handles), part_(part), wanted_(wanted), window_(window), keep_(keep) {}

  void decode_chunks() {
    const Geometry& geometry = raw().geometry;
    const RowLayout layout(raw().channels);
    const int64_t across = geometry.chunks_across(), rows = geometry.rows_in_chunk();
    const Window read = keep_ != nullptr ? geometry.window : intersection(geometry.window, window_);
    const int64_t first = (int64_t{read.min_y} - geometry.window.min_y) / rows * across;
    const int64_t end = ((int64_t{read.max_y} - geometry.window.min_y) / rows + 1) * across;
    for_rows(static_cast<int>(end - first), [&](int i) { decode_chunk(layout, first + i); });
  }

  /// OpenEXR decodes into packed pixels, too, so that values become floats in one place.
  void decode_with_openexr() {
    Window read = raw().geometry.window;
    if (keep_ == nullptr && !raw().geometry.tiled()) {
      const Window rows = intersection(read, window_);
      read.min_y = rows.min_y;
      read.max_y = rows.max_y;
    }
    if (keep_ != nullptr) return openexr_image(*keep_, read);
    const RowLayout all(raw().channels);
    std::vector<RawChannel> channels;
    for (const Wanted& wanted : wanted_) channels.push_back(all.channels[wanted.channel]);
    openexr_image(PackedImage(read, std::move(channels)), read);
  }

 private:
  const RawPart& raw() const { return handles_.layout.parts[static_cast<size_t>(part_)]; }

  void decode_chunk(const RowLayout& layout, int64_t index) {
    const Geometry& geometry = raw().geometry;
    const Window window = geometry.chunk_window(index);
    const auto bytes = static_cast<size_t>(layout.bytes(window));
    Scratch& mine = scratch();
    read_packed(mine.decoder, layout, index);
    if (keep_ != nullptr && !geometry.tiled()) {  // a chunk of whole rows lies there as it does in the file
      char* const kept = keep_->row(0, window.min_y);
      mine.decoder.decode(geometry.compression, {kept, bytes});
      return convert({layout, window, kept}, layout);
    }
    mine.pixels.resize(bytes);
    mine.decoder.decode(geometry.compression, mine.pixels);
    const Block block{layout, window, mine.pixels.data()};
    convert(block, layout);
    if (keep_ != nullptr) keep(block);
  }

  /// The limit of the size is OpenEXR's.
  void read_packed(ChunkDecoder& decoder, const RowLayout& layout, int64_t index) const {
    const Geometry& geometry = raw().geometry;
    const ChunkPlace place = find_chunk(handles_.layout, part_, index, handles_.bytes);
    const int64_t width = geometry.tiled() ? geometry.tile_width : geometry.window.width();
    const int64_t most = layout.pixel_bytes * width * geometry.rows_in_chunk();
    if (place.packed_bytes > most) throw Iex::InputExc("Unexpected data block length.");
    handles_.bytes.read_at(place.start + place.leader_bytes, decoder.packed(static_cast<size_t>(place.packed_bytes)));
  }

  void openexr_image(const PackedImage& image, Window read) {
    decode(handles_, part_, frame_buffer(image), read.min_y, read.max_y);
    const RowLayout all(raw().channels);
    for_rows(read.height(), [&](int y) {
      const Window row{read.min_x, read.min_y + y, read.max_x, read.min_y + y};
      convert({image.layout, row, image.row(0, row.min_y)}, all);
    });
  }

  /// `all` are the channels that Wanted::channel counts.
  void convert(const Block& block, const RowLayout& all) {
    const Window both = intersection(block.window, window_);
    if (both.empty()) return;
    for (Wanted& wanted : wanted_) {
      const RawChannel& channel = all.channels[wanted.channel];
      const auto at = static_cast<size_t>(block.layout.find(channel.name));
      const int64_t skipped = int64_t{both.min_x - block.window.min_x} * bytes_per_pixel(channel.type);
      NotNumbers found;
      for (int y = both.min_y; y <= both.max_y; ++y)
        found += to_floats(channel.type, block.bytes + block.layout.at(at, block.window, y) + skipped, both.width(),
                           wanted.target.row(y - window_.min_y) + (both.min_x - window_.min_x));
      if (found.nan == 0 && found.infinite == 0) continue;
      const std::lock_guard lock(count_);
      wanted.found += found;
    }
  }

  void keep(const Block& block) const {
    for (size_t c = 0; c < block.layout.channels.size(); ++c) {
      const auto bytes = static_cast<size_t>(block.window.width() * bytes_per_pixel(block.layout.channels[c].type));
      for (int y = block.window.min_y; y <= block.window.max_y; ++y)
        std::memcpy(keep_->pixel(c, block.window.min_x, y), block.bytes + block.layout.at(c, block.window, y), bytes);
    }
  }

  const ExrReader::Handles& handles_;
  int part_;
  std::span<Wanted> wanted_;
  Window window_;
  PackedImage* keep_;
  std::mutex count_;
};
}  // namespace

void decode(const ExrReader::Handles& handles, int part, const Imf::FrameBuffer& target, int first, int last) {
  if (!handles.info.parts[static_cast<size_t>(part)].tiled) {
    Imf::InputPart input(handles.openexr(), part);
    input.setFrameBuffer(target);
    input.readPixels(first, last);
    return;
  }
  Imf::TiledInputPart input(handles.openexr(), part);
  input.setFrameBuffer(target);
  input.readTiles(0, input.numXTiles() - 1, 0, input.numYTiles() - 1);
}

void decode_part(const ExrReader::Handles& handles, int part, std::span<Wanted> wanted, Window window,
                 PackedImage* keep) {
  const Geometry& geometry = handles.layout.parts[static_cast<size_t>(part)].geometry;
  if (keep == nullptr && (wanted.empty() || intersection(geometry.window, window).empty())) return;
  PartDecoder decoder(handles, part, wanted, window, keep);
  if (handles.uses_codecs(geometry.compression))
    decoder.decode_chunks();
  else
    decoder.decode_with_openexr();
}

}  // namespace aftershade::io
