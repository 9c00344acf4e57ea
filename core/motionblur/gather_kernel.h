// What the rows of gathering blurs share: reading a tap, the tests of McGuire et al. 2012 (algorithms 2.2), the
// weighted sum.
#if defined(AFTERSHADE_CORE_MOTIONBLUR_GATHER_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_GATHER_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_GATHER_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_GATHER_KERNEL_H
#endif
#include <algorithm>

#include "core/motionblur/gather_source.h"
#include "core/parallel/rows.h"
#include "core/simd/records.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// The records around row y.
struct GatherRow {
  int width, height, y;
  int stride;                              ///< floats from row to row
  int record_floats;                       ///< and from pixel to pixel
  const float* records;                    ///< of pixel (0, y)
  int channels;                            ///< 1 to GatherRecord::kChannels
  float* target[GatherRecord::kChannels];  ///< row y of each channel; holds the source's values
};

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

/// A pixel's record.
struct Tap {
  Mask usable;
  Float speed, depth;  ///< the speed is at least half a pixel, usable or not
  Vector direction;    ///< where records have one
  Quad colour;
};
inline Tap tap_of(const GatherRow& row, Int index, Mask inside) {
  static_assert(GatherRecord::kChannels == 4 && GatherRecord::kSpeed == 4 && GatherRecord::kDirection == 6);
  const auto [colour, rest] = load_long_records(row.records, index);
  return {inside & (rest.a > 0.0F), max(rest.a, kLeastRadius_px), rest.b, {rest.c, rest.d}, colour};
}
/// The pixel itself.
inline Tap centre_at(const GatherRow& row, int x) {
  return tap_of(row, min(iota(x), Int(row.width - 1)) * Int(row.record_floats), Float(0.0F) <= 0.0F);
}
/// The nearest pixel to a place; not usable outside the image, nor where GatherSource excludes a pixel.
inline Tap tap_at(const GatherRow& row, int x, Vector offset) {
  const Int sx = iota(x) + to_int(round(offset.x)), sy = Int(row.y) + to_int(round(offset.y));
  const Int cx = clamp(sx, 0, row.width - 1), cy = clamp(sy, 0, row.height - 1);
  return tap_of(row, (cy - Int(row.y)) * Int(row.stride) + cx * Int(row.record_floats), (sx == cx) & (sy == cy));
}

/// What one group of pixels has gathered so far. Colours are summed as differences from the centre's: where they agree
/// the result is the centre's value to the bit (an alpha of 1 stays 1).
struct Gathered {
  Quad centre, difference;
  Float weight;
};
inline Gathered gathered(const Tap& centre, Float weight) { return {centre.colour, {0.0F, 0.0F, 0.0F, 0.0F}, weight}; }
inline void add(const Tap& tap, Float weight, Gathered& sum) {
  sum.weight += select(tap.usable, weight, 0.0F);
  const auto add_one = [&](Float value, Float centre, Float& difference) {
    difference += select(tap.usable, weight * (value - centre), 0.0F);
  };
  add_one(tap.colour.a, sum.centre.a, sum.difference.a);
  add_one(tap.colour.b, sum.centre.b, sum.difference.b);
  add_one(tap.colour.c, sum.centre.c, sum.difference.c);
  add_one(tap.colour.d, sum.centre.d, sum.difference.d);
}
inline void store_mean(const GatherRow& row, const Gathered& sum, Mask where, int x) {
  const auto store_one = [&](int c, Float centre, Float difference) {
    if (c >= row.channels) return;
    float* to = row.target[c] + x;
    store(to, select(where, centre + difference / sum.weight, load(to)));
  };
  store_one(0, sum.centre.a, sum.difference.a);
  store_one(1, sum.centre.b, sum.difference.b);
  store_one(2, sum.centre.c, sum.difference.c);
  store_one(3, sum.centre.d, sum.difference.d);
}

/// Calls `blur(row, columns)` for the moving part of all rows, over threads, for four channels at a time: channels[i]
/// becomes what it makes of the source's.
template <class Blur>
void gather_rows(const GatherSource& source, const MovingTiles& tiles, std::span<Plane* const> channels,
                 const Blur& blur) {
  constexpr auto kGroup = static_cast<size_t>(GatherRecord::kChannels);
  for (size_t group = 0; group < source.records.size(); ++group) {
    const size_t first = group * kGroup, count = std::min(kGroup, channels.size() - first);
    const Plane& records = source.records[group];
    for_rows(source.height, [&](int y) {
      const Columns columns = tiles.blurred(y);
      if (columns.empty()) return;
      GatherRow row{
          source.width,   source.height,           y, static_cast<int>(records.view().stride), source.record_floats,
          records.row(y), static_cast<int>(count), {}};
      for (size_t c = 0; c < count; ++c) row.target[c] = channels[first + c]->row(y);
      blur(row, columns);
    });
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
