// The motions of one tile's pixels that differ most.
#if defined(AFTERSHADE_CORE_MOTIONBLUR_GATHER_PLUS_TILES_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_GATHER_PLUS_TILES_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_GATHER_PLUS_TILES_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_GATHER_PLUS_TILES_KERNEL_H
#endif
#include <algorithm>

#include "core/motionblur/gather_plus_tiles.h"
#include "core/simd/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;

/// Where a surface is at a time, from its pixel.
struct Place {
  Float x, y;
};
inline Place place_at(Path path, const float* px, const float* py, const float* nx, const float* ny, float t) {
  const auto coordinate = [&](Float prev, Float next) {
    if (path == Path::separate) return t * (t < 0 ? -prev : next) + t * t * Float(0.0F);
    const Float bend = path == Path::curved ? 0.5F * (next + prev) : Float(0.0F);
    return t * (0.5F * (next - prev)) + t * t * bend;
  };
  return {coordinate(load(px), load(nx)), coordinate(load(py), load(ny))};
}
inline Float distance(Place a, Place b) { return sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); }

/// The motions of a tile's pixels, row after row, as tiles compare them: where they are when the shutter opens and
/// closes.
struct TilePool {
  static constexpr int kRoom = kTile_px * kTile_px + 16;
  float opens_x[kRoom], opens_y[kRoom], closes_x[kRoom], closes_y[kRoom];
  float length[kRoom];   ///< of the way between, through the frame's own time where that is within
  float nearest[kRoom];  ///< to the motions that were taken
  int size = 0;

  /// Adds `count` pixels of a row, from column x on.
  void add(const Motion& m, Path path, Shutter shutter, int x, int y, int count) {
    const float middle_time = std::clamp(0.0F, shutter.opens, shutter.closes);
    for (int i = 0; i < count; i += kLanes) {
      const auto at = [&](float t) {
        return place_at(path, m.prev_x.row(y) + x + i, m.prev_y.row(y) + x + i, m.next_x.row(y) + x + i,
                        m.next_y.row(y) + x + i, t);
      };
      const Place opens = at(shutter.opens), closes = at(shutter.closes), middle = at(middle_time);
      const int to = size + i;
      store(opens_x + to, opens.x), store(opens_y + to, opens.y);
      store(closes_x + to, closes.x), store(closes_y + to, closes.y);
      store(length + to, distance(opens, middle) + distance(middle, closes));
    }
    size += count;
  }

  /// The first of the greatest of `values`, none if that is not above `least`.
  int first_greatest(const float* values, float least) const {
    Float most = least;
    for (int i = 0; i < size; i += kLanes) most = max(select(iota(i) < Int(size), load(values + i), least), most);
    float lanes[kLanes];
    store(lanes, most);
    const float greatest = *std::max_element(lanes, lanes + kLanes);
    return greatest > least ? static_cast<int>(std::find(values, values + size, greatest) - values) : -1;
  }

  /// Takes account of motion `taken`.
  void lower_nearest(int taken) {
    for (int i = 0; i < size; i += kLanes) {
      const auto off = [&](const float* values) { return abs(load(values + i) - values[taken]); };
      const Float here = max(max(off(opens_x), off(opens_y)), max(off(closes_x), off(closes_y)));
      store(nearest + i, min(load(nearest + i), here));
    }
  }
};

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
