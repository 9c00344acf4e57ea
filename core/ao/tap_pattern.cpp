#include "core/ao/tap_pattern.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/simd/scalar.h"

namespace aftershade::ao {

namespace {

double alpha(int i, int taps) { return (i + 0.5) / taps; }
double fraction(double x) { return x - std::floor(x); }

/// `circle`: the share of the circle that a spiral of `taps` points winds over.
std::vector<Tap> spiral(int taps, double circle) {
  const int turns = spiral_turns(taps);
  std::vector<Tap> out;
  for (int i = 0; i < taps; ++i) {
    const double angle = circle * fraction(alpha(i, taps) * turns);
    const lanes::UnitVector direction = lanes::unit_vector(static_cast<float>(angle));
    out.push_back({static_cast<float>(alpha(i, taps)), direction.x, direction.y});
  }
  return out;
}

}  // namespace

double star_discrepancy(int taps, int turns) {
  std::vector<double> heights;  // of the points left of the box's edge, sorted
  double worst = 0;
  const auto measure = [&](double a) {
    for (size_t k = 0; k <= heights.size(); ++k) {
      // Boxes that end just below the k-th height hold k points; those that end just above the one before as well.
      const double share = static_cast<double>(k) / taps;
      const double high = k < heights.size() ? heights[k] : 1.0, low = k > 0 ? heights[k - 1] : 0.0;
      worst = std::max({worst, std::abs(share - a * high), std::abs(share - a * low)});
    }
  };
  for (int i = 0; i < taps; ++i) {
    measure(alpha(i, taps));
    const double height = fraction(alpha(i, taps) * turns);
    heights.insert(std::upper_bound(heights.begin(), heights.end(), height), height);
    measure(alpha(i, taps));
  }
  measure(1.0);
  return worst;
}

int spiral_turns(int taps) {
  constexpr int kSearched = 64;
  constexpr double kGolden = 0.6180339887498949;
  if (taps <= 2) return 1;
  if (taps > kSearched) {
    int turns = static_cast<int>(std::lround(kGolden * taps));
    while (std::gcd(turns, taps) != 1) ++turns;
    return turns;
  }
  int best = 1;
  double least = star_discrepancy(taps, best);
  for (int turns = 2; turns < taps; ++turns) {
    if (std::gcd(turns, taps) != 1) continue;
    const double discrepancy = star_discrepancy(taps, turns);
    if (discrepancy < least) {
      best = turns;
      least = discrepancy;
    }
  }
  return best;
}

std::vector<Tap> spiral_taps(int taps) { return spiral(taps, 1.0); }

std::vector<Tap> mirrored_taps(int taps) {
  std::vector<Tap> out;
  for (const Tap& tap : spiral((taps + 1) / 2, 0.5)) {
    out.push_back(tap);
    out.push_back({tap.radius, -tap.x, -tap.y});
  }
  return out;
}

}  // namespace aftershade::ao
