#include "core/temporal/reprojection.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "core/parallel/rows.h"

namespace aftershade::temporal {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Vec3 kUnknown{kNaN, kNaN, kNaN};

bool is_surface(double depth) { return std::isfinite(depth) && depth > 0; }

/// Position and expected depth of a static surface (algorithms 7.1); unknown behind the camera before.
Vec3 static_surface(const ReprojectionInput& input, double x, double y, double z) {
  if (!input.camera) return kUnknown;
  const Vec3 before = (*input.camera)(x, y, z);
  return before.z > 0 ? before : kUnknown;
}

/// The vector decides where it is known and the camera's motion does not explain it (algorithms 7.2).
Vec3 where_it_was(const ReprojectionInput& input, double x, double y, double z, double mv_x, double mv_y,
                  double agreement_px) {
  const Vec3 before = static_surface(input, x, y, z);
  if (!std::isfinite(mv_x) || !std::isfinite(mv_y)) return input.holes_are_invalid ? kUnknown : before;
  if (!input.camera) return {x + mv_x, y + mv_y, z};
  const double off_x = before.x - x - mv_x, off_y = before.y - y - mv_y;
  if (off_x * off_x + off_y * off_y <= agreement_px * agreement_px) return before;
  return {x + mv_x, y + mv_y, before.z};
}

}  // namespace

Reprojected reproject(const ReprojectionInput& input, ReprojectionSource source, float agreement_px) {
  const int width = input.depth.width, height = input.depth.height;
  const bool vectors = source == ReprojectionSource::automatic && !input.mv_prev_x.empty() && !input.mv_prev_y.empty();
  Reprojected out{Plane(width, height), Plane(width, height), Plane(width, height)};
  for_rows(height, [&](int j) {
    const double y = input.window.min_y + j + 0.5;
    for (int i = 0; i < width; ++i) {
      const double x = input.window.min_x + i + 0.5, z = input.depth(i, j);
      const double mv_x = vectors ? input.mv_prev_x(i, j) : 0, mv_y = vectors ? input.mv_prev_y(i, j) : 0;
      const Vec3 before = !is_surface(z) ? kUnknown
                          : vectors      ? where_it_was(input, x, y, z, mv_x, mv_y, agreement_px)
                                         : static_surface(input, x, y, z);
      out.x(i, j) = static_cast<float>(before.x);
      out.y(i, j) = static_cast<float>(before.y);
      out.depth(i, j) = static_cast<float>(before.z);
    }
  });
  return out;
}

VelocityPlanes scatter_velocity(ConstPlaneView mv_next_x, ConstPlaneView mv_next_y, ConstPlaneView depth_before,
                                Window window_before, Window window_now) {
  constexpr float kHole = std::numeric_limits<float>::quiet_NaN();
  const int width = window_now.width(), height = window_now.height();
  VelocityPlanes out{Plane(width, height, kHole), Plane(width, height, kHole)};
  Plane nearest(width, height);
  // One thread, in raster order: the order is what decides ties.
  for (int j = 0; j < window_before.height(); ++j)
    for (int i = 0; i < window_before.width(); ++i) {
      const float mv_x = mv_next_x(i, j), mv_y = mv_next_y(i, j);
      const double x = std::floor(window_before.min_x + i + 0.5 + mv_x) - window_now.min_x;
      const double y = std::floor(window_before.min_y + j + 0.5 + mv_y) - window_now.min_y;
      if (!(x >= 0 && x < width && y >= 0 && y < height)) continue;  // also NaN
      const int to_x = static_cast<int>(x), to_y = static_cast<int>(y);
      const float z = is_surface(depth_before(i, j)) ? depth_before(i, j) : std::numeric_limits<float>::infinity();
      const bool hole = std::isnan(out.x(to_x, to_y));
      if (!hole && !(z < nearest(to_x, to_y))) continue;
      nearest(to_x, to_y) = z;
      out.x(to_x, to_y) = -mv_x;
      out.y(to_x, to_y) = -mv_y;
    }
  return out;
}

double share_without_history(ConstPlaneView depth, const Reprojected& reprojected, ConstPlaneView stored_depth,
                             Window stored_window) {
  constexpr float kOtherDepth = 0.1F;
  if (stored_depth.empty()) return 0;
  std::vector<int64_t> surface(static_cast<size_t>(depth.height)), lost(surface.size());
  for_rows(depth.height, [&](int y) {
    for (int x = 0; x < depth.width; ++x) {
      if (!(std::isfinite(depth(x, y)) && depth(x, y) > 0)) continue;
      ++surface[static_cast<size_t>(y)];
      const float px = std::floor(reprojected.x(x, y)), py = std::floor(reprojected.y(x, y));
      const Window& w = stored_window;
      const bool inside = px >= static_cast<float>(w.min_x) && px <= static_cast<float>(w.max_x) &&
                          py >= static_cast<float>(w.min_y) && py <= static_cast<float>(w.max_y);
      const float stored = inside ? stored_depth(static_cast<int>(px) - w.min_x, static_cast<int>(py) - w.min_y) : 0;
      const bool same = stored > 0 && std::abs(1 - reprojected.depth(x, y) / stored) < kOtherDepth;
      lost[static_cast<size_t>(y)] += same ? 0 : 1;
    }
  });
  const auto total = std::accumulate(surface.begin(), surface.end(), int64_t{0});
  const auto without = std::accumulate(lost.begin(), lost.end(), int64_t{0});
  return total > 0 ? static_cast<double>(without) / static_cast<double>(total) : 0;
}

}  // namespace aftershade::temporal
