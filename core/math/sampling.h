#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace aftershade {

/// Counter-based noise: 32 well mixed bits of (x, y, frame, index), so that no state is shared between pixels.
/// The finaliser is "lowbias32" (C. Wellons, hash-prospector, public domain), chained over the counters.
constexpr uint32_t mix_bits(uint32_t h) {
  h ^= h >> 16;
  h *= 0x7feb352dU;
  h ^= h >> 15;
  h *= 0x846ca68bU;
  return h ^ (h >> 16);
}
constexpr uint32_t hash_counters(uint32_t x, uint32_t y, uint32_t frame = 0, uint32_t index = 0) {
  return mix_bits(x ^ mix_bits(y ^ mix_bits(frame ^ mix_bits(index))));
}
/// Uniform in [0, 1), 24 bits: exact in a float.
constexpr float unit_float(uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }

/// A 4x4 ordered pattern of 16 distinct values (k + 0.5) / 16, every 2x2 block of which covers [0,1) evenly
/// (Bayer 1973). Indexed by the low two bits of the absolute pixel coordinates: row y, column x.
constexpr std::array<float, 16> kBayer4x4 = [] {
  constexpr int order[16] = {0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  std::array<float, 16> values{};
  for (int i = 0; i < 16; ++i) values[static_cast<size_t>(i)] = (static_cast<float>(order[i]) + 0.5F) / 16.0F;
  return values;
}();

}  // namespace aftershade
