#pragma once
#include <vector>

/// What the temporal window hands to its rows.
namespace aftershade::temporal {

/// Taps of the neighbourhood to either side.
inline constexpr int kNeighbourhoodReach = 4;

/// One frame of the window as the row sees it.
struct WindowTap {
  const float *difference, *weight;  ///< D and v
  const float* change;               ///< S; null where changes are not tested
  const float* tested;               ///< 0 to 1: how far the test decides; null with `change`
  float window;                      ///< w
};

struct WindowRow {
  static constexpr int kMostTaps = 128;  ///< 64 on each side
  const float* ao;
  std::vector<WindowTap> before, after;  ///< in the order of their distance from the centre
  float total;                           ///< sum of all w of a whole window
  float change, significance;
  int width;
  float *out_ao, *out_weight;
};

}  // namespace aftershade::temporal
