// Records of floats that lie side by side in memory, read one a lane: cheaper than a gather for each of their values,
// since a record is one load and the rest is shuffling.
#if defined(AFTERSHADE_CORE_SIMD_RECORDS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_SIMD_RECORDS_H
#undef AFTERSHADE_CORE_SIMD_RECORDS_H
#else
#define AFTERSHADE_CORE_SIMD_RECORDS_H
#endif
#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::lanes::HWY_NAMESPACE {

/// Four values a lane.
struct Quad {
  Float a, b, c, d;
};
struct TwoQuads {
  Quad first, second;
};

#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4
namespace detail {

/// Of four vectors, the 4 x 4 matrix in each 128 bits transposed.
HWY_INLINE Quad transposed(Float r0, Float r1, Float r2, Float r3) {
  const FloatTag f;
  const hn::RepartitionToWide<FloatTag> pair;
  const auto wide = [&](auto v) { return hn::BitCast(pair, v); };
  const auto low01 = wide(hn::InterleaveLower(f, r0.v, r1.v)), low23 = wide(hn::InterleaveLower(f, r2.v, r3.v));
  const auto high01 = wide(hn::InterleaveUpper(f, r0.v, r1.v)), high23 = wide(hn::InterleaveUpper(f, r2.v, r3.v));
  return {Float(hn::BitCast(f, hn::InterleaveLower(pair, low01, low23))),
          Float(hn::BitCast(f, hn::InterleaveUpper(pair, low01, low23))),
          Float(hn::BitCast(f, hn::InterleaveLower(pair, high01, high23))),
          Float(hn::BitCast(f, hn::InterleaveUpper(pair, high01, high23)))};
}

/// Four floats from each of kLanes / 4 places, `at` being the indices of every fourth lane.
HWY_INLINE Float load_blocks(const float* base, const int32_t* at) {
#if HWY_TARGET == HWY_AVX3
  __m512 v = _mm512_castps128_ps512(_mm_loadu_ps(base + at[0]));
  v = _mm512_insertf32x4(v, _mm_loadu_ps(base + at[4]), 1);
  v = _mm512_insertf32x4(v, _mm_loadu_ps(base + at[8]), 2);
  return hn::Vec<FloatTag>{_mm512_insertf32x4(v, _mm_loadu_ps(base + at[12]), 3)};
#elif HWY_TARGET == HWY_AVX2
  const __m256 v = _mm256_castps128_ps256(_mm_loadu_ps(base + at[0]));
  return hn::Vec<FloatTag>{_mm256_insertf128_ps(v, _mm_loadu_ps(base + at[4]), 1)};
#else
  return hn::Vec<FloatTag>{_mm_loadu_ps(base + at[0])};
#endif
}

/// The reverse: to base, base + 4 stride, ...
HWY_INLINE void store_blocks(float* base, int stride, Float v) {
#if HWY_TARGET == HWY_AVX3
  _mm_storeu_ps(base, _mm512_castps512_ps128(v.v.raw));
  _mm_storeu_ps(base + 4 * stride, _mm512_extractf32x4_ps(v.v.raw, 1));
  _mm_storeu_ps(base + 8 * stride, _mm512_extractf32x4_ps(v.v.raw, 2));
  _mm_storeu_ps(base + 12 * stride, _mm512_extractf32x4_ps(v.v.raw, 3));
#elif HWY_TARGET == HWY_AVX2
  _mm_storeu_ps(base, _mm256_castps256_ps128(v.v.raw));
  _mm_storeu_ps(base + 4 * stride, _mm256_extractf128_ps(v.v.raw, 1));
#else
  _mm_storeu_ps(base, v.v.raw);
#endif
}

}  // namespace detail

namespace detail {
HWY_INLINE Quad load_at(const float* base, const int32_t* at) {
  return transposed(load_blocks(base, at), load_blocks(base, at + 1), load_blocks(base, at + 2),
                    load_blocks(base, at + 3));
}
}  // namespace detail

/// base[index] to base[index + 3], lane by lane.
HWY_INLINE Quad load_records(const float* base, Int index) {
  alignas(64) int32_t at[kLanes];
  hn::Store(index.v, IntTag(), at);
  return detail::load_at(base, at);
}
/// base[index] to base[index + 7].
HWY_INLINE TwoQuads load_long_records(const float* base, Int index) {
  alignas(64) int32_t at[kLanes];
  hn::Store(index.v, IntTag(), at);
  return {detail::load_at(base, at), detail::load_at(base + 4, at)};
}

/// The first lane to base[0] to base[3], the second from base[stride] on, and so on; `stride` >= 4.
HWY_INLINE void store_records(float* base, int stride, Quad q) {
  const Quad r = detail::transposed(q.a, q.b, q.c, q.d);
  detail::store_blocks(base, stride, r.a);
  detail::store_blocks(base + stride, stride, r.b);
  detail::store_blocks(base + 2 * stride, stride, r.c);
  detail::store_blocks(base + 3 * stride, stride, r.d);
}
#else
inline Quad load_records(const float* base, Int index) {
  return {gather(base, index), gather(base + 1, index), gather(base + 2, index), gather(base + 3, index)};
}

inline TwoQuads load_long_records(const float* base, Int index) {
  return {load_records(base, index), load_records(base + 4, index)};
}

inline void store_records(float* base, int stride, Quad q) {
  float values[4][kLanes];
  store(values[0], q.a);
  store(values[1], q.b);
  store(values[2], q.c);
  store(values[3], q.d);
  for (int i = 0; i < kLanes; ++i)
    for (int part = 0; part < 4; ++part) base[i * stride + part] = values[part][i];
}
#endif

}  // namespace aftershade::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
