#pragma once
#include <cstdint>
#include <span>

namespace aftershade::io {

/// Lengths in bits of an optimal prefix code for symbols that occur so often, none above `limit` (for which it may be a
/// little worse than optimal); 0 for symbols that do not occur. At most 288 symbols; counts below 2^16 in sum make no
/// code longer than 24 bits.
void code_lengths(std::span<const uint32_t> counts, int limit, std::span<uint8_t> lengths);

/// The codes of these lengths as Deflate numbers and sends them (RFC 1951, 3.2.2): the first bit lowest. Of symbols of
/// length 0 nothing is written.
void canonical_codes(std::span<const uint8_t> lengths, std::span<uint16_t> codes);

}  // namespace aftershade::io
