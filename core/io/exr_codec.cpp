#include "core/io/exr_codec.h"

#include <Iex.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "core/io/run_deflate.h"

namespace aftershade::io {

namespace {
enum Compression { none, rle, zips, zip };

// Run lengths (ImfRle.cpp): a count of 0 to 127 and a byte that stands there once more than the count, or the negative
// of a count and as many bytes.
constexpr int kShortestRun = 3, kLongest = 127;

/// Returns whether `packed` gives exactly `coded`.
bool unpack_runs(std::span<const char> packed, std::span<uint8_t> coded) {
  while (!packed.empty()) {
    const auto count = static_cast<signed char>(packed[0]);
    packed = packed.subspan(1);
    const auto length = static_cast<size_t>(count < 0 ? -count : count + 1), taken = count < 0 ? length : 1;
    if (taken > packed.size() || length > coded.size()) return false;
    if (count < 0)
      std::memcpy(coded.data(), packed.data(), length);
    else
      std::memset(coded.data(), packed[0], length);
    packed = packed.subspan(taken);
    coded = coded.subspan(length);
  }
  return coded.empty();
}

/// Returns the packed size, or 0 when that would reach the size of `coded`, which `target` has room for.
size_t pack_runs(std::span<const uint8_t> coded, char* target) {
  const size_t size = coded.size();
  const auto run_at = [&](size_t at) {
    const size_t end = std::min(size, at + kLongest + 1);
    size_t last = at + 1;
    while (last < end && coded[last] == coded[at]) ++last;
    return last - at;
  };
  size_t written = 0;
  for (size_t at = 0; at < size;) {
    size_t length = run_at(at);
    const bool is_run = length >= kShortestRun;
    if (!is_run) {
      const size_t end = std::min(size, at + kLongest);
      for (length = 1; at + length < end && run_at(at + length) < kShortestRun;) ++length;
    }
    const size_t bytes = is_run ? 1 : length;
    if (written + 1 + bytes >= size) return 0;
    target[written++] = static_cast<char>(is_run ? static_cast<int>(length) - 1 : -static_cast<int>(length));
    std::memcpy(target + written, coded.data() + at, bytes);
    written += bytes;
    at += length;
  }
  return written;
}
}  // namespace

bool has_codec(int compression) { return compression >= none && compression <= zip; }

struct ChunkDecoder::Inflate {
  Inflate() : state(libdeflate_alloc_decompressor()) {
    if (state == nullptr) throw std::bad_alloc();
  }
  ~Inflate() { libdeflate_free_decompressor(state); }
  libdeflate_decompressor* state;
};

ChunkDecoder::ChunkDecoder() : inflate_(std::make_unique<Inflate>()) {}
ChunkDecoder::~ChunkDecoder() = default;

std::span<char> ChunkDecoder::packed(size_t size) {
  packed_.resize(size);
  return packed_;
}

// OpenEXR stores what does not shrink as it is, and reads only the first bytes of a stored chunk that is too long.
void ChunkDecoder::decode(int compression, std::span<char> pixels) {
  if (packed_.size() >= pixels.size()) {
    std::memcpy(pixels.data(), packed_.data(), pixels.size());
    return;
  }
  if (compression == none) throw Iex::InputExc("a chunk holds too few pixels");
  coded_.resize(pixels.size());
  const bool good = compression == rle
                        ? unpack_runs(packed_, coded_)
                        : libdeflate_zlib_decompress(inflate_->state, packed_.data(), packed_.size(), coded_.data(),
                                                     coded_.size(), nullptr) == LIBDEFLATE_SUCCESS;
  if (!good)
    throw Iex::InputExc(compression == rle ? "Data decoding (rle) failed" : "Data decompression (zlib) failed");
  join_halves(coded_.data(), coded_.size(), reinterpret_cast<uint8_t*>(pixels.data()));
}

struct ChunkEncoder::Deflate {
  static constexpr int kLevel = 5;  // the fastest that is no larger than OpenEXR's
  Deflate() : general(libdeflate_alloc_compressor(kLevel)) {
    if (general == nullptr) throw std::bad_alloc();
  }
  ~Deflate() { libdeflate_free_compressor(general); }
  libdeflate_compressor* general;
  RunDeflate noisy;
};

ChunkEncoder::ChunkEncoder() : deflate_(std::make_unique<Deflate>()) {}
ChunkEncoder::~ChunkEncoder() = default;

void ChunkEncoder::start(size_t size, size_t channels) {
  coded_.resize(size);
  lengths_.clear();
  channels_ = channels;
  splitter_ = HalfSplitter(coded_.data(), size);
}

void ChunkEncoder::add(const char* pixels, size_t size) {
  splitter_.add(reinterpret_cast<const uint8_t*>(pixels), size);
  lengths_.push_back(static_cast<uint32_t>(size / 2));
}

size_t ChunkEncoder::deflate(std::span<uint8_t> target) {
  const std::vector<uint32_t> half = lengths_;
  lengths_.insert(lengths_.end(), half.begin(), half.end());
  const size_t packed = deflate_->noisy.deflate(coded_, lengths_, channels_, target);
  if (packed > 0) return packed;
  return libdeflate_zlib_compress(deflate_->general, coded_.data(), coded_.size(), target.data(), target.size());
}

size_t ChunkEncoder::finish(int compression, char* target) {
  splitter_.finish();
  const size_t size = coded_.size();
  size_t packed = 0;
  if (compression == rle) packed = pack_runs(coded_, target);
  if (compression == zips || compression == zip) packed = deflate({reinterpret_cast<uint8_t*>(target), size - 1});
  if (packed > 0) return packed;
  join_halves(coded_.data(), size, reinterpret_cast<uint8_t*>(target));
  return size;
}

}  // namespace aftershade::io
