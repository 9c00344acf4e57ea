#include "core/io/run_deflate.h"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "core/io/deflate_code.h"
#include "core/simd/scalar.h"

namespace aftershade::io {

using namespace deflate;

namespace {
constexpr size_t kShortestRun = 6, kShortestMatch = 6;  // shorter ones are seldom cheaper than literals
constexpr int kHashBits = 13;

/// n log2 n, for whole numbers; not libm's, so that files are the same bytes on every processor.
constexpr size_t kTable = 4096;
const std::array<float, kTable> kWeights = [] {
  std::array<float, kTable> table{};
  for (size_t n = 1; n < kTable; ++n) table[n] = static_cast<float>(n) * lanes::log2_of(static_cast<float>(n));
  return table;
}();
float weight(uint32_t n) {
  return n < kTable ? kWeights[n] : static_cast<float>(n) * lanes::log2_of(static_cast<float>(n));
}

uint32_t load_u32(const uint8_t* at) {
  uint32_t value;
  std::memcpy(&value, at, sizeof value);
  return value;
}
uint64_t load_u64(const uint8_t* at) {
  uint64_t value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

}  // namespace

void RunDeflate::Block::add(const Block& next) {
  for (size_t i = 0; i < symbols.size(); ++i) symbols[i] += next.symbols[i];
  for (size_t i = 0; i < distances.size(); ++i) distances[i] += next.distances[i];
  --symbols[kEndOfBlock];
  bytes += next.bytes;
  tokens += next.tokens;
  extra_bits += next.extra_bits;
  estimate();
}

/// The entropy, and a head of some bits for each symbol that is used.
void RunDeflate::Block::estimate() {
  constexpr double kCodedHead = 60, kPerSymbol = 2.5, kStoredHead = 40;
  const auto entropy_and_head = [](std::span<const uint32_t> counts) {
    float sum = 0;
    uint32_t total = 0, used = 0;
    for (const uint32_t count : counts) {
      sum += weight(count);
      total += count;
      used += count > 0 ? 1 : 0;
    }
    return static_cast<double>(weight(total) - sum) + kPerSymbol * used;
  };
  coded_bits = entropy_and_head(symbols) + entropy_and_head(distances) + kCodedHead + static_cast<double>(extra_bits);
  stored_bits = 8.0 * static_cast<double>(bytes) + kStoredHead;
}

namespace {
/// Counts bytes in four tables in turn: a counter is not needed again at once when a byte repeats.
class ByteCounter {
 public:
  void count(const uint8_t* bytes, size_t size) {
    size_t i = 0;
    for (; i + 4 <= size; i += 4)
      for (size_t k = 0; k < 4; ++k) ++tables_[k][bytes[i + k]];
    for (; i < size; ++i) ++tables_[0][bytes[i]];
  }
  void sum(std::span<uint32_t> counts) const {
    for (size_t i = 0; i < 256; ++i) counts[i] += tables_[0][i] + tables_[1][i] + tables_[2][i] + tables_[3][i];
  }

