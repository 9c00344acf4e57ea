#include "core/ao/ball_samples.h"

#include <cmath>

#include "core/math/sampling.h"
#include "core/simd/scalar.h"

namespace aftershade::ao {

namespace {

/// The digits of `index` in `base`, mirrored at the point (Halton 1960).
double radical_inverse(int index, int base) {
  double value = 0, digit = 1;
  for (int rest = index; rest > 0; rest /= base) {
    digit /= base;
    value += digit * (rest % base);
  }
  return value;
}

/// Newton's iteration, for x in [0, 1]: libm's cube roots differ between machines.
double cube_root(double x) {
  if (!(x > 0)) return 0;
  double root = 1;
  for (int i = 0; i < 40; ++i) root -= (root - x / (root * root)) / 3;
  return root;
}

struct Direction {
  float x, y, z;
};
Direction direction(double height, double turns) {
  const lanes::UnitVector azimuth = lanes::unit_vector(static_cast<float>(turns));
  const auto flat = static_cast<float>(std::sqrt(1 - height * height));
  return {flat * azimuth.x, flat * azimuth.y, static_cast<float>(height)};
}

BallSamples make_ball() {
  BallSamples out;
  for (int i = 1; i <= kSequenceLength; ++i) {
    const Direction d = direction(1 - 2 * radical_inverse(i, 3), radical_inverse(i, 5));
    const auto radius = static_cast<float>(cube_root(radical_inverse(i, 2)));
    out.x.push_back(radius * d.x);
    out.y.push_back(radius * d.y);
    out.z.push_back(radius * d.z);
  }
  return out;
}

MirrorTile make_tile() {
  constexpr double kGolden = 0.6180339887498949;
  MirrorTile out{};
  for (size_t texel = 0; texel < 16; ++texel) {
    const double rank = kBayer4x4[texel];  // (k + 0.5) / 16
    const Direction d = direction(1 - 2 * rank, 16 * rank * kGolden);
    out.x[texel] = d.x;
    out.y[texel] = d.y;
    out.z[texel] = d.z;
  }
  return out;
}

}  // namespace

const BallSamples& ball_samples() {
  static const BallSamples samples = make_ball();
  return samples;
}

const MirrorTile& mirror_tile() {
  static const MirrorTile tile = make_tile();
  return tile;
}

}  // namespace aftershade::ao
