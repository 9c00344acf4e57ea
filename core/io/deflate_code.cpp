#include "core/io/deflate_code.h"

#include <algorithm>
#include <bit>

#include "core/io/huffman.h"

namespace aftershade::io::deflate {

namespace {
std::array<LengthCode, kLongestMatch + 1> make_length_codes() {
  std::array<LengthCode, kLongestMatch + 1> codes{};
  uint16_t symbol = 257;
  uint32_t length = 3;
  for (; symbol < 285; ++symbol) {
    const auto bits = static_cast<uint8_t>(symbol < 265 ? 0 : (symbol - 261) / 4);
    for (uint32_t extra = 0; extra < 1U << bits && length < kLongestMatch; ++extra)
      codes[length++] = {symbol, bits, static_cast<uint8_t>(extra)};
  }
  codes[kLongestMatch] = {285, 0, 0};
  return codes;
}
const std::array<LengthCode, kLongestMatch + 1> kLengthCodes = make_length_codes();

std::array<DistanceCode, kDistances> make_distance_codes() {
  std::array<DistanceCode, kDistances> codes{};
  uint32_t base = 1;
  for (uint16_t symbol = 0; symbol < codes.size(); ++symbol) {
    const auto bits = static_cast<uint16_t>(symbol < 4 ? 0 : symbol / 2 - 1);
    codes[symbol] = {symbol, bits, static_cast<uint16_t>(base)};
    base += 1U << bits;
  }
  return codes;
}
const std::array<DistanceCode, kDistances> kDistanceCodes = make_distance_codes();

// Of the code that tells lengths: the order in which its own are sent, and the extra bits of its symbols from 16 on.
constexpr std::array<uint8_t, 19> kOrder{16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
constexpr std::array<int, 3> kExtraBits{2, 3, 7};
}  // namespace

const LengthCode& length_code(size_t length) { return kLengthCodes[length]; }

// Each pair of symbols has the distances that take one bit more than those of the pair before.
const DistanceCode& distance_code(size_t distance) {
  if (distance <= 2) return kDistanceCodes[distance - 1];
  const auto bits = static_cast<size_t>(std::bit_width(distance - 1)) - 1;
  return kDistanceCodes[2 * bits + ((distance - 1) >> (bits - 1) & 1)];
}

BlockCode::BlockCode(std::span<const uint32_t, kSymbols> symbols, std::span<const uint32_t, kDistances> distances) {
  make(symbols, symbols_);
  make(distances, distances_);
  if (distances_.used == 1) distances_.lengths[0] = 1;  // there must be one
  std::array<uint8_t, kSymbols + kDistances> lengths;
  const auto middle = std::copy_n(symbols_.lengths.begin(), symbols_.used, lengths.begin());
  const auto end = std::copy_n(distances_.lengths.begin(), distances_.used, middle);
  list_lengths({lengths.begin(), end});
  make_head();
}

template <size_t kCount>
void BlockCode::make(std::span<const uint32_t, kCount> counts, Code<kCount>& code) {
  code_lengths(counts, kLongestCode, code.lengths);
  canonical_codes(code.lengths, code.codes);
  code.used = kCount;
  while (code.used > 1 && code.lengths[code.used - 1] == 0) --code.used;
  for (size_t i = 0; i < kCount; ++i) bits_ += counts[i] * code.lengths[i];
}

void BlockCode::add(size_t symbol, size_t extra) {
  items_[item_count_++] = {static_cast<uint8_t>(symbol), static_cast<uint8_t>(extra)};
  ++head_counts_[symbol];
}

// 16: the length before, 3 to 6 times; 17 and 18: 0, 3 to 10 and 11 to 138 times.
void BlockCode::list_lengths(std::span<const uint8_t> lengths) {
  for (size_t i = 0; i < lengths.size();) {
    const uint8_t length = lengths[i];
    size_t run = 1;
    while (i + run < lengths.size() && lengths[i + run] == length) ++run;
    i += run;
    if (length != 0) add(length, 0), --run;
    while (run >= 3) {
      const size_t taken = std::min<size_t>(run, length != 0 ? 6 : 138);
      if (length != 0)
        add(16, taken - 3);
      else
        add(taken < 11 ? 17 : 18, taken - (taken < 11 ? 3 : 11));
      run -= taken;
    }
    for (; run > 0; --run) add(length, 0);
  }
}

// Decoders want a complete code: of two symbols at least.
void BlockCode::make_head() {
  if (std::ranges::count(head_counts_, 0U) == kHeadSymbols - 1) ++head_counts_[head_counts_[0] > 0 ? 1 : 0];
  code_lengths(head_counts_, 7, head_lengths_);
  canonical_codes(head_lengths_, head_codes_);
  head_used_ = kHeadSymbols;
  while (head_used_ > 4 && head_lengths_[kOrder[head_used_ - 1]] == 0) --head_used_;
  bits_ += 17 + 3 * head_used_;
  for (size_t i = 0; i < kHeadSymbols; ++i)
    bits_ += head_counts_[i] * static_cast<size_t>(head_lengths_[i] + (i >= 16 ? kExtraBits[i - 16] : 0));
}

void BlockCode::put_head(BitWriter& out, bool is_last) const {
  out.put(is_last | 2U << 1, 3);
  out.put(symbols_.used - 257, 5);
  out.put(distances_.used - 1, 5);
  out.put(head_used_ - 4, 4);
  for (size_t i = 0; i < head_used_; ++i) {
    if (i % 8 == 0) out.flush();
    out.put(head_lengths_[kOrder[i]], 3);
  }
  for (size_t i = 0; i < item_count_; ++i) {
    out.flush();
    const Item& item = items_[i];
    out.put(head_codes_[item.symbol], head_lengths_[item.symbol]);
    if (item.symbol >= 16) out.put(item.extra, kExtraBits[item.symbol - 16]);
  }
  out.flush();
}

}  // namespace aftershade::io::deflate
