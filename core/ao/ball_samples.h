#pragma once
#include <array>
#include <vector>

namespace aftershade::ao {

/// Points of the sequence before it starts again. A power of two.
inline constexpr int kSequenceLength = 4096;

/// Points uniform in the volume of the unit ball: Halton's sequence in bases 2, 3 and 5 (radius, height, azimuth), of
/// which any run of consecutive points is spread evenly, so that an estimate may go on where an earlier one stopped.
struct BallSamples {
  std::vector<float> x, y, z;
};
const BallSamples& ball_samples();

/// Unit vectors for a 4x4 tile, row y, column x: 16 points of a Fibonacci spiral on the sphere, in Bayer's order.
struct MirrorTile {
  std::array<float, 16> x, y, z;
};
const MirrorTile& mirror_tile();

}  // namespace aftershade::ao
