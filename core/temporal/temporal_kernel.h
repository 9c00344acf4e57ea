#if defined(AFTERSHADE_CORE_TEMPORAL_TEMPORAL_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_TEMPORAL_TEMPORAL_KERNEL_H
#undef AFTERSHADE_CORE_TEMPORAL_TEMPORAL_KERNEL_H
#else
#define AFTERSHADE_CORE_TEMPORAL_TEMPORAL_KERNEL_H
#endif
#include "core/filter/lane_geometry.h"
#include "core/simd/math.h"
#include "core/simd/records.h"
#include "core/temporal/history_view.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

/// The mask at a row's pixels: 1 keeps this frame's AO. Each texel stands for 1 << shift pixels, the first of which
/// lies at first_x; null: nothing is stable.
struct StableRow {
  const float* texels;
  int shift, first_x;
};

struct TemporalRow {
  const float *ao, *depth;  ///< of frame i
  StableRow stable;
  HistoryView before;
  int width;
  float epsilon, max_frames;
  bool literal;  ///< the seed's listing as printed
  float *out_ao, *history_ao, *out_depth, *out_count;
};

struct FetchedHistory {
  Float ao, count;
  Mask known;
};

/// floor(x) for |x| < 2^22; beyond, x within a pixel.
inline Float floor_of_position(Float x) {
  const Float nearest = round_small(x);
  return select(nearest > x, nearest - 1.0F, nearest);
}

/// Seed 000, "Disocclusion Test": |1 - w_i / w_{i-1}| < epsilon, with w_{i-1} = z, what was stored (algorithms 14, item
/// 4). No history is z = 0 (borderZ), which is never the same.
inline Mask same_surface(Float expected, Float z, float epsilon) { return abs(z - expected) < epsilon * z; }

/// The two pixels along one axis between which a position lies: their indices, clamped to the planes, and their
/// bilinear shares, which do not depend on the planes' place.
struct TapPair {
  Int index[2];
  Float share[2];
  Mask inside[2];
};
inline TapPair tap_pair(Float position, int first, int size) {
  const Float u = position - 0.5F, left = floor_of_position(u), share = u - left;
  const auto last = static_cast<float>(size - 1);
  const Float at = clamp(left - static_cast<float>(first), -2.0F, last + 1.0F);  // NaN becomes -2: outside
  return {{to_int(clamp(at, 0.0F, last)), to_int(clamp(at + 1.0F, 0.0F, last))},
          {1.0F - share, share},
          {(at >= 0.0F) & (at <= last), (at >= -1.0F) & (at < last)}};
}

/// A plane's values at both columns of a pair, in one row of the plane each lane: they lie side by side, but at borders
/// one stands for both.
struct ColumnPair {
  ColumnPair(const TapPair& columns, int width)
      : left(min(columns.index[0], Int(width > 1 ? width - 2 : 0))),
        first(columns.index[0] == left),
        second(columns.index[1] == left) {}
  Int left;
  Mask first, second;  ///< is it the left one?
  struct Values {
    Float v[2];
  };
  Values operator()(const float* plane, Int row) const {
    const Quad four = load_records(plane, row + left);
    return {{select(first, four.a, four.b), select(second, four.a, four.b)}};
  }
};

/// Four bilinear taps, each validated on its own, weights renormalised; unknown when the valid taps weigh less than a
/// quarter (algorithms 7.3). N is averaged like AO: it is the weight that the fetched mean deserves.
inline FetchedHistory fetch_history(const HistoryView& h, Float x, Float y, Float expected, float epsilon) {
  const TapPair columns = tap_pair(x, h.min_x, h.depth.width), rows = tap_pair(y, h.min_y, h.depth.height);
  const Float column_share[] = {select(columns.inside[0], columns.share[0], 0.0F),
                                select(columns.inside[1], columns.share[1], 0.0F)};
  const ColumnPair pair(columns, h.depth.width);
  Float sum = 0.0F, ao = 0.0F, count = 0.0F;
  for (int j = 0; j < 2; ++j) {
    const Float row_share = select(rows.inside[j], rows.share[j], 0.0F);
    const Int row = rows.index[j] * Int(static_cast<int32_t>(h.depth.stride));
    const ColumnPair::Values z = pair(h.depth.data, row), old = pair(h.ao.data, row), n = pair(h.count.data, row);
    for (int i = 0; i < 2; ++i) {
      const Float valid = select(same_surface(expected, z.v[i], epsilon), column_share[i] * row_share, 0.0F);
      sum += valid;
      ao += valid * old.v[i];
      count += valid * n.v[i];
    }
  }
  return {ao / sum, count / sum, sum >= 0.25F};
}

