#pragma once
#include <vector>

namespace aftershade::ao {

/// A tap before it is scaled and rotated: `radius` as a share of the projected radius, (x, y) a unit vector.
struct Tap {
  float radius, x, y;
};

/// Turns of a spiral of `taps` points, (alpha_i, frac(alpha_i turns)) with alpha_i = (i + 0.5) / taps (algorithms 4.2):
/// the whole number, prime to `taps`, of least star discrepancy; above 64 taps, where the search would be slow, the
/// nearest to golden ratio * taps.
int spiral_turns(int taps);

/// sup over boxes [0,a) x [0,b) of |share of the points inside - a b|, points (alpha_i, frac(alpha_i turns)).
double star_discrepancy(int taps, int turns);

/// Taps linear in radius along a spiral over the whole circle.
std::vector<Tap> spiral_taps(int taps);

/// Pairs of opposite taps, the pairs along a spiral over half the circle; an odd count is rounded up.
std::vector<Tap> mirrored_taps(int taps);

}  // namespace aftershade::ao
