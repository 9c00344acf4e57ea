#pragma once
#include "core/image/plane.h"
#include "core/simd/lanes.h"

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
  float *out_ao, *out_depth, *out_count;
};

struct FetchedHistory {
  Float ao, count;
  Mask known;
};

/// Four bilinear taps, each validated on its own, weights renormalised; unknown when the valid taps weigh less than a
/// quarter (algorithms 7.3). N is averaged like AO: it is the weight that the fetched mean deserves.
inline FetchedHistory fetch_history(const HistoryView& h, Float x, Float y, Float expected, float epsilon) {
  const auto columns = static_cast<float>(h.depth.width), rows = static_cast<float>(h.depth.height);
  const Float u = x - 0.5F, v = y - 0.5F, u0 = floor(u), v0 = floor(v);        // fractions do not depend on the window
  const Float left = clamp(u0 - static_cast<float>(h.min_x), -2.0F, columns);  // NaN becomes -2: outside
  const Float top = clamp(v0 - static_cast<float>(h.min_y), -2.0F, rows);
  Float sum = 0.0F, ao = 0.0F, count = 0.0F;
  for (int tap = 0; tap < 4; ++tap) {
    const auto right = static_cast<float>(tap & 1), below = static_cast<float>(tap >> 1);
    const Float tu = left + right, tv = top + below;
    const Mask inside = (tu >= 0.0F) & (tu < columns) & (tv >= 0.0F) & (tv < rows);  // seed 000: borderZ = 0
    const Int row = to_int(clamp(tv, 0.0F, rows - 1.0F)) * Int(static_cast<int32_t>(h.depth.stride));
    const Int index = row + to_int(clamp(tu, 0.0F, columns - 1.0F));
    const Float z = gather(h.depth.data, index);
    // Seed 000, "Disocclusion Test"; algorithms 14, item 4. No history is depth 0, where the ratio is infinite.
    const Mask same = abs(1.0F - expected / z) < epsilon;
    const Float weight = (1.0F - abs(u - u0 - right)) * (1.0F - abs(v - v0 - below));
    const Float valid = select(inside & same, weight, 0.0F);
    sum += valid;
    ao += valid * gather(h.ao.data, index);
    count += valid * gather(h.count.data, index);
  }
  return {ao / sum, count / sum, sum >= 0.25F};
}

/// SelectiveTemporalFilter (seed 000's listing; algorithms 14, items 1 to 4: what is stored is z_i, and N is capped as
/// stored, so that the new frame weighs at least 1 / (N_max + 1)). AO that is no number counts as 1.
inline void temporal_row(const TemporalRow& row) {
  for (int x = 0; x < row.width; x += kLanes) {
    const Float given = load(row.ao + x), z = load(row.depth + x);
    const Float ao = select(is_finite(given), given, 1.0F);
    const Float stable = row.stable != nullptr ? load(row.stable + x) : Float(0.0F);
    const FetchedHistory before =
        fetch_history(row.before, load(row.x + x), load(row.y + x), load(row.expected + x), row.epsilon);
    const Mask blend = before.known & (stable < 0.5F);
    const Float mean = (before.count * before.ao + ao) / (before.count + 1.0F);
    store(row.out_ao + x, select(blend, mean, ao));
    store(row.out_count + x, select(blend, min(before.count + 1.0F, row.max_frames), 1.0F));
    store(row.out_depth + x, select(is_finite(z) & (z > 0.0F), z, 0.0F));  // background: as cleared
  }
}

}  // namespace aftershade::temporal