 private:
  std::array<std::array<uint32_t, 256>, 4> tables_{};
};

struct Match {
  size_t from, length, distance;
};

/// The match around `at` of what stands there and `distance` before, in [first, end).
Match extend(const uint8_t* bytes, size_t at, size_t distance, size_t first, size_t end) {
  size_t from = at, last = at + 4;
  while (from > first && from > distance && bytes[from - 1] == bytes[from - 1 - distance]) --from;
  while (last + 8 <= end) {
    const uint64_t differences = load_u64(bytes + last) ^ load_u64(bytes + last - distance);
    if (differences != 0) return {from, last + static_cast<size_t>(std::countr_zero(differences)) / 8 - from, distance};
    last += 8;
  }
  while (last < end && bytes[last] == bytes[last - distance]) ++last;
  return {from, last - from, distance};
}

/// A run of one byte or of two in turn around `at`, in [first, end); length 0 when there is none worth while.
Match find_run(const uint8_t* bytes, size_t at, size_t first, size_t end) {
  const uint32_t value = load_u32(bytes + at);
  for (const size_t distance : {1, 2})
    if (at >= distance && value == load_u32(bytes + at - distance)) {
      const Match run = extend(bytes, at, distance, first, end);
      if (run.length >= kShortestRun) return run;
    }
  return {};
}

/// Anything that has been seen before.
Match find_match(const uint8_t* bytes, size_t at, size_t first, size_t end, std::span<uint32_t> seen) {
  constexpr int kRest = 64 - 8 * kShortestMatch;
  const uint64_t value = load_u64(bytes + at);
  uint32_t& place = seen[(value << kRest) * 0x9E3779B97F4A7C15 >> (64 - kHashBits)];
  const size_t before = place;
  place = static_cast<uint32_t>(at);
  if (const Match run = find_run(bytes, at, first, end); run.length > 0) return run;
  if (before >= at || at - before > kFarthest || (load_u64(bytes + before) ^ value) << kRest != 0) return {};
  return extend(bytes, at, at - before, first, end);
}
}  // namespace

RunDeflate::Block RunDeflate::find_tokens(const uint8_t* bytes, size_t start, size_t end, Search search) {
  Block block;
  ByteCounter literals;
  size_t done = start;
  const auto add = [&](const Match& match) {  // literals up to there, then the match
    literals.count(bytes + done, match.from - done);
    size_t skipped = match.from - done;
    for (size_t left = match.length; left > 0; skipped = 0) {
      size_t taken = std::min(left, kLongestMatch);
      if (left - taken == 1 || left - taken == 2) taken -= 3;  // no match is shorter than 3
      tokens_.push_back(
          {static_cast<uint32_t>(skipped), static_cast<uint16_t>(taken), static_cast<uint16_t>(match.distance - 1)});
      const DistanceCode& distance = distance_code(match.distance);
      ++block.tokens;
      ++block.symbols[length_code(taken).symbol];
      ++block.distances[distance.symbol];
      block.extra_bits += length_code(taken).extra_bits + size_t{distance.extra_bits};
      left -= taken;
    }
    done = match.from + match.length;
  };
  constexpr size_t kPatience = 5;  // where nothing is found, ever more is skipped
  size_t misses = 0;
  for (size_t at = start; at + 8 <= end;) {
    const Match match =
        search == Search::runs ? find_run(bytes, at, done, end) : find_match(bytes, at, done, end, seen_);
    if (match.length > 0) {
      add(match);
      at = done;
      misses = 0;
    } else {
      at += search == Search::runs ? 4 : 1 + (misses++ >> kPatience);
    }
  }
  literals.count(bytes + done, end - done);
  if (done < end) tokens_.push_back({static_cast<uint32_t>(end - done), 0, 0}), ++block.tokens;
  literals.sum(block.symbols);
  ++block.symbols[kEndOfBlock];
  block.bytes = end - start;
  block.estimate();
  return block;
}

/// Both ways; the search for everything must be worth its time.
RunDeflate::Block RunDeflate::find_best_tokens(const uint8_t* bytes, size_t start, size_t end, Search& best) {
  constexpr double kWorth = 1.1;
  const size_t before = tokens_.size();
  const Block all = find_tokens(bytes, start, end, Search::everything);
  const Block runs = find_tokens(bytes, start, end, Search::runs);
  best = runs.bits() <= kWorth * all.bits() ? Search::runs : Search::everything;
  const auto first = tokens_.begin() + static_cast<std::ptrdiff_t>(before),
             second = first + static_cast<std::ptrdiff_t>(all.tokens);
  if (best == Search::runs)
    tokens_.erase(first, second);
  else
    tokens_.erase(second, tokens_.end());
  return best == Search::runs ? runs : all;
}

namespace {
constexpr size_t kSlack = 16;  // BitWriter writes ahead

void put_stored(BitWriter& out, const uint8_t* bytes, size_t size, bool is_last) {
  for (size_t done = 0; done < size;) {
    const size_t taken = std::min(size - done, kLongestStored);
    out.put(is_last && done + taken == size ? 1 : 0, 3);
    out.align();
    out.put(taken | (~taken & 0xFFFF) << 16, 32);
    out.align();
    out.copy(bytes + done, taken);
    done += taken;
  }
}

template <class Tokens>
void put_coded(BitWriter& out, const BlockCode& code, const uint8_t* bytes, const Tokens& tokens, bool is_last) {
  code.put_head(out, is_last);
  std::array<uint32_t, 256> literal;
  for (size_t i = 0; i < literal.size(); ++i) literal[i] = code.literal(i);
  BitWriter writer = out;
  const auto put = [&](uint8_t byte) { writer.put(literal[byte] & 0xFFFF, static_cast<int>(literal[byte] >> 16)); };
  for (const auto& [literals, run, distance_less_1] : tokens) {
    const uint8_t* const end = bytes + literals;
    for (; bytes + 4 <= end; bytes += 4) {
      put(bytes[0]);
      put(bytes[1]);
      put(bytes[2]);
      put(bytes[3]);
      writer.flush();
    }
    for (; bytes < end; ++bytes) put(*bytes);
    writer.flush();
    if (run == 0) continue;
    const LengthCode& length = length_code(run);
    code.put_symbol(writer, length.symbol);
    writer.put(length.extra, length.extra_bits);
    const DistanceCode& distance = distance_code(distance_less_1 + size_t{1});
    code.put_distance(writer, distance.symbol);
    writer.put(distance_less_1 + 1U - distance.base, distance.extra_bits);
    writer.flush();
    bytes += run;
  }
  code.put_symbol(writer, kEndOfBlock);
  writer.flush();
  out = writer;
}
}  // namespace

/// Writes blocks one after the other.
class RunDeflate::Writer {
 public:
  Writer(const uint8_t* bytes, const Token* tokens, std::span<uint8_t> target)
      : bytes_(bytes), tokens_(tokens), out_(target.data()), end_(target.data() + target.size()) {}

