#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/io/exr_bytes.h"

/// The compressions none, rle, zips and zip of single chunks, as OpenEXR has them. Nothing is allocated once a chunk of
/// the size has been seen; one codec a thread.
namespace aftershade::io {

/// Is this one of them? (index of kCompressions)
bool has_codec(int compression);

class ChunkDecoder {
 public:
  ChunkDecoder();
  ~ChunkDecoder();
  /// Room for the `size` packed bytes of the next chunk.
  std::span<char> packed(size_t size);
  /// Unpacks what has been put there. Throws Iex::InputExc unless it gives exactly these pixels.
  void decode(int compression, std::span<char> pixels);

 private:
  struct Inflate;
  std::unique_ptr<Inflate> inflate_;
  std::vector<char> packed_;
  std::vector<uint8_t> coded_;
};

class ChunkEncoder {
 public:
  ChunkEncoder();
  ~ChunkEncoder();
  /// `size`: bytes of the chunk's pixels, in rows of `channels` stretches.
  void start(size_t size, size_t channels);
  /// The pixels of one channel in one row.
  void add(const char* pixels, size_t size);
  /// After the last row: packs the chunk into `target`, which has room for its pixels, and returns the number of bytes:
  /// fewer than the pixels', or as many when they are stored as they are.
  size_t finish(int compression, char* target);

 private:
  struct Deflate;
  size_t deflate(std::span<uint8_t> target);

  std::unique_ptr<Deflate> deflate_;
  std::vector<uint8_t> coded_;
  std::vector<uint32_t> lengths_;  ///< of the stretches of one half of `coded_`
  size_t channels_ = 0;
  HalfSplitter splitter_{nullptr, 0};
};

}  // namespace aftershade::io