/// The listing as printed: z_{i-1} (and N, of which it says nothing) of the nearest pixel, 0 outside; AO bilinear, of
/// whatever surface its four taps show.
inline FetchedHistory fetch_literally(const HistoryView& h, Float x, Float y, Float expected, float epsilon) {
  const Int stride = static_cast<int32_t>(h.depth.stride);
  const TapPair at_x = tap_pair(x + 0.5F, h.min_x, h.depth.width), at_y = tap_pair(y + 0.5F, h.min_y, h.depth.height);
  const Int nearest = at_y.index[0] * stride + at_x.index[0];
  const TapPair columns = tap_pair(x, h.min_x, h.depth.width), rows = tap_pair(y, h.min_y, h.depth.height);
  Float ao = 0.0F;
  for (int tap = 0; tap < 4; ++tap) {
    const int i = tap & 1, j = tap >> 1;
    ao += columns.share[i] * rows.share[j] * gather(h.ao.data, rows.index[j] * stride + columns.index[i]);
  }
  const Mask same = same_surface(expected, gather(h.depth.data, nearest), epsilon);
  return {ao, gather(h.count.data, nearest), at_x.inside[0] & at_y.inside[0] & same};
}

inline Mask is_stable(const StableRow& stable, int x) {
  if (stable.texels == nullptr) return Float(0.0F) > 0.0F;
  const Int texel = (iota(x) - Int(stable.first_x)) >> stable.shift;
  return (stable.shift == 0 ? load(stable.texels + x - stable.first_x) : gather(stable.texels, texel)) >= 0.5F;
}

/// SelectiveTemporalFilter (seed 000's listing; algorithms 14, items 1 to 4: what is stored is z_i, and N is capped as
/// stored, so that the new frame weighs at least 1 / (N_max + 1)). Literally, what is stored is w_i, where there is
/// one. AO that is no number counts as 1. `past(x)`: absolute position and planar depth w_i of pixels x, x + 1, ... in
/// frame i-1, NaN: unknown.
template <class Past>
inline void temporal_row(const TemporalRow& row, const Past& past) {
  for (int x = 0; x < row.width; x += kLanes) {
    const Float given = load(row.ao + x), z = load(row.depth + x);
    Float ao = select(is_finite(given), given, 1.0F), count = 1.0F, w = z;
    const Mask stable = is_stable(row.stable, x);
    if (row.literal || !all(stable)) {
      const Point at = past(x);
      const FetchedHistory before = row.literal ? fetch_literally(row.before, at.x, at.y, at.z, row.epsilon)
                                                : fetch_history(row.before, at.x, at.y, at.z, row.epsilon);
      const Mask blend = before.known & !stable;
      ao = select(blend, (before.count * before.ao + ao) / (before.count + 1.0F), ao);
      count = select(blend, min(before.count + 1.0F, row.max_frames), 1.0F);
      if (row.literal) w = at.z;
    }
    store(row.out_ao + x, ao);
    store(row.history_ao + x, ao);
    store(row.out_count + x, count);
    const Float stored = select(is_finite(w) & (w > 0.0F), w, z);
    store(row.out_depth + x, select(is_finite(z) & (z > 0.0F), stored, 0.0F));  // background: as cleared
  }
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
