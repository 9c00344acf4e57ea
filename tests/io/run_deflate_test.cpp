#include "core/io/run_deflate.h"

#include <gtest/gtest.h>
#include <libdeflate.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include "core/io/huffman.h"

namespace aftershade::io {
namespace {
using Bytes = std::vector<uint8_t>;

/// Both decoders give back what went in.
void expect_decodes(const Bytes& stream, const Bytes& bytes, const std::string& what) {
  Bytes out(bytes.size());
  uLongf size = out.size();
  ASSERT_EQ(uncompress(out.data(), &size, stream.data(), stream.size()), Z_OK) << what;
  ASSERT_EQ(size, bytes.size()) << what;
  ASSERT_TRUE(out == bytes) << what;
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> inflate(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  Bytes again(bytes.size());
  ASSERT_EQ(
      libdeflate_zlib_decompress(inflate.get(), stream.data(), stream.size(), again.data(), again.size(), nullptr),
      LIBDEFLATE_SUCCESS)
      << what;
  ASSERT_TRUE(again == bytes) << what;
}

/// Two halves of `rows` rows of stretches, each filled by `kind` of its number.
template <class Fill>
std::pair<Bytes, std::vector<uint32_t>> halves(size_t rows, size_t kinds, size_t length, const Fill& fill) {
  Bytes bytes;
  std::vector<uint32_t> lengths;
  for (size_t row = 0; row < 2 * rows; ++row)
    for (size_t kind = 0; kind < kinds; ++kind) {
      lengths.push_back(static_cast<uint32_t>(length));
      for (size_t i = 0; i < length; ++i) bytes.push_back(static_cast<uint8_t>(fill(row, kind, i)));
    }
  return {bytes, lengths};
}

size_t packed_size(const Bytes& bytes, const std::vector<uint32_t>& lengths, size_t kinds, const std::string& what) {
  RunDeflate deflate;
  Bytes stream(bytes.size() + bytes.size() / 100 + 2000, 0xAA);
  const size_t size = deflate.deflate(bytes, lengths, kinds, stream);
  if (size == 0) return 0;
  stream.resize(size);
  expect_decodes(stream, bytes, what);
  return size;
}

TEST(RunDeflate, DecodersGiveBackNoiseOfAnyKind) {
  std::mt19937 random(3);
  int packed = 0;
  for (int round = 0; round < 60; ++round) {
    const size_t kinds = 1 + random() % 5, rows = 2 + random() % 3, length = 800 + random() % 3000;
    const int shift = static_cast<int>(random() % 4);
    std::normal_distribution<double> bell(128, static_cast<double>(1 + random() % 30));
    const auto [bytes, lengths] = halves(rows, kinds, length, [&](size_t, size_t kind, size_t i) -> size_t {
      switch ((kind + static_cast<size_t>(round)) % 5) {
        case 0:
          return random() >> shift;
        case 1:
          return static_cast<size_t>(std::clamp(bell(random), 0.0, 255.0));
        case 2:
          return random() % 8 == 0 ? random() : 128;  // short runs
        case 3:
          return i / 700 % 2 == 0 ? 128 : random();  // long ones
        default:
          return i % 2 == 0 ? 77 : i / 2 % 50;  // two in turn, and repetitions
      }
    });
    packed += packed_size(bytes, lengths, kinds, std::to_string(round)) > 0;
  }
  EXPECT_GT(packed, 40);
}

TEST(RunDeflate, IsCloseToTheEntropyOfNoise) {
  std::mt19937 random(4);
  const auto [bytes, lengths] = halves(16, 3, 1920, [&](size_t row, size_t kind, size_t) -> size_t {
    return kind == 0 ? 128 : row < 16 ? random() : 120 + random() % 16;  // constant; 8 bits, then 4
  });
  const double entropy = 2 * 16 * 1920 * (1 + 0.5);
  const size_t size = packed_size(bytes, lengths, 3, "noise");
  EXPECT_GT(static_cast<double>(size), entropy);
  EXPECT_LT(static_cast<double>(size), 1.02 * entropy);
}

TEST(RunDeflate, FindsRowsThatRepeat) {
  std::mt19937 random(4);
  Bytes row(3000);
  for (uint8_t& byte : row) byte = static_cast<uint8_t>(random());
  const auto [bytes, lengths] =
      halves(8, 2, 3000, [&](size_t, size_t kind, size_t i) -> size_t { return kind == 0 ? row[i] : random(); });
  EXPECT_LT(packed_size(bytes, lengths, 2, "rows"), bytes.size() * 6 / 10);
}

TEST(RunDeflate, LeavesToOthersWhatIsNotNoisy) {
  const auto [flat, lengths] = halves(4, 2, 2000, [](size_t, size_t, size_t) { return 128; });
  EXPECT_EQ(packed_size(flat, lengths, 2, "flat"), 0U);
  const auto [narrow, short_lengths] = halves(4, 2, 100, [](size_t row, size_t, size_t i) { return i * i * row; });
  EXPECT_EQ(packed_size(narrow, short_lengths, 2, "narrow"), 0U);
  std::mt19937 random(1);
  const auto [one_row, row_lengths] = halves(1, 2, 2000, [&](size_t, size_t, size_t) { return random(); });
  EXPECT_EQ(packed_size(one_row, row_lengths, 2, "one row"), 0U);
}

TEST(RunDeflate, NeverWritesPastItsRoom) {
  std::mt19937 random(9);
  const auto [bytes, lengths] =
      halves(3, 2, 1500, [&](size_t, size_t kind, size_t) -> size_t { return kind == 0 ? random() : random() % 5; });
  RunDeflate deflate;
  Bytes target(bytes.size() + 2000);
  const size_t whole = deflate.deflate(bytes, lengths, 2, target);
  ASSERT_GT(whole, 0U);
  for (size_t room = 0; room < whole + 60; room += room + 80 < whole ? 37 : 1) {
    std::fill(target.begin(), target.end(), uint8_t{0xAA});
    const size_t size = deflate.deflate(bytes, lengths, 2, {target.data(), room});
    EXPECT_TRUE(size == 0 || size == whole);
    EXPECT_TRUE(room < whole + 32 || size == whole) << "refuses " << room << " bytes";
    for (size_t i = room; i < target.size(); ++i) ASSERT_EQ(target[i], 0xAA) << room;
  }
}

/// Sum of 2^-length: 1 for a code that decodes every sequence of bits and each in one way.
double kraft(const std::vector<uint8_t>& lengths) {
  return std::accumulate(lengths.begin(), lengths.end(), 0.0, [](double sum, uint8_t length) {
    return sum + (length > 0 ? std::ldexp(1.0, -length) : 0.0);
  });
}

TEST(Huffman, LengthsMakeACompleteCodeOfTheBestOrderWithinTheLimit) {
  std::mt19937 random(2);
  for (int round = 0; round < 300; ++round) {
    std::vector<uint32_t> counts(2 + random() % 285);
    for (uint32_t& count : counts)
      count = random() % 3 == 0 ? 0U : static_cast<uint32_t>(1 + (random() >> (12 + random() % 20)));
    counts.front() = counts.back() = 1;
    for (const int limit : {9, 14}) {
      std::vector<uint8_t> lengths(counts.size());
      code_lengths(counts, limit, lengths);
      EXPECT_EQ(kraft(lengths), 1);
      for (size_t i = 0; i < counts.size(); ++i) {
        EXPECT_EQ(counts[i] == 0, lengths[i] == 0);
        EXPECT_LE(lengths[i], limit);
        for (size_t j = 0; j < counts.size(); ++j)
          if (limit == 14 && counts[j] > 0 && counts[i] > counts[j]) {
            ASSERT_LE(lengths[i], lengths[j]);
          }
      }
    }
  }
}

TEST(Huffman, FollowsTheWorkedExampleOfRfc1951) {
  const std::vector<uint8_t> lengths{3, 3, 3, 3, 3, 2, 4, 4};  // 3.2.2: ABCDEFGH
  const std::vector<uint16_t> expected{0b010, 0b011, 0b100, 0b101, 0b110, 0b00, 0b1110, 0b1111};
  std::vector<uint16_t> codes(8);
  canonical_codes(lengths, codes);
  for (size_t i = 0; i < 8; ++i) {
    uint16_t reversed = 0;
    for (int bit = 0; bit < lengths[i]; ++bit) reversed = static_cast<uint16_t>(reversed << 1 | (codes[i] >> bit & 1));
    EXPECT_EQ(reversed, expected[i]) << i;
  }
}

TEST(Huffman, KnowsOneSymbolAndNone) {
  std::vector<uint8_t> lengths(4, 9);
  code_lengths(std::vector<uint32_t>{0, 0, 7, 0}, 14, lengths);
  EXPECT_EQ(lengths, (std::vector<uint8_t>{0, 0, 1, 0}));
  code_lengths(std::vector<uint32_t>{0, 0, 0, 0}, 14, lengths);
  EXPECT_EQ(lengths, (std::vector<uint8_t>{0, 0, 0, 0}));
}

TEST(Huffman, IsOptimal) {  // Fibonacci counts: every depth once
  std::vector<uint32_t> counts{1, 1};
  while (counts.size() < 12) counts.push_back(counts[counts.size() - 1] + counts[counts.size() - 2]);
  std::vector<uint8_t> lengths(counts.size());
  code_lengths(counts, 14, lengths);
  EXPECT_EQ(lengths, (std::vector<uint8_t>{11, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1}));
}

}  // namespace
}  // namespace aftershade::io
