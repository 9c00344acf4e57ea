// The layered gather, one row; see gather_plus.h for the method.
#if defined(AFTERSHADE_CORE_MOTIONBLUR_GATHER_PLUS_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_GATHER_PLUS_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_GATHER_PLUS_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_GATHER_PLUS_KERNEL_H
#endif
#include <algorithm>
#include <cmath>

#include "core/math/sampling.h"
#include "core/motionblur/gather_plus_tiles.h"
#include "core/simd/math.h"
#include "core/simd/records.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// What is read of every pixel lies side by side, as PathRecord's two quads: its path, its depth, and whether it may be
/// read. So do its channels, four of them at a time.
inline constexpr int kRecordFloats = 8, kColourFloats = 4;

struct GatherPlusRow {
  int width, height, y;
  int origin_x, origin_y;            ///< absolute coordinates of pixel (0, 0): tiles and jitter are tied to them
  int record_stride, colour_stride;  ///< floats from row to row
  const float *records, *colours;    ///< of pixel (0, 0)
  const TileMotions* tiles;
  float opens, exposure;  ///< frames
  float taps_per_px;
  int least_taps, most_taps;
  int channels;      ///< 1 to 4
  float* target[4];  ///< row y of each; holds the source's values
  float* guessed;    ///< row y, where it is asked for
};

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

/// before_x, before_y, after_x, after_y; bend_x, bend_y, depth, usable.
struct PathRecord {
  Quad sides, rest;
};
inline PathRecord load_path(const float* records, Int at) {
  const auto [sides, rest] = load_long_records(records, at);
  return {sides, rest};
}
/// A tile's motion, the same for all its pixels.
inline PathRecord path_of_tile(const float* path) {
  return {{path[0], path[1], path[2], path[3]}, {path[4], path[5], 0.0F, 0.0F}};
}
inline Offset displaced(const PathRecord& path, Float t) {
  const Mask before = t < 0.0F;
  const Float t2 = t * t;
  return {t * select(before, path.sides.a, path.sides.c) + t2 * path.rest.a,
          t * select(before, path.sides.b, path.sides.d) + t2 * path.rest.b};
}

/// What was found for one pixel at one time. Pixels are indices of the colours.
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
inline Offset origin_of(const GatherPlusRow& row, Offset d) {
  const Float far = static_cast<float>(row.width + row.height);
  return {round_small(clamp(-d.x, -far, far)), round_small(clamp(-d.y, -far, far))};
}

/// Follows one motion from the pixels x, x + 1, ... at time t: algorithms 3.5's "reaches the centre", in two dimensions
/// and along each pixel's own path. `o` is the first place. A place behind what covers already leads nowhere.
inline void follow(const GatherPlusRow& row, int x, Float t, Offset o, Mask active, Found& f) {
  for (int place = 0; place < kPlaces; ++place) {
    const Int qx = iota(x) + to_int(o.x), qy = Int(row.y) + to_int(o.y);
    const Int cx = clamp(qx, 0, row.width - 1), cy = clamp(qy, 0, row.height - 1);
    const Mask inside = (qx == cx) & (qy == cy);
    f.outside = f.outside | (active & !inside);
    const PathRecord there = load_path(row.records, cy * Int(row.record_stride) + cx * Int(kRecordFloats));
    active = active & inside & (there.rest.d > 0.0F);
    const Int pixel = cy * Int(row.colour_stride) + cx * Int(kColourFloats);
    const Float depth = there.rest.c;
    const Offset own = displaced(there, t);
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
    o = origin_of(row, own);
  }
}

/// What a group of pixels of one tile sees along.
struct Ways {
  PathRecord own;
  const float* tile;  ///< kPathFloats a motion
  int motions;
};

/// What pixels see at time t: an index, and whether the time counts.
struct Seen {
  Int pixel;
  Mask counts, guessed;
};
inline Seen seen_at(const GatherPlusRow& row, int x, const Ways& ways, Float t, Mask active) {
  Found f = nothing();
  const Offset first = origin_of(row, displaced(ways.own, t));
  follow(row, x, t, first, active, f);
  for (int i = 0; i < ways.motions; ++i) {
    const Offset o = origin_of(row, displaced(path_of_tile(ways.tile + i * kPathFloats), t));
    const Mask elsewhere = active & !((o.x == first.x) & (o.y == first.y));
    if (any(elsewhere)) follow(row, x, t, o, elsewhere, f);
  }
  const Mask covered = f.covered | f.nearly_covered, uncovered = f.any_place & !f.outside;
  return {select(f.covered, f.nearest, select(f.nearly_covered, f.nearly, f.farthest)), active & (covered | uncovered),
          active & !covered & uncovered};
}

/// In (0, 1): shifts the times from pixel to pixel.
inline Float jitter_at(const GatherPlusRow& row, int x) {
  const Int column = (iota(x) + Int(row.origin_x)) & Int(3), line = Int((row.y + row.origin_y) & 3);
  return gather(kBayer4x4.data(), (line << 2) + column);
}

inline void store_blurred(const GatherPlusRow& row, int x, Mask where, const Quad& centre, const Quad& sum,
                          Float weight) {
  const auto store_one = [&](int c, Float from, Float difference) {
    if (c >= row.channels) return;
    float* to = row.target[c] + x;
    store(to, select(where, from + difference / max(weight, 1.0F), load(to)));
  };
  store_one(0, centre.a, sum.a);
  store_one(1, centre.b, sum.b);
  store_one(2, centre.c, sum.c);
  store_one(3, centre.d, sum.d);
}

