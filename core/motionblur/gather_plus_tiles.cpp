#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/gather_plus_tiles.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/gather_plus_tiles.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>

#include "core/motionblur/gather_plus_tiles_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

/// The longest motion of some pixels, then always the one farthest from those that were taken, up to `most`; of equal
/// ones the first. Numbers in reading order.
std::vector<int> most_different_pixels(const Motion& motion, Path path, Shutter shutter, const Window& pixels,
                                       int most) {
  TilePool pool;
  for (int y = pixels.min_y; y <= pixels.max_y; ++y) pool.add(motion, path, shutter, pixels.min_x, y, pixels.width());
  std::fill(pool.nearest, pool.nearest + TilePool::kRoom, INFINITY);
  std::vector<int> taken{std::max(pool.first_greatest(pool.length, 0), 0)};
  while (static_cast<int>(taken.size()) < most) {
    pool.lower_nearest(taken.back());
    const int next = pool.first_greatest(pool.nearest, kDistinct_px);
    if (next < 0) break;
    taken.push_back(next);
  }
  return taken;
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

namespace {

HWY_EXPORT(most_different_pixels);

struct Vec {
  float x, y;
};

Vec displaced(const PathCoefficients& path, float t) {
  const float x = t < 0 ? path.before_x : path.after_x, y = t < 0 ? path.before_y : path.after_y;
  return {t * x + t * t * path.bend_x, t * y + t * t * path.bend_y};
}

float distance(Vec a, Vec b) { return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)); }

/// A motion as tiles compare it: where it is when the shutter opens and closes.
struct Candidate {
  PathCoefficients path;
  Vec opens, closes;
  float length;  ///< of the way between, through the frame's own time where that is within
};

Candidate candidate_of(const PathCoefficients& path, Shutter shutter) {
  const Vec opens = displaced(path, shutter.opens), closes = displaced(path, shutter.closes);
  const Vec middle = displaced(path, std::clamp(0.0F, shutter.opens, shutter.closes));
  const auto between = [](Vec a, Vec b) { return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y)); };
  return {path, opens, closes, between(opens, middle) + between(middle, closes)};
}

/// The longest, then always the one farthest from those that were taken, up to `most`; of equal ones the first.
std::vector<Candidate> most_different(const std::vector<Candidate>& pool, int most) {
  std::vector<Candidate> taken;
  if (pool.empty()) return taken;
  taken.push_back(*std::max_element(pool.begin(), pool.end(),
                                    [](const Candidate& a, const Candidate& b) { return a.length < b.length; }));
  std::vector<float> nearest(pool.size(), INFINITY);
  while (static_cast<int>(taken.size()) < most) {
    float farthest = kDistinct_px;
    const Candidate* next = nullptr;
    for (size_t i = 0; i < pool.size(); ++i) {
      const float here =
          std::max(distance(pool[i].opens, taken.back().opens), distance(pool[i].closes, taken.back().closes));
      nearest[i] = std::min(nearest[i], here);
      if (nearest[i] > farthest) farthest = nearest[i], next = &pool[i];
    }
    if (next == nullptr) break;
    taken.push_back(*next);
  }
  return taken;
}

int tile_of(int pixel) { return pixel >> kTileShift; }

class Tiles {
 public:
  Tiles(const Motion& motion, Path path, Shutter shutter, Window window, int motions)
      : motion_(motion), path_(path), shutter_(shutter), window_(window), motions_(motions) {
    out_.first_column = tile_of(window.min_x);
    out_.first_row = tile_of(window.min_y);
    out_.columns = tile_of(window.max_x) - out_.first_column + 1;
    out_.rows = tile_of(window.max_y) - out_.first_row + 1;
    out_.motions = motions;
  }

  TileMotions all() {
    const size_t count = static_cast<size_t>(out_.columns) * static_cast<size_t>(out_.rows);
    std::vector<std::vector<Candidate>> own(count), reaching(count);
    for_rows(out_.rows, [&](int row) {
      for (int column = 0; column < out_.columns; ++column) own[index(column, row)] = motions_in(column, row);
    });
    for (int row = 0; row < out_.rows; ++row)
      for (int column = 0; column < out_.columns; ++column)
        for (const Candidate& c : own[index(column, row)]) spread(c, column, row, reaching);
    out_.paths.resize(count * static_cast<size_t>(motions_ * kPathFloats));
    out_.counts.resize(count);
    out_.longest_px.resize(count);
    for_rows(out_.rows, [&](int row) {
      for (int column = 0; column < out_.columns; ++column) store(reaching[index(column, row)], index(column, row));
    });
    return std::move(out_);
  }

 private:
  size_t index(int column, int row) const { return static_cast<size_t>(row * out_.columns + column); }

  /// Of a tile's own pixels.
  std::vector<Candidate> motions_in(int column, int row) const {
    const int left = ((out_.first_column + column) << kTileShift) - window_.min_x;
    const int top = ((out_.first_row + row) << kTileShift) - window_.min_y;
    const Window pixels = intersection({left, top, left + kTile_px - 1, top + kTile_px - 1},
                                       {0, 0, window_.width() - 1, window_.height() - 1});
    std::vector<Candidate> taken;
    for (const int i : HWY_DYNAMIC_DISPATCH(most_different_pixels)(motion_, path_, shutter_, pixels, motions_)) {
      const int x = pixels.min_x + i % pixels.width(), y = pixels.min_y + i / pixels.width();
      taken.push_back(candidate_of(path_coefficients(motion_, path_, x, y), shutter_));
    }
    return taken;
  }

