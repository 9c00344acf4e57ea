#pragma once
#include "core/motionblur/gather_source.h"
#include "core/simd/lanes.h"

/// What the rows of gathering blurs share: reading a tap, the tests of McGuire et al. 2012 (algorithms 2.2), the
/// weighted sum.
namespace aftershade::motionblur {

/// In norm(v) = v / (|v| + 1e-5) (algorithms 2.1).
inline constexpr float kNoDivisionByZero = 1e-5F;

/// Planes of one size, `stride` floats from row to row.
struct GatherPlanes {
  static constexpr int kChannels = 4;
  int width, height, stride;
  const float *speed, *depth;  ///< as GatherSource gives them
  int channels;                ///< 1 to kChannels
  const float* source[kChannels];
};

namespace gathering {
using namespace lanes;

struct Vector {
  Float x, y;
};
inline Float dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }
inline Float length(Vector v) { return sqrt(dot(v, v)); }

/// The share of a surface's light that its blur of this radius leaves at this distance, up to a constant.
inline Float cone(Float distance, Float radius) { return sat(1.0F - distance / radius); }

/// 1 within the radius, smoothly 0 beyond: 1 - smoothstep(0.95 r, 1.05 r, d).
inline Float cylinder(Float distance, Float radius) {
  const Float t = sat((distance - 0.95F * radius) / (0.1F * radius));
  return 1.0F - t * t * (3.0F - 2.0F * t);
}

/// How far a tap counts as lying before and as lying behind the centre, if it is `by` depth extents behind it; both are
/// 1 at the same depth.
struct Order {
  Float before, behind;
};
inline Order soft_order(Float by) { return {sat(1.0F - by), sat(1.0F + by)}; }

/// The nearest pixel to a place; not usable outside the image, nor where GatherSource excludes a pixel.
struct Tap {
  Int index;
  Mask usable;
  Float speed, depth;
};
inline Tap tap_at(const GatherPlanes& p, Int x, Int y, Vector offset) {
  const Int sx = x + to_int(round(offset.x)), sy = y + to_int(round(offset.y));
  const Mask inside = (sx >= Int(0)) & (sx < Int(p.width)) & (sy >= Int(0)) & (sy < Int(p.height));
  const Int index = clamp(sy, 0, p.height - 1) * Int(p.stride) + clamp(sx, 0, p.width - 1);
  const Float speed = gather(p.speed, index);
  return {index, inside & (speed > 0.0F), max(speed, kLeastRadius_px), gather(p.depth, index)};
}

/// What one group of pixels has gathered so far. Colours are summed as differences from the centre's: where they agree
/// the result is the centre's value to the bit (an alpha of 1 stays 1).
struct Gathered {
  Float centre[GatherPlanes::kChannels];
  Float difference[GatherPlanes::kChannels];
  Float weight;
};
inline Gathered gathered(const GatherPlanes& p, int index, Float weight) {
  Gathered sum;
  sum.weight = weight;
  for (int c = 0; c < p.channels; ++c) {
    sum.centre[c] = load(p.source[c] + index);
    sum.difference[c] = 0.0F;
  }
  return sum;
}
inline void add(const GatherPlanes& p, const Tap& tap, Float weight, Gathered& sum) {
  sum.weight += select(tap.usable, weight, 0.0F);
  for (int c = 0; c < p.channels; ++c) {
    const Float difference = gather(p.source[c], tap.index) - sum.centre[c];
    sum.difference[c] += select(tap.usable, weight * difference, 0.0F);
  }
}
inline void store_mean(const GatherPlanes& p, const Gathered& sum, Mask where, float* const* target, int x) {
  for (int c = 0; c < p.channels; ++c)
    store(target[c] + x, select(where, sum.centre[c] + sum.difference[c] / sum.weight, sum.centre[c]));
}

}  // namespace gathering
}  // namespace aftershade::motionblur
