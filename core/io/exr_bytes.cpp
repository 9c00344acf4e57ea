#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/io/exr_bytes.cpp"  // this file, compiled once a SIMD target
#include "core/io/exr_bytes.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cmath>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace aftershade::io::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// ---- bytes ----

/// The sum of `count` bytes, modulo 256.
uint8_t sum_of(const uint8_t* bytes, size_t count) {
  size_t i = 0;
  uint64_t sum = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<uint8_t> d;
  const hn::Repartition<uint64_t, decltype(d)> sums;
  auto total = hn::Zero(sums);
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) total = hn::Add(total, hn::SumsOf8(hn::LoadU(d, bytes + i)));
  sum = hn::GetLane(hn::SumOfLanes(sums, total));
#endif
  for (; i < count; ++i) sum += bytes[i];
  return static_cast<uint8_t>(sum);
}

#if HWY_TARGET != HWY_SCALAR
constexpr size_t kBlock = 16;
using Block = hn::CappedTag<uint8_t, kBlock>;

/// Lane i becomes the sum of lanes 0 to i.
template <class V>
HWY_INLINE V prefix_sums(V v) {
  const Block d;
  v = hn::Add(v, hn::ShiftLeftBytes<1>(d, v));
  v = hn::Add(v, hn::ShiftLeftBytes<2>(d, v));
  v = hn::Add(v, hn::ShiftLeftBytes<4>(d, v));
  return hn::Add(v, hn::ShiftLeftBytes<8>(d, v));
}
#endif

// A byte is the sum of all coded bytes up to its own, less 128 for each but the first. Modulo 256 two 128s are nothing:
// within a block they turn every other byte's upper bit, and a block of an even number of bytes leaves nothing of them.
void join_halves(const uint8_t* coded, size_t size, uint8_t* pixels) {
  const size_t half = size / 2;
  const uint8_t *low = coded, *high = coded + half;
  auto even = static_cast<uint8_t>(128);  // the first byte is as it is
  auto odd = static_cast<uint8_t>(even + sum_of(low, half) + 128 * half);
  size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
  const Block d;
  const auto last = hn::Set(d, uint8_t{kBlock - 1}), turn = hn::And(hn::Iota(d, uint8_t{1}), hn::Set(d, uint8_t{1}));
  const auto odd_turns = hn::BitCast(d, hn::ShiftLeft<7>(hn::BitCast(hn::Repartition<uint16_t, Block>(), turn)));
  auto even_sum = hn::Set(d, even), odd_sum = hn::Set(d, odd);
  for (; i + kBlock <= half; i += kBlock) {
    const auto evens = prefix_sums(hn::LoadU(d, low + i)), odds = prefix_sums(hn::LoadU(d, high + i));
    hn::StoreInterleaved2(hn::Xor(hn::Add(evens, even_sum), odd_turns), hn::Xor(hn::Add(odds, odd_sum), odd_turns), d,
                          pixels + 2 * i);
    even_sum = hn::Add(even_sum, hn::TableLookupBytes(evens, last));
    odd_sum = hn::Add(odd_sum, hn::TableLookupBytes(odds, last));
  }
  even = hn::GetLane(even_sum);
  odd = hn::GetLane(odd_sum);
#endif
  for (; i < half; ++i) {
    pixels[2 * i] = even = static_cast<uint8_t>(even + low[i] - 128);
    pixels[2 * i + 1] = odd = static_cast<uint8_t>(odd + high[i] - 128);
  }
}

/// Differences of the even and of the odd bytes of a row, plus 128, but for the first pair.
void split_differences(const uint8_t* row, size_t pairs, uint8_t* low, uint8_t* high) {
  size_t i = 1;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<uint8_t> d;
  const size_t lanes = hn::Lanes(d);
  const auto middle = hn::Set(d, uint8_t{128});
  for (; i + lanes <= pairs; i += lanes) {
    auto even = hn::Undefined(d), odd = even, even_before = even, odd_before = even;
    hn::LoadInterleaved2(d, row + 2 * i, even, odd);
    hn::LoadInterleaved2(d, row + 2 * i - 2, even_before, odd_before);
    hn::StoreU(hn::Xor(hn::Sub(even, even_before), middle), d, low + i);
    hn::StoreU(hn::Xor(hn::Sub(odd, odd_before), middle), d, high + i);
  }
#endif
  for (; i < pairs; ++i) {
    low[i] = static_cast<uint8_t>(row[2 * i] - row[2 * i - 2] + 128);
    high[i] = static_cast<uint8_t>(row[2 * i + 1] - row[2 * i - 1] + 128);
  }
}