  /// Adds a motion of one tile to all tiles that it touches on its way: steps of a quarter tile, and as much margin.
  void spread(const Candidate& c, int column, int row, std::vector<std::vector<Candidate>>& reaching) const {
    constexpr float kTile = kTile_px, kMargin = 0.25F * kTile + 1, kMostSteps = 1e4F;
    const int steps = static_cast<int>(std::min(std::ceil(c.length / (0.25F * kTile)), kMostSteps)) + 1;
    std::vector<size_t> touched;
    for (int i = 0; i <= steps; ++i) {
      const float t = shutter_.opens + shutter_.length() * static_cast<float>(i) / static_cast<float>(steps);
      const Vec d = displaced(c.path, t);
      const auto range = [&](float at, float size, int most) {
        const auto tile = [&](float edge) {
          return static_cast<int>(std::clamp(std::floor(edge / kTile), -1.0F, static_cast<float>(most)));
        };
        return std::pair{std::max(tile(at - kMargin), 0), std::min(tile(at + size + kMargin), most - 1)};
      };
      const auto [x0, x1] = range(static_cast<float>(column) * kTile + d.x, kTile, out_.columns);
      const auto [y0, y1] = range(static_cast<float>(row) * kTile + d.y, kTile, out_.rows);
      for (int v = y0; v <= y1; ++v)
        for (int u = x0; u <= x1; ++u) touched.push_back(index(u, v));
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const size_t tile : touched) reaching[tile].push_back(c);
  }

  void store(const std::vector<Candidate>& reaching, size_t tile) {
    for (const Candidate& c : reaching) out_.longest_px[tile] = std::max(out_.longest_px[tile], c.length);
    const std::vector<Candidate> taken = most_different(reaching, motions_);
    out_.counts[tile] = static_cast<float>(taken.size());
    float* to = &out_.paths[tile * static_cast<size_t>(motions_ * kPathFloats)];
    for (const Candidate& c : taken)
      for (const float value :
           {c.path.before_x, c.path.before_y, c.path.after_x, c.path.after_y, c.path.bend_x, c.path.bend_y})
        *to++ = value;
  }

  const Motion& motion_;
  Path path_;
  Shutter shutter_;
  Window window_;
  int motions_;
  TileMotions out_{};
};

}  // namespace

PathCoefficients path_coefficients(const Motion& motion, Path path, int x, int y) {
  const float px = motion.prev_x(x, y), py = motion.prev_y(x, y), nx = motion.next_x(x, y), ny = motion.next_y(x, y);
  if (path == Path::separate) return {-px, -py, nx, ny, 0, 0};
  const float mx = 0.5F * (nx - px), my = 0.5F * (ny - py);
  if (path == Path::straight) return {mx, my, mx, my, 0, 0};
  return {mx, my, mx, my, 0.5F * (nx + px), 0.5F * (ny + py)};
}

TileMotions tile_motions(const Motion& motion, Path path, Shutter shutter, Window window, int motions) {
  return Tiles(motion, path, shutter, window, motions).all();
}

VelocityTiles velocity_tiles(const Motion& motion, Path path, Shutter shutter, Window window) {
  const int width = window.width(), height = window.height();
  HalfVelocity half{Plane(width, height), Plane(width, height)};
  const auto half_way = [&](float prev, float next) {
    return 0.5F * (displacement(path, prev, next, shutter.closes) - displacement(path, prev, next, shutter.opens));
  };
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      half.x(x, y) = half_way(motion.prev_x(x, y), motion.next_x(x, y));
      half.y(x, y) = half_way(motion.prev_y(x, y), motion.next_y(x, y));
    }
  });
  const TileMotions tiles = tile_motions(motion, path, shutter, window, 1);
  HalfVelocity reaching{Plane(tiles.columns, tiles.rows), Plane(tiles.columns, tiles.rows)};
  for (int row = 0; row < tiles.rows; ++row)
    for (int column = 0; column < tiles.columns; ++column) {
      const auto tile = static_cast<size_t>(row * tiles.columns + column);
      if (tiles.counts[tile] < 1) continue;
      const float* p = &tiles.paths[tile * kPathFloats];
      const auto at = [&](float t, float before, float after, float bend) {
        return t * (t < 0 ? before : after) + t * t * bend;
      };
      reaching.x(column, row) = 0.5F * (at(shutter.closes, p[0], p[2], p[4]) - at(shutter.opens, p[0], p[2], p[4]));
      reaching.y(column, row) = 0.5F * (at(shutter.closes, p[1], p[3], p[5]) - at(shutter.opens, p[1], p[3], p[5]));
    }
  return {kTile_px, tile_max(half, kTile_px, window), std::move(reaching)};
}

}  // namespace aftershade::motionblur
#endif
