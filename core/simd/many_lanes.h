// The operations of core/simd/one_lane.h, which defines them, on as many lanes as the target has, at most 16. Included
// by core/simd/lanes.h, whose include guard holds for this file too.
HWY_BEFORE_NAMESPACE();
namespace aftershade::lanes::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<FloatTag>;

inline constexpr int kLanes = static_cast<int>(hn::MaxLanes(FloatTag()));

struct Mask {
  hn::Mask<FloatTag> v;
};
struct Int {
  hn::Vec<IntTag> v;
  Int() = default;
  HWY_INLINE Int(hn::Vec<IntTag> lanes) : v(lanes) {}
  HWY_INLINE Int(int32_t value) : v(hn::Set(IntTag(), value)) {}
};
struct Float {
  hn::Vec<FloatTag> v;
  Float() = default;
  HWY_INLINE Float(hn::Vec<FloatTag> lanes) : v(lanes) {}
  HWY_INLINE Float(float value) : v(hn::Set(FloatTag(), value)) {}
};

HWY_INLINE Mask operator&(Mask a, Mask b) { return {hn::And(a.v, b.v)}; }
HWY_INLINE Mask operator|(Mask a, Mask b) { return {hn::Or(a.v, b.v)}; }
HWY_INLINE Mask operator!(Mask a) { return {hn::Not(a.v)}; }
HWY_INLINE bool any(Mask m) { return !hn::AllFalse(FloatTag(), m.v); }
HWY_INLINE bool all(Mask m) { return hn::AllTrue(FloatTag(), m.v); }

HWY_INLINE Float operator+(Float a, Float b) { return hn::Add(a.v, b.v); }
HWY_INLINE Float operator-(Float a, Float b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Float operator*(Float a, Float b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Float operator/(Float a, Float b) { return hn::Div(a.v, b.v); }
HWY_INLINE Float operator-(Float a) { return hn::Neg(a.v); }
HWY_INLINE Mask operator<(Float a, Float b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE Mask operator<=(Float a, Float b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE Mask operator>(Float a, Float b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE Mask operator>=(Float a, Float b) { return {hn::Ge(a.v, b.v)}; }
HWY_INLINE Mask operator==(Float a, Float b) { return {hn::Eq(a.v, b.v)}; }

HWY_INLINE Int operator+(Int a, Int b) { return hn::Add(a.v, b.v); }
HWY_INLINE Int operator-(Int a, Int b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Int operator*(Int a, Int b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Int operator&(Int a, Int b) { return hn::And(a.v, b.v); }
HWY_INLINE Int operator|(Int a, Int b) { return hn::Or(a.v, b.v); }
HWY_INLINE Int operator^(Int a, Int b) { return hn::Xor(a.v, b.v); }
HWY_INLINE Int operator<<(Int a, int bits) { return hn::ShiftLeftSame(a.v, bits); }
HWY_INLINE Int operator>>(Int a, int bits) { return hn::ShiftRightSame(a.v, bits); }
HWY_INLINE Int operator>>(Int a, Int bits) { return a.v >> bits.v; }
HWY_INLINE Mask operator<(Int a, Int b) { return {hn::RebindMask(FloatTag(), hn::Lt(a.v, b.v))}; }
HWY_INLINE Mask operator>=(Int a, Int b) { return !(a < b); }
HWY_INLINE Mask operator==(Int a, Int b) { return {hn::RebindMask(FloatTag(), hn::Eq(a.v, b.v))}; }

HWY_INLINE Float select(Mask m, Float yes, Float no) { return hn::IfThenElse(m.v, yes.v, no.v); }
HWY_INLINE Int select(Mask m, Int yes, Int no) { return hn::IfThenElse(hn::RebindMask(IntTag(), m.v), yes.v, no.v); }
#if HWY_ARCH_X86  // MINPS and MAXPS choose the second when they cannot tell
HWY_INLINE Float min(Float a, Float b) { return hn::Min(a.v, b.v); }
HWY_INLINE Float max(Float a, Float b) { return hn::Max(a.v, b.v); }
#else
HWY_INLINE Float min(Float a, Float b) { return select(a < b, a, b); }
HWY_INLINE Float max(Float a, Float b) { return select(a > b, a, b); }
#endif
HWY_INLINE Int min(Int a, Int b) { return hn::Min(a.v, b.v); }
HWY_INLINE Int max(Int a, Int b) { return hn::Max(a.v, b.v); }
HWY_INLINE Float abs(Float x) { return hn::Abs(x.v); }
HWY_INLINE Float sqrt(Float x) { return hn::Sqrt(x.v); }
HWY_INLINE Float floor(Float x) { return hn::Floor(x.v); }
HWY_INLINE Float round(Float x) { return hn::Round(x.v); }
// Highway's own conversion saturates, for five instructions more.
HWY_INLINE Int to_int(Float x) {
#if HWY_TARGET == HWY_AVX3
  return hn::Vec<IntTag>{_mm512_cvttps_epi32(x.v.raw)};
#elif HWY_TARGET == HWY_AVX2
  return hn::Vec<IntTag>{_mm256_cvttps_epi32(x.v.raw)};
#elif HWY_TARGET == HWY_SSE4
  return hn::Vec<IntTag>{_mm_cvttps_epi32(x.v.raw)};
#else
  return select(abs(x) < 2147483648.0F, Int(hn::ConvertTo(IntTag(), x.v)), Int(INT32_MIN));
#endif
}
HWY_INLINE Float to_float(Int x) { return hn::ConvertTo(FloatTag(), x.v); }
HWY_INLINE Float times_power_of_two(Float x, Float n) {
#if HWY_TARGET == HWY_AVX3
  return hn::Vec<FloatTag>{_mm512_scalef_ps(x.v.raw, n.v.raw)};
#else
  return x * Float(hn::BitCast(FloatTag(), hn::ShiftLeft<23>(hn::Add(to_int(n).v, hn::Set(IntTag(), 127)))));
#endif
}
HWY_INLINE Int bits_of(Float x) { return hn::BitCast(IntTag(), x.v); }
HWY_INLINE Float float_of_bits(Int x) { return hn::BitCast(FloatTag(), x.v); }

// Highway's own Iota writes its lanes one by one and waits until they can be read as one.
alignas(64) inline constexpr int32_t kFirst[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
HWY_INLINE Int iota(int first) { return hn::Add(hn::Set(IntTag(), first), hn::Load(IntTag(), kFirst)); }
HWY_INLINE Float load(const float* p) { return hn::LoadU(FloatTag(), p); }
HWY_INLINE void store(float* p, Float value) { hn::StoreU(value.v, FloatTag(), p); }
HWY_INLINE Float gather(const float* base, Int index) { return hn::GatherIndex(FloatTag(), base, index.v); }
HWY_INLINE Int look_up(const int32_t* table, Int index) {
  if constexpr (kLanes < 8)
    return hn::GatherIndex(IntTag(), table, index.v);
  else
    return hn::TableLookupLanes(hn::LoadU(IntTag(), table), hn::IndicesFromVec(IntTag(), index.v));
}

struct Pairs {
  Float even, odd;
};
HWY_INLINE Pairs load_pairs(const float* p) {
  Pairs out;
  hn::LoadInterleaved2(FloatTag(), p, out.even.v, out.odd.v);
  return out;
}
HWY_INLINE void store_pairs(float* p, Float even, Float odd) { hn::StoreInterleaved2(even.v, odd.v, FloatTag(), p); }

}  // namespace aftershade::lanes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