// ---- values ----

using Floats = hn::ScalableTag<float>;
using Words = hn::RebindToUnsigned<Floats>;
using Halves = hn::Rebind<uint16_t, Words>;
using WordVec = hn::Vec<Words>;

/// Of any alignment.
template <class D>
HWY_INLINE hn::Vec<D> load(D d, const char* at) {
#if HWY_TARGET == HWY_SCALAR
  hn::TFromD<D> value;
  std::memcpy(&value, at, sizeof value);
  return hn::Set(d, value);
#else
  return hn::LoadU(d, reinterpret_cast<const hn::TFromD<D>*>(at));
#endif
}
template <class D>
HWY_INLINE void store(hn::Vec<D> v, D d, char* at) {
#if HWY_TARGET == HWY_SCALAR
  const auto value = hn::GetLane(v);
  std::memcpy(at, &value, sizeof value);
  (void)d;
#else
  hn::StoreU(v, d, reinterpret_cast<hn::TFromD<D>*>(at));
#endif
}

constexpr uint32_t kInfinity = 0x7F800000, kLargestHalf = 0x477FE000, kSmallestNormalHalf = 0x38800000;

/// Halves in the lower 16 bits to floats, all exact. Denormal halves are whole numbers of 2^-24.
HWY_INLINE WordVec half_to_float(WordVec half) {
  const Words d;
  const auto magnitude = hn::And(half, hn::Set(d, 0x7FFFU)), sign = hn::ShiftLeft<16>(hn::Sub(half, magnitude));
  constexpr uint32_t kBias = 112U << 23;  // of the exponent of a float over that of a half
  const auto normal = hn::Add(hn::ShiftLeft<13>(magnitude), hn::Set(d, kBias));
  const auto whole = hn::ConvertTo(Floats(), hn::BitCast(hn::RebindToSigned<Words>(), magnitude));
  const auto denormal = hn::BitCast(d, hn::Mul(whole, hn::Set(Floats(), 0x1p-24F)));
  const auto special = hn::Add(normal, hn::Set(d, kBias));
  const auto signed_special = hn::RebindToSigned<Words>();
  const auto at = hn::BitCast(signed_special, magnitude);
  const auto is_special = hn::RebindMask(d, hn::Gt(at, hn::Set(signed_special, 0x7BFF)));
  const auto is_denormal = hn::RebindMask(d, hn::Lt(at, hn::Set(signed_special, 0x400)));
  return hn::Or(hn::IfThenElse(is_denormal, denormal, hn::IfThenElse(is_special, special, normal)), sign);
}

/// The other way: nearest even; finite values beyond the largest half become it, NaNs keep the upper bits of their
/// payload.
HWY_INLINE WordVec float_to_half(WordVec bits) {
  const Words d;
  const hn::RebindToSigned<Words> di;
  const auto magnitude = hn::And(bits, hn::Set(d, 0x7FFFFFFFU));
  const auto sign = hn::ShiftRight<16>(hn::Sub(bits, magnitude));
  const auto at = hn::BitCast(di, magnitude);
  const auto finite = hn::BitCast(d, hn::Min(at, hn::Set(di, static_cast<int32_t>(kLargestHalf))));
  const auto to_even = hn::And(hn::ShiftRight<13>(finite), hn::Set(d, 1U));
  const auto rounded = hn::Add(hn::Add(finite, hn::Set(d, 0xFFFU - (112U << 23))), to_even);
  // Adding 1/2, whose last bit is 2^-24, rounds to a denormal half.
  const auto one_half = hn::Set(Floats(), 0.5F);
  const auto denormal =
      hn::Sub(hn::BitCast(d, hn::Add(hn::BitCast(Floats(), finite), one_half)), hn::BitCast(d, one_half));
  const auto payload = hn::And(hn::ShiftRight<13>(magnitude), hn::Set(d, 0x3FFU));
  const auto is_nan = hn::RebindMask(d, hn::Gt(at, hn::Set(di, static_cast<int32_t>(kInfinity))));
  const auto lost = hn::And(is_nan, hn::Eq(payload, hn::Zero(d)));
  const auto special = hn::Or(hn::Set(d, 0x7C00U), hn::IfThenElse(lost, hn::Set(d, 1U), payload));
  const auto is_denormal = hn::RebindMask(d, hn::Lt(at, hn::Set(di, static_cast<int32_t>(kSmallestNormalHalf))));
  const auto is_special = hn::RebindMask(d, hn::Gt(at, hn::Set(di, static_cast<int32_t>(kInfinity - 1))));
  auto half = hn::IfThenElse(is_denormal, denormal, hn::ShiftRight<13>(rounded));
  half = hn::IfThenElse(is_special, special, half);
  return hn::Or(half, sign);
}

