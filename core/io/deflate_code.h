#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <span>

/// Deflate, RFC 1951: how lengths, distances and codes are sent.
namespace aftershade::io::deflate {

inline constexpr size_t kSymbols = 286, kEndOfBlock = 256, kDistances = 30;
inline constexpr size_t kLongestMatch = 258, kFarthest = 32768, kLongestStored = 65535;

/// What stands for the length of a match (3.2.5).
struct LengthCode {
  uint16_t symbol;
  uint8_t extra_bits, extra;
};
const LengthCode& length_code(size_t length);  ///< 3 to kLongestMatch

/// What stands for a distance; the extra bits are the distance less `base`.
struct DistanceCode {
  uint16_t symbol, extra_bits, base;
};
const DistanceCode& distance_code(size_t distance);  ///< 1 to kFarthest

/// Bits, the first lowest, of which at most 64 may wait. flush() may write up to 8 bytes past what counts.
class BitWriter {
 public:
  explicit BitWriter(uint8_t* target) : at_(target) {}
  void put(uint64_t bits, int count) {
    bits_ |= bits << count_;
    count_ += count;
  }
  void flush() {
    std::memcpy(at_, &bits_, sizeof bits_);
    at_ += count_ / 8;
    bits_ >>= count_ / 8 * 8;
    count_ %= 8;
  }
  /// Up to the next whole byte.
  uint8_t* align() {
    count_ = (count_ + 7) / 8 * 8;
    flush();
    return at_;
  }
  void copy(const uint8_t* bytes, size_t count) {
    std::memcpy(at_, bytes, count);
    at_ += count;
  }
  const uint8_t* at() const { return at_; }

 private:
  uint8_t* at_;
  uint64_t bits_ = 0;
  int count_ = 0;
};

/// The codes of a block, none longer than kLongestCode bits, and how the decoder is told of them (3.2.7).
class BlockCode {
 public:
  static constexpr int kLongestCode = 14;  // four and the rest of a byte fit 64 bits

  BlockCode(std::span<const uint32_t, kSymbols> symbols, std::span<const uint32_t, kDistances> distances);
  size_t bits() const { return bits_; }  ///< of the whole block, but for extra bits
  void put_head(BitWriter& out, bool is_last) const;
  void put_symbol(BitWriter& out, size_t symbol) const { out.put(symbols_.codes[symbol], symbols_.lengths[symbol]); }
  void put_distance(BitWriter& out, size_t symbol) const {
    out.put(distances_.codes[symbol], distances_.lengths[symbol]);
  }
  /// Code and, 16 bits up, its length.
  uint32_t literal(size_t byte) const { return symbols_.codes[byte] | uint32_t{symbols_.lengths[byte]} << 16; }

 private:
  template <size_t kCount>
  struct Code {
    std::array<uint8_t, kCount> lengths{};
    std::array<uint16_t, kCount> codes{};
    size_t used = 0;  ///< up to the last symbol that occurs, at least one
  };
  /// Of the list of lengths: one of them, or a repetition.
  struct Item {
    uint8_t symbol, extra;
  };
  static constexpr size_t kHeadSymbols = 19;

  template <size_t kCount>
  void make(std::span<const uint32_t, kCount> counts, Code<kCount>& code);
  void list_lengths(std::span<const uint8_t> lengths);
  void add(size_t symbol, size_t extra);
  void make_head();

  Code<kSymbols> symbols_;
  Code<kDistances> distances_;
  std::array<Item, kSymbols + kDistances> items_;
  size_t item_count_ = 0;
  std::array<uint32_t, kHeadSymbols> head_counts_{};
  std::array<uint8_t, kHeadSymbols> head_lengths_{};
  std::array<uint16_t, kHeadSymbols> head_codes_{};
  size_t head_used_ = 0, bits_ = 0;
};

}  // namespace aftershade::io::deflate
