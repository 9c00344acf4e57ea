#if defined(AFTERSHADE_CORE_TEMPORAL_TEMPORAL_WINDOW_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_TEMPORAL_TEMPORAL_WINDOW_KERNEL_H
#undef AFTERSHADE_CORE_TEMPORAL_TEMPORAL_WINDOW_KERNEL_H
#else
#define AFTERSHADE_CORE_TEMPORAL_TEMPORAL_WINDOW_KERNEL_H
#endif
#include <algorithm>
#include <limits>

#include "core/filter/lane_geometry.h"
#include "core/simd/math.h"
#include "core/temporal/temporal_window_rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

/// One direction of the mean over the neighbourhood: 9 taps, Gaussian, that end at other depths.
struct NeighbourhoodRow {
  Samples depth, still;   ///< still: surfaces that move are not averaged with those that do not
  Samples value, weight;  ///< value is already multiplied by weight
  int dx, dy;             ///< from tap to tap
  float *out_value, *out_weight;
};

inline void neighbourhood_row(const NeighbourhoodRow& row, int y) {
  constexpr float kRelative = 0.1F;                  // depths that differ by 10 % weigh a half
  constexpr float kFalloff = 1 / (2 * 2.5F * 2.5F);  // sigma = (reach + 1) / 2, with exp2: as in the blurs
  const int width = row.depth.width;
  for_each_vector(width, kNeighbourhoodReach * row.dx, kNeighbourhoodReach * row.dx, [&](int x0, auto inside) {
    const Columns<inside()> x(x0, width);
    const Float own = x(row.depth.row(y)), own_still = x(row.still.row(y));
    Float value = 0.0F, weight = 0.0F;
    for (int t = -kNeighbourhoodReach; t <= kNeighbourhoodReach; ++t) {
      const int ty = y + t * row.dy;
      if (ty < 0 || ty >= row.depth.height) continue;
      const Columns<inside()> tx(x0 + t * row.dx, width);
      const Float z = tx(row.depth.row(ty)), d = (z / own - 1.0F) * (1 / kRelative);
      const Mask valid = tx.inside & is_surface(z) & is_surface(own) & (tx(row.still.row(ty)) == own_still);
      const Float g = select(valid, exp2(-(static_cast<float>(t * t) * kFalloff + d * d)), 0.0F);
      value += select(g > 0.0F, g * tx(row.value.row(ty)), 0.0F);
      weight += select(g > 0.0F, g * tx(row.weight.row(ty)), 0.0F);
    }
    store(row.out_value + x0, value);
    store(row.out_weight + x0, weight);
  });
}

/// Mean of S over frames f-1 to f+1; frame f's own, 0, where one of its neighbours does not see the surface: a mean
/// over one side would lean towards it.
inline Float change_reference(const WindowRow& row, int x) {
  Float sum = 0.0F, weight = 1.0F;
  Mask seen = Float(0.0F) < 1.0F;
  for (const auto* side : {&row.before, &row.after}) {
    if (side->empty()) return 0.0F;
    const Float of_side = load(side->front().weight + x);
    seen = seen & (of_side > 0.0F);
    sum += of_side * load(side->front().change + x);
    weight += of_side;
  }
  return select(seen, sum / weight, 0.0F);
}

/// Puts values into ascending order, lane by lane.
inline void sort(Float* values, int count) {
  for (int i = 1; i < count; ++i)
    for (int j = i; j > 0; --j) {
      const Float less = min(values[j - 1], values[j]), more = max(values[j - 1], values[j]);
      values[j - 1] = less;
      values[j] = more;
    }
}