HWY_INLINE NotNumbers count_not_numbers(WordVec bits, size_t lanes) {
  const hn::RebindToSigned<Words> d;
  const auto at = hn::BitCast(d, hn::And(bits, hn::Set(Words(), 0x7FFFFFFFU)));
  const auto bad = hn::Gt(at, hn::Set(d, static_cast<int32_t>(kInfinity - 1)));
  if (hn::AllFalse(d, bad)) return {};
  const auto inside = hn::FirstN(d, lanes);
  const auto nan = hn::And(inside, hn::Gt(at, hn::Set(d, static_cast<int32_t>(kInfinity))));
  const auto all = static_cast<int64_t>(hn::CountTrue(d, hn::And(inside, bad)));
  const auto nans = static_cast<int64_t>(hn::CountTrue(d, nan));
  return {nans, all - nans};
}

/// `convert` makes a vector of float bits from what is stored at an address; the rest of a row passes through a copy.
template <class Stored, class Convert>
NotNumbers to_floats(const char* stored, int count, float* pixels, const Convert& convert) {
  const Words d;
  const auto width = static_cast<int>(hn::Lanes(d));
  NotNumbers bad;
  int x = 0;
  for (; x + width <= count; x += width) {
    const auto bits = convert(stored + sizeof(Stored) * static_cast<size_t>(x));
    store(bits, d, reinterpret_cast<char*>(pixels + x));
    bad += count_not_numbers(bits, static_cast<size_t>(width));
  }
  if (x >= count) return bad;
  const auto rest = static_cast<size_t>(count - x);
  char copy[4 * HWY_LANES(uint32_t)] = {};
  char result[4 * HWY_LANES(uint32_t)];
  std::memcpy(copy, stored + sizeof(Stored) * static_cast<size_t>(x), sizeof(Stored) * rest);
  const auto bits = convert(copy);
  store(bits, d, result);
  std::memcpy(pixels + x, result, 4 * rest);
  return bad += count_not_numbers(bits, rest);
}

HWY_INLINE WordVec load_halves(const char* stored) { return hn::PromoteTo(Words(), load(Halves(), stored)); }
NotNumbers halves_to_floats(const char* stored, int count, float* pixels) {
  return to_floats<uint16_t>(stored, count, pixels, [](const char* at) { return half_to_float(load_halves(at)); });
}
NotNumbers singles_to_floats(const char* stored, int count, float* pixels) {
  return to_floats<uint32_t>(stored, count, pixels, [](const char* at) { return load(Words(), at); });
}

/// One vector; returns whether a bit has changed.
HWY_INLINE bool pack_halves(const float* pixels, char* stored) {
  const Words d;
  const hn::RebindToSigned<Words> di;
  const auto bits = hn::BitCast(d, hn::LoadU(Floats(), pixels));
  const auto before = load_halves(stored);
  const auto same = hn::Eq(bits, half_to_float(before));
  if (hn::AllTrue(d, same)) return false;
  const auto now = hn::IfThenElse(same, before, float_to_half(bits));
  store(hn::DemoteTo(Halves(), hn::BitCast(di, now)), Halves(), stored);
  return !hn::AllTrue(d, hn::Eq(before, now));
}

