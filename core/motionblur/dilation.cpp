#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/dilation.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/dilation.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/motionblur/dilation_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

/// The velocities that cross the tile at an offset from their own.
HalfVelocity crossing(const HalfVelocity& velocity, int tile, Window window, int ox, int oy) {
  const TileGrid grid(tile, window);
  const int width = window.width(), height = window.height();
  const auto inside = [&](int absolute) { return static_cast<float>((absolute % tile + tile) % tile) + 0.5F; };
  Plane inside_x(width, 1);
  for (int x = 0; x < width; ++x) inside_x(x, 0) = inside(window.min_x + x);
  HalfVelocity out{Plane(width, height), Plane(width, height)};
  for_rows(height, [&](int y) {
    const CrossingRow row{inside_x.row(0), inside(window.min_y + y), static_cast<float>(tile), static_cast<float>(ox),
                          static_cast<float>(oy)};
    crossing_row(row, velocity.x.row(y), velocity.y.row(y), width, out.x.row(y), out.y.row(y));
  });
  return out;
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

namespace {

HWY_EXPORT(crossing);

/// The neighbours in reading order; [4] is the tile itself.
constexpr int kAround = 9;
constexpr int offset_x(int i) { return i % 3 - 1; }
constexpr int offset_y(int i) { return i / 3 - 1; }

int sign(float v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

/// Does a velocity point along the offset, in either sense?
bool along(float vx, float vy, int ox, int oy) {
  const int x = sign(vx) * ox, y = sign(vy) * oy;
  return std::abs(x + y) == std::abs(ox) + std::abs(oy);
}

/// Longest of up to nine planes of candidates: candidate(i, column, row) is what the tile at offset i offers, {x, y}.
template <class Candidate>
HalfVelocity longest_of(int columns, int rows, const Candidate& candidate) {
  HalfVelocity out{Plane(columns, rows), Plane(columns, rows)};
  constexpr int order[kAround] = {4, 0, 1, 2, 3, 5, 6, 7, 8};
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      float longest = 0;
      for (const int i : order) {
        const int x = column + offset_x(i), y = row + offset_y(i);
        if (x < 0 || y < 0 || x >= columns || y >= rows) continue;
        const auto [vx, vy] = candidate(i, x, y);
        if (!(vx * vx + vy * vy > longest)) continue;
        longest = vx * vx + vy * vy;
        out.x(column, row) = vx;
        out.y(column, row) = vy;
      }
    }
  return out;
}

HalfVelocity line_max(const HalfVelocity& velocity, const HalfVelocity& tiles, int tile, Window window) {
  std::array<HalfVelocity, kAround> toward;  ///< [i]: of what lies at offset i from the tile that it crosses
  for (int i = 0; i < kAround; ++i)
    toward[static_cast<size_t>(i)] =
        i == 4 ? HalfVelocity{copy_of(tiles.x), copy_of(tiles.y)}
               : tile_max(HWY_DYNAMIC_DISPATCH(crossing)(velocity, tile, window, -offset_x(i), -offset_y(i)), tile,
                          window);
  return longest_of(tiles.x.width(), tiles.x.height(), [&](int i, int x, int y) {
    const HalfVelocity& from = toward[static_cast<size_t>(i)];
    return std::pair{from.x(x, y), from.y(x, y)};
  });
}

}  // namespace

HalfVelocity dilated(Dilation rule, const HalfVelocity& velocity, const HalfVelocity& tiles, int tile, Window window) {
  if (rule == Dilation::square) return neighbour_max(tiles);
  if (rule == Dilation::line) return line_max(velocity, tiles, tile, window);
  return longest_of(tiles.x.width(), tiles.x.height(), [&](int i, int x, int y) {
    const std::pair v{tiles.x(x, y), tiles.y(x, y)};
    return along(v.first, v.second, offset_x(i), offset_y(i)) ? v : std::pair{0.0F, 0.0F};
  });
}

}  // namespace aftershade::motionblur
#endif
