#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/image/plane.h"
#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "core/temporal/reprojection.h"

namespace aftershade::tests {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInf = std::numeric_limits<float>::infinity();

inline Plane plane_of(int width, int height, const std::function<float(int, int)>& value) {
  Plane out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) out(x, y) = value(x, y);
  return out;
}

/// Uniform in [0, 1): noise that depends on the counters alone.
inline float noise(int x, int y, int frame = 0, int index = 0) {
  return unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(frame),
                                  static_cast<uint32_t>(index)));
}

/// Number of pixels whose bits differ (a NaN equals itself).
inline int different_pixels(ConstPlaneView a, ConstPlaneView b) {
  if (a.width != b.width || a.height != b.height) return -1;
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      count += std::bit_cast<uint32_t>(a(x, y)) != std::bit_cast<uint32_t>(b(x, y)) ? 1 : 0;
  return count;
}

inline Window window_of(int width, int height, int min_x = 0, int min_y = 0) {
  return {min_x, min_y, min_x + width - 1, min_y + height - 1};
}

/// Every pixel of `depth` as a grid, built by hand.
inline filter::SampleGrid hand_grid(ConstPlaneView depth) {
  filter::SampleGrid grid;
  grid.depth = copy_of(depth);
  return grid;
}

/// One pixel of every 2x2 block, which one at random; origin 0 or -1 as for a window at odd coordinates.
inline filter::SampleGrid hand_half_grid(ConstPlaneView depth, int origin_x, int origin_y) {
  filter::SampleGrid grid;
  grid.step = 2;
  grid.origin_x = origin_x;
  grid.origin_y = origin_y;
  const int width = (depth.width - origin_x + 1) / 2, height = (depth.height - origin_y + 1) / 2;
  const auto pick = [](int texel, int origin, int size, float random) {
    return std::clamp(2 * texel + origin + (random < 0.5F ? 0 : 1), 0, size - 1);
  };
  grid.pixel_x = plane_of(width, height, [&](int x, int y) {
    return static_cast<float>(pick(x, origin_x, depth.width, noise(x, y, 0, 91)));
  });
  grid.pixel_y = plane_of(width, height, [&](int x, int y) {
    return static_cast<float>(pick(y, origin_y, depth.height, noise(x, y, 0, 92)));
  });
  grid.depth = plane_of(width, height, [&](int x, int y) {
    return depth(static_cast<int>(grid.pixel_x(x, y)), static_cast<int>(grid.pixel_y(x, y)));
  });
  return grid;
}

inline filter::Surface surface_of(ConstPlaneView depth, Projection projection) {
  filter::Surface surface;
  surface.depth = depth;
  surface.projection = projection;
  surface.display_height = depth.height;
  return surface;
}

/// What reproject() gives for a still camera.
inline temporal::Reprojected standing_still(ConstPlaneView depth, Window window) {
  const auto known = [&](int x, int y, double value) {
    return std::isfinite(depth(x, y)) && depth(x, y) > 0 ? static_cast<float>(value) : kNaN;
  };
  return {plane_of(depth.width, depth.height, [&](int x, int y) { return known(x, y, window.min_x + x + 0.5); }),
          plane_of(depth.width, depth.height, [&](int x, int y) { return known(x, y, window.min_y + y + 0.5); }),
          plane_of(depth.width, depth.height, [&](int x, int y) { return known(x, y, depth(x, y)); })};
}

/// Limits the threads for one scope.
struct ThreadLimit {
  explicit ThreadLimit(int threads) { set_thread_count(threads); }
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  ~ThreadLimit() { set_thread_count(0); }
};

}  // namespace aftershade::tests
