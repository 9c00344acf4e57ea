#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/filter/lane_geometry.h"
#include "core/simd/math.h"

namespace aftershade::temporal {
using namespace lanes;

/// One direction of the mean over the neighbourhood: 9 taps, Gaussian, that end at other depths.
struct NeighbourhoodRow {
  static constexpr int kReach = 4;
  filter::Samples depth, still;   ///< still: surfaces that move are not averaged with those that do not
  filter::Samples value, weight;  ///< value is already multiplied by weight
  int dx, dy;                     ///< from tap to tap
  float *out_value, *out_weight;
};

inline void neighbourhood_row(const NeighbourhoodRow& row, int y) {
  constexpr float kRelative = 0.1F;                  // depths that differ by 10 % weigh a half
  constexpr float kFalloff = 1 / (2 * 2.5F * 2.5F);  // sigma = (reach + 1) / 2, with exp2: as in the blurs
  for (int x0 = 0; x0 < row.depth.width; x0 += kLanes) {
    const Int x = row.depth.clamp_x(iota(x0)), iy = y;
    const Float own = row.depth(x, iy), own_still = row.still(x, iy);
    Float value = 0.0F, weight = 0.0F;
    for (int t = -NeighbourhoodRow::kReach; t <= NeighbourhoodRow::kReach; ++t) {
      const Int tx = x + Int(t * row.dx), ty = iy + Int(t * row.dy);
      const Int sx = row.depth.clamp_x(tx), sy = row.depth.clamp_y(ty);
      const Float z = row.depth(sx, sy), d = (z / own - 1.0F) * (1 / kRelative);
      const Mask valid = row.depth.contains(tx, ty) & filter::is_surface(z) & filter::is_surface(own) &
                         (row.still(sx, sy) == own_still);
      const Float g = select(valid, exp2(-(static_cast<float>(t * t) * kFalloff + d * d)), 0.0F);
      value += select(g > 0.0F, g * row.value(sx, sy), 0.0F);
      weight += select(g > 0.0F, g * row.weight(sx, sy), 0.0F);
    }
    store(row.out_value + x0, value);
    store(row.out_weight + x0, weight);
  }
}

/// One frame of the window as the row sees it.
struct WindowTap {
  const float *difference, *weight;  ///< D and v
  const float* change;               ///< S; null where changes are not tested
  const float* tested;               ///< 0 to 1: how far the test decides; null with `change`
  float window;                      ///< w
};

struct WindowRow {
  const float* ao;
  std::vector<WindowTap> before, after;  ///< in the order of their distance from the centre
  float total;                           ///< sum of all w of a whole window
  float change, significance;
  int width;
  float *out_ao, *out_weight;
};

/// Mean of S over frames f-1 to f+1; frame f's own, 0, where one of its neighbours does not see the surface: a mean
/// over one side would lean towards it.
inline float change_reference(const WindowRow& row, int x) {
  float sum = 0, weight = 1;
  for (const auto* side : {&row.before, &row.after}) {
    if (side->empty() || !(side->front().weight[x] > 0)) return 0;
    sum += side->front().weight[x] * side->front().change[x];
    weight += side->front().weight[x];
  }
  return sum / weight;
}

/// Variance of S along the trajectory, from the median of |s_{j+2} - 3 s_{j+1} + 3 s_j - s_{j-1}| of frames in a row:
/// sqrt(20) times the standard deviation for independent values, and 1.4826 times the median is that of a Gaussian. A
/// change that bends evenly adds nothing to it, a sudden one little. 0 with fewer than four frames.
inline float change_noise(const WindowRow& row, int x, std::vector<float>& scratch) {
  scratch.clear();
  const int before = static_cast<int>(row.before.size()), after = static_cast<int>(row.after.size());
  const auto tap = [&](int j) {
    return j < 0 ? &row.before[static_cast<size_t>(-1 - j)] : &row.after[static_cast<size_t>(j - 1)];
  };
  const auto seen = [&](int j) { return j == 0 || tap(j)->weight[x] > 0; };
  const auto value = [&](int j) { return j == 0 ? 0.0F : tap(j)->change[x]; };
  for (int j = 1 - before; j + 1 < after; ++j)
    if (seen(j - 1) && seen(j) && seen(j + 1) && seen(j + 2))
      scratch.push_back(std::abs(value(j + 2) - value(j - 1) - 3 * (value(j + 1) - value(j))));
  if (scratch.empty()) return 0;
  const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>(scratch.size() / 2);
  std::nth_element(scratch.begin(), middle, scratch.end());
  constexpr float kScale = 1.4826F * 1.4826F / 20;
  return *middle * *middle * kScale;
}

/// Per pixel, because the median is: plain float, no lanes.
inline void window_row(const WindowRow& row) {
  std::vector<float> scratch;
  const size_t before = row.before.size(), after = row.after.size(), furthest = std::max(before, after);
  for (int x = 0; x < row.width; ++x) {
    const float given = row.ao[x], own = std::isfinite(given) ? given : 1.0F;
    const bool testing = furthest > 0 && (before > 0 ? row.before : row.after).front().change != nullptr;
    const auto decides = [&](const WindowTap* tap) { return tap->tested[x] > 0; };
    bool tested = false;
    if (testing)
      for (const auto* side : {&row.before, &row.after}) tested = tested || (!side->empty() && decides(&side->back()));
    const float reference = tested ? change_reference(row, x) : 0;
    const float noise = tested ? row.significance * row.significance * change_noise(row, x, scratch) : 0;
    const float least = row.change * row.change;
    const auto trust = [&](float s, float share) {
      const float t = (s - reference) * (s - reference) / (share * noise + least);
      return 1 / (1 + t * t);
    };
    float sum = 0, weights = 1;
    for (size_t d = 0; d < furthest; ++d) {
      const WindowTap* pair[2] = {d < before ? &row.before[d] : nullptr, d < after ? &row.after[d] : nullptr};
      const bool both = pair[0] != nullptr && pair[1] != nullptr && pair[0]->weight[x] > 0 && pair[1]->weight[x] > 0;
      // Near moving surfaces the two of a pair stay or go together, so that an even change cancels; one alone cannot be
      // told from a lag, and has no noise to hide behind.
      const auto pair_trust = [&] {
        const float before_s = pair[0]->change[x], after_s = pair[1]->change[x];
        return std::max(std::min(trust(before_s, 1), trust(after_s, 1)), trust((before_s + after_s) / 2, 0.5F));
      };
      const float of_pair = tested && both ? pair_trust() : 0;
      for (const WindowTap* tap : pair) {
        if (tap == nullptr || !(tap->weight[x] > 0)) continue;
        float w = tap->window * tap->weight[x];
        if (tested) w *= 1 - tap->tested[x] * (1 - (both ? of_pair : trust(tap->change[x], 0)));
        sum += w * tap->difference[x];
        weights += w;
      }
    }
    row.out_ao[x] = own + sum / weights;
    row.out_weight[x] = weights / row.total;
  }
}

}  // namespace aftershade::temporal