  /// Returns false when there is no room.
  bool put(const Block& block, bool is_last) {
    const auto room = static_cast<size_t>(std::max<std::ptrdiff_t>(end_ - out_.at(), 0));
    if (block.coded_bits >= block.stored_bits) {
      if (block.bytes + 6 * (block.bytes / kLongestStored + 1) + kSlack > room) return false;
      put_stored(out_, bytes_, block.bytes, is_last);
    } else {
      const BlockCode code(block.symbols, block.distances);
      if ((code.bits() + block.extra_bits) / 8 + 1 + kSlack > room) return false;
      put_coded(out_, code, bytes_, std::span(tokens_, block.tokens), is_last);
    }
    bytes_ += block.bytes;
    tokens_ += block.tokens;
    return true;
  }
  /// Past the last whole byte.
  uint8_t* end() { return out_.align(); }

 private:
  const uint8_t* bytes_;
  const Token* tokens_;
  BitWriter out_;
  const uint8_t* end_;
};

/// Finds the blocks of all stretches; false when they are not noisy enough to be better off here.
bool RunDeflate::find_blocks(std::span<const uint8_t> bytes, std::span<const uint32_t> lengths, size_t kinds) {
  constexpr size_t kLargestBlock = 1 << 20;
  constexpr double kNoisy = 0.25;     // of their size is what the first rows at least take
  constexpr double kBlockCost = 150;  // bits that a block less may cost: time is worth something, too
  tokens_.clear();
  blocks_.clear();
  seen_.assign(size_t{1} << kHashBits, 0);
  searches_.assign(2 * kinds, Search::everything);
  const size_t half = lengths.size() / 2;
  double bits = 0;
  size_t start = 0;
  for (size_t i = 0; i < lengths.size(); ++i) {
    const size_t end = start + lengths[i], row = i % half / kinds;
    Search& search = searches_[i % kinds + (i < half ? 0 : kinds)];
    const Block next =
        row == 1 ? find_best_tokens(bytes.data(), start, end, search) : find_tokens(bytes.data(), start, end, search);
    start = end;
    bits += next.bits();
    if (i + 1 == 2 * kinds && bits < kNoisy * 8 * static_cast<double>(end)) return false;
    if (!blocks_.empty()) {
      Block both = blocks_.back();
      both.add(next);
      if (both.bytes <= kLargestBlock && both.bits() <= blocks_.back().bits() + next.bits() + kBlockCost) {
        blocks_.back() = both;
        continue;
      }
    }
    blocks_.push_back(next);
  }
  return true;
}

size_t RunDeflate::deflate(std::span<const uint8_t> bytes, std::span<const uint32_t> lengths, size_t kinds,
                           std::span<uint8_t> target) {
  constexpr size_t kHead = 2, kAdler = 4, kShortest = 800;  // a code of its own costs some 80 bytes
  if (lengths.size() < 4 * kinds || bytes.size() < kShortest * lengths.size() || target.size() < kHead + kAdler)
    return 0;
  if (!find_blocks(bytes, lengths, kinds)) return 0;
  target[0] = 0x78, target[1] = 0x01;  // Deflate, window of 32 KiB
  Writer writer(bytes.data(), tokens_.data(), target.subspan(kHead, target.size() - kHead - kAdler));
  for (const Block& block : blocks_)
    if (!writer.put(block, &block == &blocks_.back())) return 0;
  uint8_t* at = writer.end();
  const uint32_t adler = libdeflate_adler32(1, bytes.data(), bytes.size());
  for (const int shift : {24, 16, 8, 0}) *at++ = static_cast<uint8_t>(adler >> shift);
  return static_cast<size_t>(at - target.data());
}

}  // namespace aftershade::io
