#pragma once
#include <cstddef>
#include <cstdint>

#include "core/io/exr_reader.h"

/// The inner loops of reading and writing pixels, on all bytes of a frame: vectors of the best SIMD target, the same
/// bits on each (core/simd/targets.h).
namespace aftershade::io {

/// ZIP, ZIPS and RLE first put the even bytes of a chunk before the odd ones, then store each byte as the difference
/// from the one before it plus 128, the very first as it is (OpenEXR File Layout; ImfZip.cpp does the same). This
/// undoes both for a whole chunk. `size` is even; neither side overlaps the other.
void join_halves(const uint8_t* coded, size_t size, uint8_t* pixels);

/// The other way, row by row: a chunk's rows go into its two halves one after the other.
class HalfSplitter {
 public:
  /// `coded` has room for `size` bytes, the whole chunk's, an even number.
  HalfSplitter(uint8_t* coded, size_t size) : low_(coded), high_(coded + size / 2), second_half_(high_) {}
  /// `size` is even.
  void add(const uint8_t* row, size_t size);
  /// After the last row.
  void finish();

 private:
  uint8_t *low_, *high_;
  uint8_t* second_half_;
  uint8_t last_low_ = 128, last_high_ = 0;
};

/// A row in the type of the file to floats, as Imath converts: NaN payloads stay. Returns what it met.
NotNumbers to_floats(PixelType type, const char* stored, int count, float* pixels);

/// A row of floats into pixels in the type of the file. Half: rounded to nearest even, finite values beyond 65504
/// become
/// +-65504, Inf and NaN stay. uint: rounded, clamped, NaN is 0. A pixel whose float has the very bits that decoding the
/// stored one gives keeps the stored bits (NaN payloads, uints above 2^24). Returns whether any bit has changed.
bool pack_row(PixelType type, const float* pixels, int count, char* stored);

}  // namespace aftershade::io
