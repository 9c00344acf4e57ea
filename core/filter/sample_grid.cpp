#include "core/filter/sample_grid.h"

#include <cmath>
#include <limits>

#include "core/parallel/rows.h"

namespace aftershade::filter {

namespace {

constexpr float kBackground = std::numeric_limits<float>::infinity();

float surface_depth(float z) { return std::isfinite(z) && z > 0 ? z : kBackground; }

int blocks(int origin, int size) { return size <= 0 ? 0 : ((origin + size - 1) >> 1) - (origin >> 1) + 1; }

struct Pick {
  int x = 0, y = 0;
  float depth = kBackground;
};

/// The nearest or farthest surface of the block whose first pixel is (bx, by); its first pixel inside the window where
/// there is only background.
Pick pick(ConstPlaneView depth, int bx, int by, bool nearest) {
  Pick best{std::max(bx, 0), std::max(by, 0)};
  for (int y = std::max(by, 0); y < std::min(by + 2, depth.height); ++y)
    for (int x = std::max(bx, 0); x < std::min(bx + 2, depth.width); ++x) {
      const float z = surface_depth(depth(x, y));
      const bool better = nearest ? z < best.depth : z > best.depth || best.depth == kBackground;
      if (z != kBackground && better) best = {x, y, z};
    }
  return best;
}

}  // namespace

SampleGrid full_grid(const Surface& surface) {
  SampleGrid grid;
  grid.depth = Plane(surface.depth.width, surface.depth.height, kBackground);
  for_rows(grid.height(), [&](int y) {
    for (int x = 0; x < grid.width(); ++x) grid.depth(x, y) = surface_depth(surface.depth(x, y));
  });
  return grid;
}

SampleGrid half_grid(const Surface& surface) {
  const int width = blocks(surface.origin_x, surface.depth.width),
            height = blocks(surface.origin_y, surface.depth.height);
  SampleGrid grid{2,
                  -(surface.origin_x & 1),
                  -(surface.origin_y & 1),
                  Plane(width, height, kBackground),
                  Plane(width, height),
                  Plane(width, height)};
  const int block_x = surface.origin_x >> 1, block_y = surface.origin_y >> 1;
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const bool nearest = ((block_x + x + block_y + y) & 1) == 0;
      const Pick p = pick(surface.depth, grid.origin_x + 2 * x, grid.origin_y + 2 * y, nearest);
      grid.depth(x, y) = p.depth;
      grid.pixel_x(x, y) = static_cast<float>(p.x);
      grid.pixel_y(x, y) = static_cast<float>(p.y);
    }
  });
  return grid;
}

Plane values_at_pixels(ConstPlaneView values, const SampleGrid& grid, const Surface& surface) {
  Plane out(surface.depth.width, surface.depth.height);
  for_rows(out.height(), [&](int y) {
    const float* row = values.row((y - grid.origin_y) / grid.step);
    for (int x = 0; x < out.width(); ++x) out(x, y) = row[(x - grid.origin_x) / grid.step];
  });
  return out;
}

}  // namespace aftershade::filter
