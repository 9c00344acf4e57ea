#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/io/deflate_code.h"

namespace aftershade::io {

/// Makes zlib streams (RFC 1950, RFC 1951) of the bytes of rendered pictures: rows of several channels in turn, whose
/// statistics differ and which hold much noise. Each stretch of one channel's bytes is sent with the prefix code that
/// suits it, or as it is where there is nothing to win, or together with the next when that is as cheap. Runs are
/// looked for everywhere, other repetitions (longer than a few bytes, the latest alone) in those channels where the
/// second row shows that they pay. Twice as fast as libdeflate's level 4 on such pictures, and no larger; on smooth or
/// flat ones a thorough search does better, and this one does not try.
class RunDeflate {
 public:
  /// `lengths`: of the stretches that make up `bytes`: two halves alike, each of rows of `kinds` stretches. Returns the
  /// size of the stream; 0 when `target` has no room for it, or when the bytes are not of the kind: single rows, short
  /// stretches, little noise.
  size_t deflate(std::span<const uint8_t> bytes, std::span<const uint32_t> lengths, size_t kinds,
                 std::span<uint8_t> target);

 private:
  /// Literals, then a match: as many bytes as stand that far before; of length 0 at the end of a stretch.
  struct Token {
    uint32_t literals;
    uint16_t match, distance_less_1;
  };
  /// One or more stretches that have one code.
  struct Block {
    std::array<uint32_t, deflate::kSymbols> symbols{};  ///< how often each occurs
    std::array<uint32_t, deflate::kDistances> distances{};
    size_t bytes = 0, tokens = 0, extra_bits = 0;
    double coded_bits = 0, stored_bits = 0;  ///< estimates
    double bits() const { return coded_bits < stored_bits ? coded_bits : stored_bits; }
    void add(const Block& next);
    void estimate();
  };
  enum class Search { everything, runs };
  class Writer;

  bool find_blocks(std::span<const uint8_t> bytes, std::span<const uint32_t> lengths, size_t kinds);
  Block find_tokens(const uint8_t* bytes, size_t start, size_t end, Search search);
  Block find_best_tokens(const uint8_t* bytes, size_t start, size_t end, Search& best);

  std::vector<Token> tokens_;
  std::vector<Block> blocks_;
  std::vector<uint32_t> seen_;  ///< where bytes of a hash were last
  std::vector<Search> searches_;
};

}  // namespace aftershade::io
