// Functions of pixel code that libm must not provide (its results differ between machines): short polynomials in plain
// multiplies and adds, with domain and largest error stated; tests/simd measures them.
#if defined(AFTERSHADE_CORE_SIMD_MATH_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_SIMD_MATH_H
#undef AFTERSHADE_CORE_SIMD_MATH_H
#else
#define AFTERSHADE_CORE_SIMD_MATH_H
#endif
#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::lanes::HWY_NAMESPACE {

/// Nearest integer, ties to even, for |x| < 2^22: adding 1.5 * 2^23 leaves no bits for a fraction.
inline Float round_small(Float x) { return (x + 12582912.0F) - 12582912.0F; }

/// 2^x for x in [-126, 126]; below -126 the result is 0. Relative error below 2.5e-7.
/// x = n + f, f in [-0.5, 0.5]; 2^f by the Taylor series of exp(f ln 2) to the sixth power.
inline Float exp2(Float x) {
  const Float clamped = clamp(x, -126.0F, 126.0F);
  const Float n = kLanes > 1 ? round(clamped) : round_small(clamped);  // but for the sign of 0 the same
  const Float f = clamped - n;
  Float p = 1.5403530e-4F;    // (ln 2)^6 / 6!
  p = p * f + 1.3333558e-3F;  // (ln 2)^5 / 5!
  p = p * f + 9.6181291e-3F;  // (ln 2)^4 / 4!
  p = p * f + 5.5504109e-2F;  // (ln 2)^3 / 3!
  p = p * f + 2.4022651e-1F;  // (ln 2)^2 / 2!
  p = p * f + 6.9314718e-1F;  // ln 2
  p = p * f + 1.0F;
  return select(x < -126.0F, Float(0.0F), times_power_of_two(p, n));
}

/// sin(2 pi t) and cos(2 pi t), t in turns, |t| < 2^22. Absolute error below 4e-7.
/// Reduced to a quarter turn around 0; Taylor series to the ninth and tenth power.
struct SinCos {
  Float sin, cos;
};
inline SinCos sincos_turns(Float t) {
  const Float quarter = round(t * 4.0F);
  const Float a = (t - quarter * 0.25F) * 6.2831853F;  // |a| <= pi/4
  const Float a2 = a * a;
  Float s = 2.7557319e-6F;
  s = s * a2 - 1.9841270e-4F;
  s = s * a2 + 8.3333333e-3F;
  s = s * a2 - 1.6666667e-1F;
  s = a + a * (a2 * s);
  Float c = -2.7557319e-7F;
  c = c * a2 + 2.4801587e-5F;
  c = c * a2 - 1.3888889e-3F;
  c = c * a2 + 4.1666667e-2F;
  c = c * a2 - 0.5F;
  c = 1.0F + a2 * c;
  const Int q = to_int(quarter) & Int(3);
  const Mask swap = (q & Int(1)) == Int(1);
  const Float sine = select(swap, c, s), cosine = select(swap, s, c);
  const Mask negative_sin = q >= Int(2);
  const Mask negative_cos = (q == Int(1)) | (q == Int(2));
  return {select(negative_sin, -sine, sine), select(negative_cos, -cosine, cosine)};
}

/// floor(log2(x)) for finite x >= 2^-126: the exponent of the float.
inline Int floor_log2(Float x) { return ((bits_of(x) >> 23) & Int(255)) - Int(127); }

/// log2(x) for x in [2^-126, 2^126], exact for powers of two; below, 0 included, it is -126. Absolute error below 2e-7
/// for x in [1/2, 2], relative error below 2e-7 beyond.
/// x = 2^n m, m in [sqrt(1/2), sqrt(2)); ln m = 2 atanh(s), s = (m - 1) / (m + 1), by its series to the eleventh power.
inline Float log2(Float x) {
  const Float normal = max(x, 1.17549435e-38F);
  const Int n = floor_log2(normal * 1.41421356F);
  const Float m = normal * float_of_bits((Int(127) - n) << 23);
  const Float s = (m - 1.0F) / (m + 1.0F), s2 = s * s;
  Float p = 2.6230815e-1F;     // 2 / (11 ln 2)
  p = p * s2 + 3.2059886e-1F;  // 2 / (9 ln 2)
  p = p * s2 + 4.1219858e-1F;  // 2 / (7 ln 2)
  p = p * s2 + 5.7707802e-1F;  // 2 / (5 ln 2)
  p = p * s2 + 9.6179669e-1F;  // 2 / (3 ln 2)
  p = p * s2 + 2.8853901F;     // 2 / ln 2
  return to_float(n) + s * p;
}

}  // namespace aftershade::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
