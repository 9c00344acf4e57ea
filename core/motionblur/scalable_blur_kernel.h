#pragma once
#include "core/math/sampling.h"
#include "core/motionblur/gather_source.h"
#include "core/simd/lanes.h"

/// The gather of Vicarious Visions' motion blur (seed 004), one row.
namespace aftershade::motionblur {

/// Below it the direction of the centre's velocity says nothing (algorithms 2.4, G3D's threshold).
inline constexpr float kLeastDirection_px = 1.5F;

/// The planes have one size, and `stride` floats from row to row.
struct ScalableBlurKernel {
  static constexpr int kChannels = 4;
  int width, height, stride;
  int origin_x, origin_y;  ///< absolute coordinates of pixel (0, 0): the jitter is tied to them
  const float* speed;      ///< as GatherSource gives it
  const float* depth;      ///< likewise
  int channels;            ///< 1 to kChannels
  const float* source[kChannels];
  int taps;  ///< odd
  bool checkerboard, alternate;
  float inverse_soft_extent;  ///< 1 / metres
  float background_weight, foreground_weight, both_moving_weight, centre_weight;
};

/// The row's own data.
struct ScalableBlurRow {
  const float *velocity_x, *velocity_y;    ///< of the pixels: v_C
  const float *neighbour_x, *neighbour_y;  ///< of the tiles around each pixel: v_N
  float* target[ScalableBlurKernel::kChannels];
};

namespace detail {
using namespace lanes;

struct Vector {
  Float x, y;
};

/// What the comparison reads of a pixel.
struct Point {
  Float speed, depth;
};

/// Slides "Foreground vs. Background" to "Mutually Blurry Samples": the cases are not exclusive, the third is mixed in.
/// Paper and slides differ in the sign of z; with positive z, F = sat(1 - (z_S - z_C) / E), B the reverse (algorithms
/// 14 no. 20).
inline Float tap_weight(const ScalableBlurKernel& k, Point centre, Point sample, Float distance) {
  const Float behind_by = (sample.depth - centre.depth) * k.inverse_soft_extent;
  const Float background = sat(1.0F + behind_by) * sat(1.0F - distance / centre.speed);
  const Float foreground = sat(1.0F - behind_by) * sat(1.0F - distance / sample.speed);
  const Mask both_moving = (sample.speed >= distance) & (centre.speed >= distance);
  return k.background_weight * background + k.foreground_weight * foreground +
         select(both_moving, Float(k.both_moving_weight), Float(0.0F));
}

/// In (-0.5, 0.5), a share of the tap spacing. Slides: checkerboard (its +-1/4 is G3D's, algorithms 2.3), or 4x4.
inline Float jitter_of(const ScalableBlurKernel& k, int x, int y) {
  const Int column = iota(x) + Int(k.origin_x), row = Int(y) + Int(k.origin_y);
  if (k.checkerboard) return 0.5F * to_float((column + row) & Int(1)) - 0.25F;
  return gather(kBayer4x4.data(), ((row & Int(3)) << 2) + (column & Int(3))) - 0.5F;
}

/// The centre's direction with the neighbourhood's length, where the centre has a direction (algorithms 2.4, 14 no.
/// 19).
inline Vector second_direction(const ScalableBlurKernel& k, Vector centre, Float speed, Vector neighbour,
                               Float length) {
  if (!k.alternate) return neighbour;
  const Mask known = speed >= kLeastDirection_px;
  const Float scale = length / max(speed, kLeastDirection_px);
  return {select(known, centre.x * scale, neighbour.x), select(known, centre.y * scale, neighbour.y)};
}

/// What one group of pixels has gathered so far. Colours are summed as differences from the centre's: where they agree
/// the result is the centre's value to the bit (an alpha of 1 stays 1).
struct Gathered {
  Float centre[ScalableBlurKernel::kChannels];
  Float difference[ScalableBlurKernel::kChannels];
  Float weight;
};

/// The tap at `offset` from pixel (x, y), read at the nearest pixel. Its distance is that of the tap, not of the pixel,
/// as in the slides, which do not round; it is also what algorithms 3.5 was computed with.
inline void add_tap(const ScalableBlurKernel& k, Int x, Int y, Vector offset, Float distance, Point centre,
                    Gathered& sum) {
  const Int sx = x + to_int(round(offset.x)), sy = y + to_int(round(offset.y));
  const Mask inside = (sx >= Int(0)) & (sx < Int(k.width)) & (sy >= Int(0)) & (sy < Int(k.height));
  const Int index = clamp(sy, 0, k.height - 1) * Int(k.stride) + clamp(sx, 0, k.width - 1);
  const Float speed = gather(k.speed, index);
  const Mask usable = inside & (speed > 0.0F);
  const Point sample{max(speed, kLeastRadius_px), gather(k.depth, index)};
  const Float weight = select(usable, tap_weight(k, centre, sample, distance), 0.0F);
  sum.weight += weight;
  for (int c = 0; c < k.channels; ++c) {
    const Float difference = gather(k.source[c], index) - sum.centre[c];
    sum.difference[c] += select(usable, weight * difference, 0.0F);
  }
}

}  // namespace detail

/// Blurs row y. Pixels that do not move are left as they are in `target`, which holds the source's values.
inline void scalable_blur_row(const ScalableBlurKernel& k, const ScalableBlurRow& row, int y) {
  using namespace lanes;
  using namespace detail;
  const Float spacing = 2.0F / static_cast<float>(k.taps + 1);
  const int middle = (k.taps - 1) / 2, row_start = y * k.stride;
  for (int x = 0; x < k.width; x += kLanes) {
    const Vector neighbour{load(row.neighbour_x + x), load(row.neighbour_y + x)};
    const Float length = sqrt(neighbour.x * neighbour.x + neighbour.y * neighbour.y);
    const Float speed = load(k.speed + row_start + x);
    const Mask moving =
        (length > kLeastRadius_px) & (speed > 0.0F);  // slide "Current Gen Implementation": branch on velocity
    if (!any(moving)) continue;
    const Point centre{max(speed, kLeastRadius_px), load(k.depth + row_start + x)};
    const Vector own{load(row.velocity_x + x), load(row.velocity_y + x)};
    const Vector second = second_direction(k, own, speed, neighbour, length);
    const Float jitter = jitter_of(k, x, y);
    Gathered sum;
    sum.weight = k.centre_weight / centre.speed;  // algorithms 2.2: w = 1 / |V[X]|
    for (int c = 0; c < k.channels; ++c) {
      sum.centre[c] = load(k.source[c] + row_start + x);
      sum.difference[c] = 0.0F;
    }
    for (int i = 0; i < k.taps; ++i) {
      if (i == middle) continue;
      const Float t =
          (Float(static_cast<float>(i - middle)) + jitter) * spacing;  // algorithms 2.2: mix(-1, 1, (i+j+1)/(S+1))
      const Vector& v = (i & 1) != 0 ? second : neighbour;
      add_tap(k, iota(x), y, {v.x * t, v.y * t}, length * abs(t), centre, sum);
    }
    for (int c = 0; c < k.channels; ++c)
      store(row.target[c] + x, select(moving, sum.centre[c] + sum.difference[c] / sum.weight, sum.centre[c]));
  }
}

}  // namespace aftershade::motionblur
