#include "core/temporal/history_use.h"

#include <algorithm>
#include <cmath>

#include "core/parallel/rows.h"

namespace aftershade::temporal {

namespace {

bool is_surface(float depth) { return std::isfinite(depth) && depth > 0; }

template <class UseAt>
Plane each_pixel(int width, int height, const UseAt& use_at) {
  Plane out(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) out(x, y) = code_of(use_at(x, y));
  });
  return out;
}

/// Kernel fetch_history() of temporal_kernel.h for one pixel: do the taps that see the surface weigh a quarter?
/// `same(i, j)`: does the stored pixel (i, j), inside, show it?
template <class Same>
bool found_around(double left, double top, float share_x, float share_y, int width, int height, const Same& same) {
  float sum = 0;
  for (const int j : {0, 1})
    for (const int i : {0, 1}) {
      const double x = left + i, y = top + j;
      if (!(x >= 0 && x < width && y >= 0 && y < height)) continue;
      if (same(static_cast<int>(x), static_cast<int>(y)))
        sum += (i == 1 ? share_x : 1.0F - share_x) * (j == 1 ? share_y : 1.0F - share_y);
    }
  return sum >= 0.25F;
}

HistoryUse use_of(const StoredHistory& stored, float x, float y, float compared) {
  if (stored.depth.empty()) return HistoryUse::none;
  if (!std::isfinite(x) || !std::isfinite(y) || std::isnan(compared)) return HistoryUse::unknown_motion;
  const Window& window = stored.window;
  const auto same = [&](int i, int j) {
    const float z = stored.depth(i, j);
    return std::abs(z - compared) < stored.epsilon * z;
  };
  const double near_x = std::floor(static_cast<double>(x)) - window.min_x,
               near_y = std::floor(static_cast<double>(y)) - window.min_y;
  const bool inside = near_x >= 0 && near_x < window.width() && near_y >= 0 && near_y < window.height();
  const float u = x - 0.5F, v = y - 0.5F, left = std::floor(u), top = std::floor(v);
  const bool found =
      stored.nearest ? inside && same(static_cast<int>(near_x), static_cast<int>(near_y))
                     : found_around(static_cast<double>(left) - window.min_x, static_cast<double>(top) - window.min_y,
                                    u - left, v - top, window.width(), window.height(), same);
  if (found) return HistoryUse::used;
  return inside ? HistoryUse::other_surface : HistoryUse::outside;
}

struct Vector {
  float x, y, z;
};
Vector at(const std::array<Plane, 3>& planes, int x, int y) {
  return {planes[0](x, y), planes[1](x, y), planes[2](x, y)};
}
float dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// What fetch() of temporal_blur_kernel.h asks, for one texel.
struct TexelLookUp {
  const TemporalBlurParams& params;
  const TemporalBlurHistory& before;
  int step;

  /// `p`: the pixel the texel stands for, `block`: the first of its block; window indices.
  HistoryUse use_of(const Reprojected& past, int px, int py, int block_x, int block_y, float z, float fx) const {
    const float x = past.x(px, py), y = past.y(px, py), expected = past.depth(px, py);
    if (!std::isfinite(x) || !std::isfinite(y) || std::isnan(expected)) return HistoryUse::unknown_motion;
    const auto texel = [&](float at, int pixel, int block) {
      return (at - 0.5F - static_cast<float>(pixel - block)) / static_cast<float>(step);
    };
    const float u = texel(x, px, block_x), v = texel(y, py, block_y), left = std::floor(u), top = std::floor(v);
    const Projection& lens = before.projection;
    const float scale = lens.orthographic ? 1.0F : expected;
    const Vector point{(x - lens.cx) / lens.fx * scale, -(y - lens.cy) / lens.fy * scale, expected};
    const float footprint = params.cut_footprints * static_cast<float>(step) / fx * (lens.orthographic ? 1.0F : z);
    const float limit = std::max(params.near_m, params.far_m) * std::max(1.0F, footprint / params.cut_m);
    const auto same = [&](int i, int j) { return distance(point, i, j) <= limit; };
    const double first_x = static_cast<double>(left) - before.texel_x,
                 first_y = static_cast<double>(top) - before.texel_y;
    const int width = before.value.width(), height = before.value.height();
    if (found_around(first_x, first_y, u - left, v - top, width, height, same)) return HistoryUse::used;
    const double near_x = first_x + (u - left >= 0.5F ? 1 : 0), near_y = first_y + (v - top >= 0.5F ? 1 : 0);
    const bool inside = near_x >= 0 && near_x < width && near_y >= 0 && near_y < height;
    return inside ? HistoryUse::other_surface : HistoryUse::outside;
  }

  /// From `point` to the surface seen at a texel.
  float distance(Vector point, int i, int j) const {
    const Vector seen = at(before.texels.point, i, j), normal = at(before.texels.normal, i, j);
    const Vector v{point.x - seen.x, point.y - seen.y, point.z - seen.z};
    if (params.literal)
      return std::abs(v.z) * (before.projection.orthographic ? 1.0F : std::sqrt(dot(point, point)) / point.z);
    return std::abs(dot(normal, normal) > 0 ? dot(v, normal) : v.z);
  }
};

}  // namespace

Plane history_use(ConstPlaneView depth, const Reprojected& past, ConstPlaneView compared, const StoredHistory& stored) {
  return each_pixel(depth.width, depth.height, [&](int x, int y) {
    if (!is_surface(depth(x, y))) return HistoryUse::background;
    return use_of(stored, past.x(x, y), past.y(x, y), compared(x, y));
  });
}

Plane history_use(const TemporalBlurParams& params, const filter::SampleGrid& grid, const filter::Surface& surface,
                  const Reprojected& past, const TemporalBlurHistory& before) {
  const TexelLookUp look_up{params, before, grid.step};
  const bool known = before.step == grid.step && !before.value.empty();
  const float fx = std::min(surface.projection.fx, surface.projection.fy);
  return each_pixel(grid.width(), grid.height(), [&](int x, int y) {
    const float z = grid.depth(x, y);
    if (!is_surface(z)) return HistoryUse::background;
    if (!known) return HistoryUse::none;
    const bool every_pixel = grid.step == 1;
    const int px = every_pixel ? x : static_cast<int>(grid.pixel_x(x, y)),
              py = every_pixel ? y : static_cast<int>(grid.pixel_y(x, y));
    return look_up.use_of(past, px, py, x * grid.step + grid.origin_x, y * grid.step + grid.origin_y, z, fx);
  });
}

void mark(Plane& use, HistoryUse reason, const std::function<bool(int x, int y)>& where) {
  for_rows(use.height(), [&](int y) {
    for (int x = 0; x < use.width(); ++x)
      if (use(x, y) != code_of(HistoryUse::background) && where(x, y)) use(x, y) = code_of(reason);
  });
}

}  // namespace aftershade::temporal