bool pack_half_row(const float* pixels, int count, char* stored) {
  const auto width = static_cast<int>(hn::Lanes(Words()));
  bool changed = false;
  int x = 0;
  for (; x + width <= count; x += width) changed |= pack_halves(pixels + x, stored + 2 * x);
  if (x >= count) return changed;
  const auto rest = static_cast<size_t>(count - x);
  float values[HWY_LANES(float)] = {};
  char halves[2 * HWY_LANES(float)] = {};
  std::memcpy(values, pixels + x, 4 * rest);
  std::memcpy(halves, stored + 2 * x, 2 * rest);
  changed |= pack_halves(values, halves);
  std::memcpy(stored + 2 * x, halves, 2 * rest);
  return changed;
}

}  // namespace aftershade::io::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::io {

HWY_EXPORT(join_halves);
HWY_EXPORT(split_differences);
HWY_EXPORT(halves_to_floats);
HWY_EXPORT(singles_to_floats);
HWY_EXPORT(pack_half_row);

void join_halves(const uint8_t* coded, size_t size, uint8_t* pixels) {
  HWY_DYNAMIC_DISPATCH(join_halves)(coded, size, pixels);
}

void HalfSplitter::add(const uint8_t* row, size_t size) {
  if (size == 0) return;
  *low_ = static_cast<uint8_t>(row[0] - last_low_ + 128);
  *high_ = static_cast<uint8_t>(row[1] - last_high_ + 128);
  HWY_DYNAMIC_DISPATCH(split_differences)(row, size / 2, low_, high_);
  low_ += size / 2;
  high_ += size / 2;
  last_low_ = row[size - 2];
  last_high_ = row[size - 1];
}
void HalfSplitter::finish() { *second_half_ = static_cast<uint8_t>(*second_half_ - last_low_); }

namespace {
float from_uint(uint32_t bits) { return static_cast<float>(bits); }
uint32_t to_uint(float value) {
  if (!(value > 0)) return 0;  // also NaN
  constexpr float kPastLargest = 4294967296.0F;
  return value >= kPastLargest ? 0xFFFFFFFFU : static_cast<uint32_t>(std::nearbyint(value));
}

bool pack_uint_row(const float* pixels, int count, char* stored) {
  bool changed = false;
  for (int x = 0; x < count; ++x) {
    uint32_t before;
    std::memcpy(&before, stored + 4 * x, sizeof before);
    if (std::bit_cast<uint32_t>(from_uint(before)) == std::bit_cast<uint32_t>(pixels[x])) continue;
    const uint32_t now = to_uint(pixels[x]);
    std::memcpy(stored + 4 * x, &now, sizeof now);
    changed |= now != before;
  }
  return changed;
}

bool pack_single_row(const float* pixels, int count, char* stored) {
  const size_t bytes = sizeof(float) * static_cast<size_t>(count);
  const bool changed = std::memcmp(stored, pixels, bytes) != 0;
  if (changed) std::memcpy(stored, pixels, bytes);
  return changed;
}
}  // namespace

NotNumbers to_floats(PixelType type, const char* stored, int count, float* pixels) {
  switch (type) {
    case PixelType::half:
      return HWY_DYNAMIC_DISPATCH(halves_to_floats)(stored, count, pixels);
    case PixelType::single:
      return HWY_DYNAMIC_DISPATCH(singles_to_floats)(stored, count, pixels);
    case PixelType::uint:
      for (int x = 0; x < count; ++x) {
        uint32_t bits;
        std::memcpy(&bits, stored + 4 * x, sizeof bits);
        pixels[x] = from_uint(bits);
      }
  }
  return {};
}

bool pack_row(PixelType type, const float* pixels, int count, char* stored) {
  switch (type) {
    case PixelType::half:
      return HWY_DYNAMIC_DISPATCH(pack_half_row)(pixels, count, stored);
    case PixelType::single:
      return pack_single_row(pixels, count, stored);
    case PixelType::uint:
      return pack_uint_row(pixels, count, stored);
  }
  return false;
}

}  // namespace aftershade::io
#endif
