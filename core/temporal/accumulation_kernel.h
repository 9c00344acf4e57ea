#if defined(AFTERSHADE_CORE_TEMPORAL_ACCUMULATION_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_TEMPORAL_ACCUMULATION_KERNEL_H
#undef AFTERSHADE_CORE_TEMPORAL_ACCUMULATION_KERNEL_H
#else
#define AFTERSHADE_CORE_TEMPORAL_ACCUMULATION_KERNEL_H
#endif
#include "core/temporal/temporal_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

struct LookUpRow {
  HistoryView before;
  ConstPlaneView next;  ///< may be empty
  const float *x, *y, *compared;
  int width;
  float epsilon;
  float *out_ao, *out_weight, *out_next;
};

/// `next` is a whole number: that of the nearest pixel.
inline Float nearest_value(ConstPlaneView plane, const HistoryView& h, Float x, Float y) {
  const auto columns = static_cast<float>(plane.width), rows = static_cast<float>(plane.height);
  const Float column = clamp(floor(x) - static_cast<float>(h.min_x), 0.0F, columns - 1.0F);
  const Float row = clamp(floor(y) - static_cast<float>(h.min_y), 0.0F, rows - 1.0F);
  return gather(plane.data, to_int(row) * Int(static_cast<int32_t>(plane.stride)) + to_int(column));
}

inline void look_up_row(const LookUpRow& row) {
  for (int i = 0; i < row.width; i += kLanes) {
    const Float x = load(row.x + i), y = load(row.y + i);
    const FetchedHistory found = fetch_history(row.before, x, y, load(row.compared + i), row.epsilon);
    store(row.out_ao + i, select(found.known, found.ao, 1.0F));
    store(row.out_weight + i, select(found.known, found.count, 0.0F));
    const Float next = row.next.empty() ? Float(0.0F) : nearest_value(row.next, row.before, x, y);
    store(row.out_next + i, select(found.known, next, 0.0F));
  }
}

struct AccumulateRow {
  const float *old_ao, *old_weight;
  const float *ao, *weight, *depth;
  int width;
  float max_weight;
  float *out_ao, *out_weight, *out_depth;
};

/// The mean is taken of the difference from this frame, so that a constant stays the same to the bit, and a miss too.
inline void accumulate_row(const AccumulateRow& row) {
  for (int i = 0; i < row.width; i += kLanes) {
    const Float given = load(row.ao + i), k = load(row.weight + i), n = load(row.old_weight + i);
    const Float ao = select(is_finite(given), given, 1.0F), z = load(row.depth + i);
    const Float kept = n / (n + k);  // 29/30 of seed 003 at its cap
    store(row.out_ao + i, ao + (load(row.old_ao + i) - ao) * kept);
    store(row.out_weight + i, min(n + k, row.max_weight));
    store(row.out_depth + i, select(is_finite(z) & (z > 0.0F), z, 0.0F));
  }
}

inline Float fraction(Float x) { return x - floor(x); }

/// What an 8-bit channel makes of a value.
inline Float stored_in_8_bits(Float x) { return floor(sat(x) * 255.0F + 0.5F) / 255.0F; }

/// Seed 003's packFloatToVec3i and unpackFloatFromVec3i with 8-bit channels between them; `value` in [0, 1). The second
/// and third digit lose what the finer one holds, each a 256th of the finer as it was before.
inline Float through_24_bits(Float value) {
  const Float fine = fraction(value * 65536.0F), middle = fraction(value * 256.0F), coarse = fraction(value);
  return stored_in_8_bits(fine) / 65536.0F + stored_in_8_bits(middle - fine / 256.0F) / 256.0F +
         stored_in_8_bits(coarse - middle / 256.0F);
}

struct PackRow {
  float *ao, *depth;
  int width;
  float range_m;
};
inline void pack_row(const PackRow& row) {
  constexpr float kLargest = 16777215.0F / 16777216.0F;  // in three digits
  for (int i = 0; i < row.width; i += kLanes) {
    const Float share = min(load(row.depth + i) / row.range_m, kLargest);
    store(row.depth + i, through_24_bits(share) * row.range_m);
    store(row.ao + i, stored_in_8_bits(load(row.ao + i)));
  }
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