/// Blurs pixels x to last - 1, at most kLanes, of one tile, which a surface reaches that moves `way_px`.
template <bool kGuessed>
void gather_plus_pixels(const GatherPlusRow& row, int x, int last, Ways ways, float way_px) {
  const Int inside = min(iota(x), Int(row.width - 1));
  ways.own = load_path(row.records, Int(row.y * row.record_stride) + inside * Int(kRecordFloats));
  const Mask moves = (iota(x) < Int(last)) & (ways.own.rest.d > 0.0F);
  if (!any(moves)) return;
  // algorithms 3.6: taps in proportion to the search
  const float taps = std::min(std::max(-std::floor(-(way_px * row.taps_per_px)), static_cast<float>(row.least_taps)),
                              static_cast<float>(row.most_taps));
  const float step = row.exposure / taps;
  const Float jitter = jitter_at(row, x);
  const Quad centre = load_records(row.colours, Int(row.y * row.colour_stride) + inside * Int(kColourFloats));
  Quad sum{0.0F, 0.0F, 0.0F, 0.0F};
  Float weight = 0.0F, guessed = 0.0F;
  for (int i = 0; static_cast<float>(i) < taps; ++i) {
    const Float t = row.opens + (Float(static_cast<float>(i)) + jitter) * step;
    const Seen seen = seen_at(row, x, ways, t, moves);
    const Quad colour = load_records(row.colours, seen.pixel);
    weight += select(seen.counts, Float(1.0F), Float(0.0F));
    if constexpr (kGuessed) guessed += select(seen.guessed, Float(1.0F), Float(0.0F));
    sum.a += select(seen.counts, colour.a - centre.a, 0.0F);
    sum.b += select(seen.counts, colour.b - centre.b, 0.0F);
    sum.c += select(seen.counts, colour.c - centre.c, 0.0F);
    sum.d += select(seen.counts, colour.d - centre.d, 0.0F);
  }
  store_blurred(row, x, moves & (weight > 0.0F), centre, sum, weight);
  if constexpr (kGuessed) store(row.guessed + x, select(moves, guessed / max(weight, 1.0F), load(row.guessed + x)));
}

/// Tile by tile, so that all pixels beside each other have the same motions to look along.
template <bool kGuessed>
void gather_plus_row(const GatherPlusRow& row) {
  const TileMotions& tiles = *row.tiles;
  const int tile_row = ((row.y + row.origin_y) >> kTileShift) - tiles.first_row;
  for (int column = 0; column < tiles.columns; ++column) {
    const auto tile = static_cast<size_t>(tile_row * tiles.columns + column);
    if (!(tiles.longest_px[tile] >= kLeastWay_px)) continue;
    const int left = ((tiles.first_column + column) << kTileShift) - row.origin_x;
    const int last = std::min(left + kTile_px, row.width);
    const Ways ways{{},
                    &tiles.paths[tile * static_cast<size_t>(tiles.motions * kPathFloats)],
                    static_cast<int>(tiles.counts[tile])};
    for (int x = std::max(left, 0); x < last; x += kLanes)
      gather_plus_pixels<kGuessed>(row, x, last, ways, tiles.longest_px[tile]);
  }
}

/// A row of PathRecord, and of four channels.
struct PathRow {
  Path path;
  const float *prev_x, *prev_y, *next_x, *next_y;
  const float* depth;  ///< null: everything at one depth
  std::span<const float* const> channels;
  int width;
  float* records;
};

/// Values from here on stand for "infinite": sums of differences of smaller ones fit a float.
inline constexpr float kFar = 1e30F;

inline void path_row(const PathRow& row) {
  for (int x = 0; x < row.width; x += kLanes) {
    const Float px = load(row.prev_x + x), py = load(row.prev_y + x), nx = load(row.next_x + x),
                ny = load(row.next_y + x);
    const Float mx = 0.5F * (nx - px), my = 0.5F * (ny - py);
    const bool separate = row.path == Path::separate, curved = row.path == Path::curved;
    const Float z = row.depth != nullptr ? load(row.depth + x) : Float(kFar);
    Float usable = 1.0F;
    for (const float* channel : row.channels) usable = select(abs(load(channel + x)) < kFar, usable, 0.0F);
    float* to = row.records + static_cast<std::ptrdiff_t>(x) * kRecordFloats;
    store_records(to, kRecordFloats,
                  {separate ? -px : mx, separate ? -py : my, separate ? nx : mx, separate ? ny : my});
    store_records(to + 4, kRecordFloats,
                  {curved ? 0.5F * (nx + px) : Float(0.0F), curved ? 0.5F * (ny + py) : Float(0.0F),
                   select((z > 0.0F) & (z < kFar), z, Float(kFar)), usable});
  }
}

/// Channels first, first + 1, ... of a row, 0 where there are none, side by side.
inline void colour_row(std::span<const float* const> channels, size_t first, int width, float* colours) {
  const auto channel = [&](size_t c, int x) {
    return first + c < channels.size() ? load(channels[first + c] + x) : Float(0.0F);
  };
  for (int x = 0; x < width; x += kLanes)
    store_records(colours + static_cast<std::ptrdiff_t>(x) * kColourFloats, kColourFloats,
                  {channel(0, x), channel(1, x), channel(2, x), channel(3, x)});
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
