#pragma once
#include <hwy/highway.h>
#if HWY_ARCH_X86
#include <emmintrin.h>
#endif

#include <cmath>
#include <cstdint>
#include <cstring>

/// One lane a variable: the definition of every operation. Included by core/simd/lanes.h.
namespace aftershade::lanes::N_SCALAR {

inline constexpr int kLanes = 1;

struct Mask {
  bool v;
};
struct Int {
  int32_t v;
  Int() = default;
  constexpr Int(int32_t value) : v(value) {}
};
struct Float {
  float v;
  Float() = default;
  constexpr Float(float value) : v(value) {}
};

inline Mask operator&(Mask a, Mask b) { return {a.v && b.v}; }
inline Mask operator|(Mask a, Mask b) { return {a.v || b.v}; }
inline Mask operator!(Mask a) { return {!a.v}; }
inline bool any(Mask m) { return m.v; }
inline bool all(Mask m) { return m.v; }

inline Float operator+(Float a, Float b) { return a.v + b.v; }
inline Float operator-(Float a, Float b) { return a.v - b.v; }
inline Float operator*(Float a, Float b) { return a.v * b.v; }
inline Float operator/(Float a, Float b) { return a.v / b.v; }
inline Float operator-(Float a) { return -a.v; }
inline Mask operator<(Float a, Float b) { return {a.v < b.v}; }
inline Mask operator<=(Float a, Float b) { return {a.v <= b.v}; }
inline Mask operator>(Float a, Float b) { return {a.v > b.v}; }
inline Mask operator>=(Float a, Float b) { return {a.v >= b.v}; }
inline Mask operator==(Float a, Float b) { return {a.v == b.v}; }

inline Int operator+(Int a, Int b) { return a.v + b.v; }
inline Int operator-(Int a, Int b) { return a.v - b.v; }
inline Int operator*(Int a, Int b) { return a.v * b.v; }
inline Int operator&(Int a, Int b) { return a.v & b.v; }
inline Int operator|(Int a, Int b) { return a.v | b.v; }
inline Int operator^(Int a, Int b) { return a.v ^ b.v; }
inline Int operator<<(Int a, int bits) { return static_cast<int32_t>(static_cast<uint32_t>(a.v) << bits); }
inline Int operator>>(Int a, int bits) { return a.v >> bits; }  ///< arithmetic
inline Int operator>>(Int a, Int bits) { return a.v >> bits.v; }
inline Mask operator<(Int a, Int b) { return {a.v < b.v}; }
inline Mask operator>=(Int a, Int b) { return {a.v >= b.v}; }
inline Mask operator==(Int a, Int b) { return {a.v == b.v}; }

inline Float select(Mask m, Float yes, Float no) { return m.v ? yes : no; }
inline Int select(Mask m, Int yes, Int no) { return m.v ? yes : no; }
/// b when a is NaN, as SSE does: min(a, b) = a < b ? a : b.
inline Float min(Float a, Float b) { return a.v < b.v ? a : b; }
inline Float max(Float a, Float b) { return a.v > b.v ? a : b; }
inline Int min(Int a, Int b) { return a.v < b.v ? a : b; }
inline Int max(Int a, Int b) { return a.v > b.v ? a : b; }
inline Float abs(Float x) { return std::fabs(x.v); }
inline Float sqrt(Float x) { return std::sqrt(x.v); }
inline Float floor(Float x) { return std::floor(x.v); }
/// Nearest integer, ties to even.
inline Float round(Float x) { return std::nearbyintf(x.v); }
/// Toward zero; the least Int for NaN and |x| >= 2^31, as SSE has it.
inline Int to_int(Float x) {
#if HWY_ARCH_X86
  return _mm_cvttss_si32(_mm_set_ss(x.v));
#else
  return std::fabs(x.v) < 2147483648.0F ? static_cast<int32_t>(x.v) : INT32_MIN;
#endif
}
inline Float to_float(Int x) { return static_cast<float>(x.v); }
/// The same 32 bits, read as the other type.
inline Int bits_of(Float x) {
  Int out;
  std::memcpy(&out.v, &x.v, sizeof out.v);
  return out;
}
inline Float float_of_bits(Int x) {
  Float out;
  std::memcpy(&out.v, &x.v, sizeof out.v);
  return out;
}

/// x 2^n, n a whole number in [-126, 127].
inline Float times_power_of_two(Float x, Float n) { return x * float_of_bits((to_int(n) + Int(127)) << 23); }

/// first, first + 1, ... one a lane.
inline Int iota(int first) { return first; }
inline Float load(const float* p) { return *p; }
inline void store(float* p, Float value) { *p = value.v; }
/// base[index], lane by lane; every index must be inside the array.
inline Float gather(const float* base, Int index) { return base[index.v]; }
/// table[index] of 16 values, of which only the first 8 may be asked for.
inline Int look_up(const int32_t* table, Int index) { return table[index.v]; }

/// p[0], p[2], ... and p[1], p[3], ...
struct Pairs {
  Float even, odd;
};
inline Pairs load_pairs(const float* p) { return {p[0], p[1]}; }
inline void store_pairs(float* p, Float even, Float odd) {
  p[0] = even.v;
  p[1] = odd.v;
}

}  // namespace aftershade::lanes::N_SCALAR
