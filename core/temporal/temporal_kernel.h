#pragma once
#include "core/image/plane.h"
#include "core/simd/lanes.h"
#include "core/simd/math.h"

namespace aftershade::temporal {
using namespace lanes;

/// History of frame i-1; its index (0, 0) is absolute pixel (min_x, min_y). All planes have one stride.
struct HistoryView {
  ConstPlaneView ao, depth, count;
  int min_x, min_y;
};

struct TemporalRow {
  const float *ao, *depth;        ///< of frame i
  const float* stable;            ///< 1: keep this frame's AO; null: nothing is stable
  const float *x, *y, *expected;  ///< absolute position and planar depth w_i in frame i-1, NaN: unknown
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

/// The texel left and above of a position, in the planes' index, and its fractions, which do not depend on the window.
struct FirstTap {
  Float left, top, share_x, share_y;
};
inline FirstTap first_tap(const HistoryView& h, Float x, Float y) {
  const Float u = x - 0.5F, v = y - 0.5F, u0 = floor_of_position(u), v0 = floor_of_position(v);
  return {clamp(u0 - static_cast<float>(h.min_x), -2.0F, static_cast<float>(h.depth.width)),  // NaN becomes -2: outside
          clamp(v0 - static_cast<float>(h.min_y), -2.0F, static_cast<float>(h.depth.height)), u - u0, v - v0};
}

inline Mask inside(const HistoryView& h, Float x, Float y) {
  return (x >= 0.0F) & (x < static_cast<float>(h.depth.width)) & (y >= 0.0F) & (y < static_cast<float>(h.depth.height));
}
inline Int index_of(const HistoryView& h, Float x, Float y) {
  return to_int(clamp(y, 0.0F, static_cast<float>(h.depth.height - 1))) * Int(static_cast<int32_t>(h.depth.stride)) +
         to_int(clamp(x, 0.0F, static_cast<float>(h.depth.width - 1)));
}

/// Four bilinear taps, each validated on its own, weights renormalised; unknown when the valid taps weigh less than a
/// quarter (algorithms 7.3). N is averaged like AO: it is the weight that the fetched mean deserves.
inline FetchedHistory fetch_history(const HistoryView& h, Float x, Float y, Float expected, float epsilon) {
  const FirstTap first = first_tap(h, x, y);
  Float sum = 0.0F, ao = 0.0F, count = 0.0F;
  for (int tap = 0; tap < 4; ++tap) {
    const bool right = (tap & 1) != 0, below = (tap & 2) != 0;
    const Float tu = first.left + (right ? 1.0F : 0.0F), tv = first.top + (below ? 1.0F : 0.0F);
    const Int index = index_of(h, tu, tv);
    const Float weight =
        (right ? first.share_x : 1.0F - first.share_x) * (below ? first.share_y : 1.0F - first.share_y);
    const Mask same = same_surface(expected, gather(h.depth.data, index), epsilon);
    const Float valid = select(inside(h, tu, tv) & same, weight, 0.0F);
    sum += valid;
    ao += valid * gather(h.ao.data, index);
    count += valid * gather(h.count.data, index);
  }
  return {ao / sum, count / sum, sum >= 0.25F};
}

/// The listing as printed: z_{i-1} (and N, of which it says nothing) of the nearest pixel, 0 outside; AO bilinear, of
/// whatever surface its four taps show.
inline FetchedHistory fetch_literally(const HistoryView& h, Float x, Float y, Float expected, float epsilon) {
  const Float px = floor_of_position(x) - static_cast<float>(h.min_x);
  const Float py = floor_of_position(y) - static_cast<float>(h.min_y);
  const Int nearest = index_of(h, px, py);
  const FirstTap first = first_tap(h, x, y);
  const auto ao_at = [&](float right, float below) {
    return gather(h.ao.data, index_of(h, first.left + right, first.top + below));
  };
  const auto across = [&](float below) {
    const Float left = ao_at(0, below);
    return left + first.share_x * (ao_at(1, below) - left);
  };
  const Float above = across(0);
  const Mask same = same_surface(expected, gather(h.depth.data, nearest), epsilon);
  return {above + first.share_y * (across(1) - above), gather(h.count.data, nearest), inside(h, px, py) & same};
}

inline Mask is_stable(const TemporalRow& row, int x) {
  return row.stable != nullptr ? load(row.stable + x) >= 0.5F : Mask{false};
}

/// SelectiveTemporalFilter (seed 000's listing; algorithms 14, items 1 to 4: what is stored is z_i, and N is capped as
/// stored, so that the new frame weighs at least 1 / (N_max + 1)). Literally, what is stored is w_i, where there is
/// one. AO that is no number counts as 1.
inline void temporal_row(const TemporalRow& row) {
  for (int x = 0; x < row.width; x += kLanes) {
    const Float given = load(row.ao + x), z = load(row.depth + x);
    Float ao = select(is_finite(given), given, 1.0F), count = 1.0F;
    const Mask stable = is_stable(row, x);
    if (!all(stable)) {
      const Float px = load(row.x + x), py = load(row.y + x), expected = load(row.expected + x);
      const FetchedHistory before = row.literal ? fetch_literally(row.before, px, py, expected, row.epsilon)
                                                : fetch_history(row.before, px, py, expected, row.epsilon);
      const Mask blend = before.known & !stable;
      ao = select(blend, (before.count * before.ao + ao) / (before.count + 1.0F), ao);
      count = select(blend, min(before.count + 1.0F, row.max_frames), 1.0F);
    }
    store(row.out_ao + x, ao);
    store(row.history_ao + x, ao);
    store(row.out_count + x, count);
    const Float w = row.literal ? load(row.expected + x) : z;
    const Float stored = select(is_finite(w) & (w > 0.0F), w, z);
    store(row.out_depth + x, select(is_finite(z) & (z > 0.0F), stored, 0.0F));  // background: as cleared
  }
}

}  // namespace aftershade::temporal