/// Variance of S along the trajectory, from the median of |s_{j+2} - 3 s_{j+1} + 3 s_j - s_{j-1}| of frames in a row:
/// sqrt(20) times the standard deviation for independent values, and 1.4826 times the median is that of a Gaussian. A
/// change that bends evenly adds nothing to it, a sudden one little. 0 with fewer than four frames.
inline Float change_noise(const WindowRow& row, int x) {
  constexpr float kNone = std::numeric_limits<float>::infinity();
  const int before = static_cast<int>(row.before.size()), after = static_cast<int>(row.after.size());
  const auto tap = [&](int j) {
    return j < 0 ? &row.before[static_cast<size_t>(-1 - j)] : &row.after[static_cast<size_t>(j - 1)];
  };
  const auto seen = [&](int j) { return (j == 0 ? Float(1.0F) : load(tap(j)->weight + x)) > 0.0F; };
  const auto value = [&](int j) { return j == 0 ? Float(0.0F) : load(tap(j)->change + x); };
  Float values[WindowRow::kMostTaps], known = 0.0F, median = 0.0F;
  int count = 0;
  for (int j = 1 - before; j + 1 < after; ++j) {
    const Mask all_seen = seen(j - 1) & seen(j) & seen(j + 1) & seen(j + 2);
    const Float difference = abs(value(j + 2) - value(j - 1) - 3.0F * (value(j + 1) - value(j)));
    values[count++] = select(all_seen, difference, kNone);
    known += select(all_seen, Float(1.0F), 0.0F);
  }
  sort(values, count);
  const Float middle = floor(known * 0.5F);
  for (int i = 0; i < count; ++i)
    median = select((known > 0.0F) & (middle == static_cast<float>(i)), values[i], median);
  constexpr float kScale = 1.4826F * 1.4826F / 20;
  return median * median * kScale;
}

/// How far a change is believed to be flicker.
struct Trust {
  Float reference, noise;
  float least;
  Float operator()(Float s, float share) const {
    const Float t = (s - reference) * (s - reference) / (share * noise + least);
    return 1.0F / (1.0F + t * t);
  }
};

/// Near moving surfaces the two of a pair stay or go together, so that an even change cancels; one alone cannot be told
/// from a lag, and has no noise to hide behind.
inline Float pair_trust(const Trust& trust, Float before, Float after) {
  return max(min(trust(before, 1), trust(after, 1)), trust((before + after) / 2.0F, 0.5F));
}

struct WindowSums {
  Float sum, weights;
};
/// Adds the frames at distance d on both sides, where there are such.
inline void add_pair(const WindowTap* before, const WindowTap* after, const Trust& trust, Mask tested, int x,
                     WindowSums& sums) {
  const bool testing = any(tested);
  Mask both = Float(0.0F) > 1.0F;
  Float of_pair = 0.0F;
  if (before != nullptr && after != nullptr) {
    both = (load(before->weight + x) > 0.0F) & (load(after->weight + x) > 0.0F);
    if (testing) of_pair = pair_trust(trust, load(before->change + x), load(after->change + x));
  }
  for (const WindowTap* tap : {before, after}) {
    if (tap == nullptr) continue;
    const Float seen = load(tap->weight + x);
    Float w = tap->window * seen;
    if (testing) {
      const Float believed = select(both, of_pair, trust(load(tap->change + x), 0));
      w = select(tested, w * (1.0F - load(tap->tested + x) * (1.0F - believed)), w);
    }
    sums.sum += select(seen > 0.0F, w * load(tap->difference + x), 0.0F);
    sums.weights += select(seen > 0.0F, w, 0.0F);
  }
}

inline void window_row(const WindowRow& row) {
  const size_t before = row.before.size(), after = row.after.size(), furthest = std::max(before, after);
  const bool testing = furthest > 0 && (before > 0 ? row.before : row.after).front().change != nullptr;
  for (int x = 0; x < row.width; x += kLanes) {
    const Float given = load(row.ao + x), own = select(is_finite(given), given, 1.0F);
    Mask tested = Float(0.0F) > 1.0F;
    if (testing)
      for (const auto* side : {&row.before, &row.after})
        if (!side->empty()) tested = tested | (load(side->back().tested + x) > 0.0F);
    tested = tested & (iota(x) < Int(row.width));
    Trust trust{0.0F, 0.0F, row.change * row.change};
    if (any(tested)) {
      trust.reference = change_reference(row, x);
      trust.noise = row.significance * row.significance * change_noise(row, x);
    }
    WindowSums sums{0.0F, 1.0F};
    for (size_t d = 0; d < furthest; ++d)
      add_pair(d < before ? &row.before[d] : nullptr, d < after ? &row.after[d] : nullptr, trust, tested, x, sums);
    store(row.out_ao + x, own + sums.sum / sums.weights);
    store(row.out_weight + x, sums.weights / row.total);
  }
}

/// value = a * b.
inline void product_row(const float* a, const float* b, int width, float* value) {
  for (int x = 0; x < width; x += kLanes) store(value + x, load(a + x) * load(b + x));
}

/// value / weight, 0 where nothing weighs.
inline void quotient_row(const float* weight, int width, float* value) {
  for (int x = 0; x < width; x += kLanes) {
    const Float w = load(weight + x);
    store(value + x, select(w > 0.0F, load(value + x) / w, 0.0F));
  }
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
