#include "core/io/huffman.h"

#include <algorithm>
#include <array>

namespace aftershade::io {

namespace {
constexpr size_t kMostSymbols = 288;
using Symbols = std::array<uint32_t, kMostSymbols>;

/// The symbols that occur, rarest first, each as count * 512 + symbol.
size_t sorted(std::span<const uint32_t> counts, Symbols& out) {
  Symbols present;
  size_t used = 0;
  for (uint32_t symbol = 0; symbol < counts.size(); ++symbol) {
    present[used] = counts[symbol] << 9 | symbol;
    used += counts[symbol] > 0 ? 1 : 0;
  }
  constexpr uint32_t kCommon = 255;  // rarer ones are sorted by counting
  std::array<uint16_t, kCommon + 1> ends{};
  for (size_t i = 0; i < used; ++i) ++ends[std::min(present[i] >> 9, kCommon)];
  uint16_t sum = 0;
  for (uint16_t& end : ends) {
    sum = static_cast<uint16_t>(sum + end);
    end = static_cast<uint16_t>(sum - end);
  }
  const size_t common = ends[kCommon];
  for (size_t i = 0; i < used; ++i) out[ends[std::min(present[i] >> 9, kCommon)]++] = present[i];
  std::sort(out.begin() + common, out.begin() + used);
  return used;
}

/// Depths of the leaves of a Huffman tree, in place: in, weights in ascending order; out, depths in descending order.
/// Moffat and Katajainen, In-Place Calculation of Minimum-Redundancy Codes, 1995.
void depths(std::span<uint32_t> a) {
  const size_t n = a.size();
  if (n == 1) a[0] = 1;
  if (n < 2) return;
  size_t root = 0, leaf = 0;
  const auto lightest = [&](size_t next) {
    if (leaf >= n || (root < next && a[root] < a[leaf])) {
      const uint32_t weight = a[root];
      a[root++] = static_cast<uint32_t>(next);  // its parent
      return weight;
    }
    return a[leaf++];
  };
  for (size_t next = 0; next < n - 1; ++next) {
    const uint32_t first = lightest(next), second = lightest(next);
    a[next] = first + second;
  }
  a[n - 2] = 0;
  for (size_t i = n - 2; i-- > 0;) a[i] = a[a[i]] + 1;  // of inner nodes
  size_t available = 1, at = n, inner = n - 1;
  for (uint32_t depth = 0; available > 0; ++depth) {
    size_t used = 0;
    while (inner > 0 && a[inner - 1] == depth) ++used, --inner;
    for (; available > used; --available) a[--at] = depth;
    available = 2 * used;
  }
}
}  // namespace

void code_lengths(std::span<const uint32_t> counts, int limit, std::span<uint8_t> lengths) {
  std::ranges::fill(lengths, uint8_t{0});
  Symbols symbols, weights;
  const size_t used = sorted(counts, symbols);
  for (size_t i = 0; i < used; ++i) weights[i] = symbols[i] >> 9;
  const std::span<uint32_t> tree(weights.data(), used);
  for (uint32_t flat = 1; used > 0; flat *= 2) {  // counts more alike make a flatter tree
    depths(tree);
    if (weights[0] <= static_cast<uint32_t>(limit)) break;
    for (size_t i = 0; i < used; ++i) weights[i] = (symbols[i] >> 9) / (2 * flat) + 1;
  }
  for (size_t i = 0; i < used; ++i) lengths[symbols[i] & 511] = static_cast<uint8_t>(weights[i]);
}

void canonical_codes(std::span<const uint8_t> lengths, std::span<uint16_t> codes) {
  std::array<uint16_t, 16> next{}, of_length{};
  std::array<uint16_t, kMostSymbols> present;
  size_t used = 0;
  for (size_t i = 0; i < lengths.size(); ++i) {
    present[used] = static_cast<uint16_t>(i);
    used += lengths[i] > 0 ? 1 : 0;
  }
  for (size_t i = 0; i < used; ++i) ++of_length[lengths[present[i]]];
  for (size_t bits = 1; bits < next.size(); ++bits)
    next[bits] = static_cast<uint16_t>((next[bits - 1] + of_length[bits - 1]) << 1);
  for (const uint16_t i : std::span(present.data(), used)) {
    uint32_t code = next[lengths[i]]++;
    code = (code & 0x5555) << 1 | (code >> 1 & 0x5555);
    code = (code & 0x3333) << 2 | (code >> 2 & 0x3333);
    code = (code & 0x0F0F) << 4 | (code >> 4 & 0x0F0F);
    code = (code & 0x00FF) << 8 | code >> 8;
    codes[i] = static_cast<uint16_t>(code >> (16 - lengths[i]));
  }
}

}  // namespace aftershade::io
