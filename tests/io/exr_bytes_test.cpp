#include "core/io/exr_bytes.h"

#include <gtest/gtest.h>
#include <half.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "core/simd/targets.h"

namespace aftershade::io {
namespace {

/// Every SIMD target in turn.
class ExrBytes : public testing::TestWithParam<std::string> {
 protected:
  ExrBytes() { lanes::force_target(GetParam()); }
  ~ExrBytes() override { lanes::force_target(lanes::targets().front()); }
};
INSTANTIATE_TEST_SUITE_P(Targets, ExrBytes, testing::ValuesIn(lanes::targets()),
                         [](const auto& target) { return target.param; });

std::vector<uint8_t> noise(size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<uint8_t> bytes(size);
  for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
  return bytes;
}

/// OpenEXR File Layout, word for word.
std::vector<uint8_t> coded(const std::vector<uint8_t>& pixels) {
  std::vector<uint8_t> halves;
  for (size_t i = 0; i < pixels.size(); i += 2) halves.push_back(pixels[i]);
  for (size_t i = 1; i < pixels.size(); i += 2) halves.push_back(pixels[i]);
  std::vector<uint8_t> out = halves;
  for (size_t i = 1; i < halves.size(); ++i) out[i] = static_cast<uint8_t>(halves[i] - halves[i - 1] + 128);
  return out;
}

TEST_P(ExrBytes, SplitsRowsAndJoinsThemAgain) {
  for (size_t size = 2; size < 1000; size += size < 300 ? 2 : 34) {
    const std::vector<uint8_t> pixels = noise(size, static_cast<unsigned>(size));
    for (const size_t row : {size, size_t{2}, size / 6 * 2}) {
      if (row == 0) continue;
      std::vector<uint8_t> split(size, 99), joined(size, 98);
      HalfSplitter splitter(split.data(), size);
      for (size_t at = 0; at < size; at += row) splitter.add(pixels.data() + at, std::min(row, size - at));
      splitter.finish();
      ASSERT_EQ(split, coded(pixels)) << size << " in rows of " << row;
      join_halves(split.data(), size, joined.data());
      ASSERT_EQ(joined, pixels) << size;
    }
  }
}

TEST_P(ExrBytes, ConvertsEveryHalfAsImathDoes) {
  std::vector<uint16_t> halves(65536);
  for (size_t i = 0; i < halves.size(); ++i) halves[i] = static_cast<uint16_t>(i);
  std::vector<float> floats(halves.size());
  const NotNumbers found =
      to_floats(PixelType::half, reinterpret_cast<const char*>(halves.data()), 65536, floats.data());
  EXPECT_EQ(found.infinite, 2);
  EXPECT_EQ(found.nan, 2 * 1023);
  for (size_t i = 0; i < halves.size(); ++i)
    ASSERT_EQ(std::bit_cast<uint32_t>(floats[i]),
              std::bit_cast<uint32_t>(float(half(half::FromBits, static_cast<uint16_t>(i)))))
        << i;
}

/// What packing must give: Imath's rounding, finite values clamped.
uint16_t expected_half(float value) {
  if (std::isfinite(value)) value = std::clamp(value, -65504.0F, 65504.0F);
  return half(value).bits();
}

TEST_P(ExrBytes, PacksFloatsAsImathDoes) {
  std::mt19937 random(5);
  std::vector<float> floats;
  for (uint32_t h = 0; h < 65536; ++h) {  // every half, the middles between neighbours, and what lies beside those
    const auto bits = std::bit_cast<uint32_t>(float(half(half::FromBits, static_cast<uint16_t>(h))));
    for (const uint32_t step : {0U, 0xFFFU, 0x1000U, 0x1001U, 0xFFFFFFFFU})
      floats.push_back(std::bit_cast<float>(bits + step));
  }
  for (int i = 0; i < 300000; ++i) floats.push_back(std::bit_cast<float>(static_cast<uint32_t>(random())));
  for (int i = 0; i < 100000; ++i)
    floats.push_back(
        std::ldexp(static_cast<float>(random() % 65536) / 65536.0F, -13 - static_cast<int>(random() % 14)));
  const auto count = static_cast<int>(floats.size());
  std::vector<uint16_t> packed(floats.size(), 0x7E55);
  EXPECT_TRUE(pack_row(PixelType::half, floats.data(), count, reinterpret_cast<char*>(packed.data())));
  for (size_t i = 0; i < floats.size(); ++i) {
    if (std::bit_cast<uint32_t>(floats[i]) == std::bit_cast<uint32_t>(float(half(half::FromBits, 0x7E55)))) continue;
    ASSERT_EQ(packed[i], expected_half(floats[i])) << std::bit_cast<uint32_t>(floats[i]);
  }
  EXPECT_FALSE(pack_row(PixelType::half, floats.data(), count, reinterpret_cast<char*>(packed.data())));
}

TEST_P(ExrBytes, SaysWhetherABitHasChanged) {
  for (const PixelType type : {PixelType::half, PixelType::single, PixelType::uint})
    for (int count = 1; count < 70; ++count) {
      std::vector<char> stored(4 * static_cast<size_t>(count));
      const std::vector<uint8_t> bytes = noise(stored.size(), static_cast<unsigned>(count));
      std::memcpy(stored.data(), bytes.data(), stored.size());
      std::vector<float> floats(static_cast<size_t>(count) + 1, 7.0F);
      to_floats(type, stored.data(), count, floats.data());
      EXPECT_EQ(floats.back(), 7.0F) << "wrote past the row";
      const std::vector<char> before = stored;
      EXPECT_FALSE(pack_row(type, floats.data(), count, stored.data()));
      EXPECT_EQ(stored, before);
      floats[static_cast<size_t>(count) / 2] = 0.3125F;
      EXPECT_TRUE(pack_row(type, floats.data(), count, stored.data()));
      EXPECT_NE(stored, before);
    }
}

}  // namespace
}  // namespace aftershade::io
