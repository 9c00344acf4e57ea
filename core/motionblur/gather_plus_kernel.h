#pragma once
#include "core/math/sampling.h"
#include "core/motionblur/gather_plus_tiles.h"
#include "core/simd/math.h"

/// The layered gather, one row; see gather_plus.h for the method.
namespace aftershade::motionblur {

/// What is read of every pixel, side by side: its path, its depth, and whether it may be read.
inline constexpr int kRecordFloats = 8, kRecordDepth = 6, kRecordUsable = 7;

struct GatherPlusKernel {
  static constexpr int kChannels = 4;
  int width, height;
  int origin_x, origin_y;  ///< absolute coordinates of pixel (0, 0): tiles and jitter are tied to them
  int record_stride;       ///< floats from row to row of the records
  const float* records;
  int channel_stride;
  int channels;  ///< 1 to kChannels
  const float* source[kChannels];
  const TileMotions* tiles;
  float opens, exposure;  ///< frames
  float taps_per_px;
  int least_taps, most_taps;
};

namespace detail {
using namespace lanes;

/// Half a pixel is a pixel's own extent, but for rounding.
inline constexpr float kCovers_px = 0.505F;
/// Where nothing covers, the farthest of the pixels this near goes on: surfaces that grow or turn leave gaps between
/// their pixels, and where two part, what shows is the one behind.
inline constexpr float kNearlyCovers_px = 0.58F;
/// A surface whose exposure is shorter stays as it is.
inline constexpr float kLeastWay_px = 0.5F;
/// Places looked at along one motion: its own, then along the paths of what is there.
inline constexpr int kPlaces = 3;

struct Offset {
  Float x, y;
};
inline Offset displaced(const float* path, Int at, Float t) {
  const Int side = select(t < 0.0F, at, at + Int(2));
  const Float t2 = t * t;
  return {t * gather(path, side) + t2 * gather(path, at + Int(4)),
          t * gather(path, side + Int(1)) + t2 * gather(path, at + Int(5))};
}

/// What was found for one pixel at one time. Pixels are indices of the channels' planes.
struct Found {
  Int nearest, nearly, farthest;
  Float nearest_depth, nearly_depth, farthest_depth;
  Mask covered, nearly_covered, any_place, outside;
};
inline Found nothing() {
  const Mask no = Float(0.0F) > Float(0.0F);
  return {0, 0, 0, 3e38F, -1.0F, -1.0F, no, no, no, no};
}

/// From x to the pixel that a surface comes from which is displaced by d; outside the image for all that are far.
inline Offset origin_of(const GatherPlusKernel& k, Offset d) {
  const Float far = static_cast<float>(k.width + k.height);
  return {round_small(clamp(-d.x, -far, far)), round_small(clamp(-d.y, -far, far))};
}

/// Follows one motion from pixel (x, y) at time t: algorithms 3.5's "reaches the centre", in two dimensions and along
/// each pixel's own path. `o` is the first place. A place behind what covers already leads nowhere.
inline void follow(const GatherPlusKernel& k, Int x, Int y, Float t, Offset o, Mask active, Found& f) {
  for (int place = 0; place < kPlaces; ++place) {
    const Int qx = x + to_int(o.x), qy = y + to_int(o.y);
    const Mask inside = (qx >= Int(0)) & (qx < Int(k.width)) & (qy >= Int(0)) & (qy < Int(k.height));
    f.outside = f.outside | (active & !inside);
    active = active & inside;
    const Int cx = clamp(qx, 0, k.width - 1), cy = clamp(qy, 0, k.height - 1);
    const Int record = cy * Int(k.record_stride) + cx * Int(kRecordFloats);
    active = active & (gather(k.records, record + Int(kRecordUsable)) > 0.0F);
    const Int pixel = cy * Int(k.channel_stride) + cx;
    const Float depth = gather(k.records, record + Int(kRecordDepth));
    const Offset own = displaced(k.records, record, t);
    const Float off = max(abs(o.x + own.x), abs(o.y + own.y));
    const Mask covers = active & (off <= kCovers_px);
    const Mask nearer = covers & (depth < f.nearest_depth);
    f.nearest = select(nearer, pixel, f.nearest);
    f.nearest_depth = select(nearer, depth, f.nearest_depth);
    f.covered = f.covered | covers;
    const Mask better = active & (off <= kNearlyCovers_px) & (depth > f.nearly_depth);
    f.nearly = select(better, pixel, f.nearly);
    f.nearly_depth = select(better, depth, f.nearly_depth);
    f.nearly_covered = f.nearly_covered | better;
    const Mask farther = active & (depth > f.farthest_depth);
    f.farthest = select(farther, pixel, f.farthest);
    f.farthest_depth = select(farther, depth, f.farthest_depth);
    f.any_place = f.any_place | active;
    active = active & !covers & (depth < f.nearest_depth);
    if (!any(active)) break;
    o = origin_of(k, own);
  }
}

/// What pixel (x, y) shows at time t: an index, and whether the time counts.
struct Seen {
  Int pixel;
  Mask counts;
};
inline Seen seen_at(const GatherPlusKernel& k, Int x, int y, Int tile, Float count, Float t, Mask active) {
  Found f = nothing();
  const Int own = Int(y * k.record_stride) + min(x, Int(k.width - 1)) * Int(kRecordFloats);
  const Offset first = origin_of(k, displaced(k.records, own, t));
  follow(k, x, Int(y), t, first, active, f);
  for (int i = 0; i < k.tiles->motions; ++i) {
    const Mask used = active & (Float(static_cast<float>(i)) < count);
    if (!any(used)) break;
    const Int path = (tile * Int(k.tiles->motions) + Int(i)) * Int(kPathFloats);
    const Offset o = origin_of(k, displaced(k.tiles->paths.data(), path, t));
    const Mask elsewhere = used & !((o.x == first.x) & (o.y == first.y));
    if (any(elsewhere)) follow(k, x, Int(y), t, o, elsewhere, f);
  }
  const Mask covered = f.covered | f.nearly_covered, uncovered = f.any_place & !f.outside;
  return {select(f.covered, f.nearest, select(f.nearly_covered, f.nearly, f.farthest)), active & (covered | uncovered)};
}

/// In (0, 1): shifts the times from pixel to pixel.
inline Float jitter_at(const GatherPlusKernel& k, Int x, int y) {
  const Int column = (x + Int(k.origin_x)) & Int(3), row = Int((y + k.origin_y) & 3);
  return gather(kBayer4x4.data(), (row << 2) + column);
}

}  // namespace detail

/// Blurs row y into `target`, one row a channel, which holds the source's values.
inline void gather_plus_row(const GatherPlusKernel& k, int y, float* const* target) {
  using namespace detail;
  const int tile_row = ((y + k.origin_y) >> kTileShift) - k.tiles->first_row;
  for (int first = 0; first < k.width; first += kLanes) {
    const Int x = iota(first), inside = min(x, Int(k.width - 1));
    const Int tile =
        Int(tile_row * k.tiles->columns) + ((inside + Int(k.origin_x)) >> kTileShift) - Int(k.tiles->first_column);
    const Float way = gather(k.tiles->longest_px.data(), tile);
    const Int own = Int(y * k.record_stride) + inside * Int(kRecordFloats);
    const Mask moves = (way >= kLeastWay_px) & (gather(k.records, own + Int(kRecordUsable)) > 0.0F);
    if (!any(moves)) continue;
    // algorithms 3.6: taps in proportion to the search
    const Float taps =
        clamp(-floor(-(way * k.taps_per_px)), static_cast<float>(k.least_taps), static_cast<float>(k.most_taps));
    const Float count = gather(k.tiles->counts.data(), tile), jitter = jitter_at(k, x, y);
    const Float step = k.exposure / taps;
    Float weight = 0.0F, centre[GatherPlusKernel::kChannels], sum[GatherPlusKernel::kChannels];
    for (int c = 0; c < k.channels; ++c) {
      centre[c] = gather(k.source[c], Int(y * k.channel_stride) + inside);
      sum[c] = 0.0F;
    }
    for (int i = 0; i < k.most_taps; ++i) {
      const Mask active = moves & (Float(static_cast<float>(i)) < taps);
      if (!any(active)) break;
      const Float t = k.opens + (Float(static_cast<float>(i)) + jitter) * step;
      const Seen seen = seen_at(k, x, y, tile, count, t, active);
      weight += select(seen.counts, Float(1.0F), Float(0.0F));
      for (int c = 0; c < k.channels; ++c)
        sum[c] += select(seen.counts, gather(k.source[c], seen.pixel) - centre[c], 0.0F);
    }
    const Mask blurred = moves & (weight > 0.0F);
    for (int c = 0; c < k.channels; ++c)
      store(target[c] + first, select(blurred, centre[c] + sum[c] / max(weight, 1.0F), load(target[c] + first)));
  }
}

}  // namespace aftershade::motionblur
