#include "core/temporal/reprojection.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/parallel/rows.h"
#include "core/temporal/reprojection_kernel.h"

namespace aftershade::temporal {

namespace {

bool is_surface(float depth) { return std::isfinite(depth) && depth > 0; }

}  // namespace

Reprojection::Reprojection(const ReprojectionInput& input, ReprojectionSource source, float agreement_px)
    : input_(input),
      vectors_(source == ReprojectionSource::automatic && !input.mv_prev_x.empty() && !input.mv_prev_y.empty()),
      agreement_px_(agreement_px) {}

void Reprojection::row(int y, const float* not_needed, float* x, float* y_before, float* depth) const {
  const double centre_y = input_.window.min_y + y + 0.5;
  ReprojectionRow row{};
  row.depth = input_.depth.row(y);
  if (vectors_) row.mv_x = input_.mv_prev_x.row(y), row.mv_y = input_.mv_prev_y.row(y);
  row.not_needed = not_needed;
  row.camera = input_.camera.has_value();
  if (row.camera) row.motion = filter::static_motion(*input_.camera, centre_y);
  row.holes_are_invalid = input_.holes_are_invalid;
  row.agreement_px = agreement_px_;
  row.width = input_.depth.width;
  row.min_x = input_.window.min_x;
  row.centre_y = static_cast<float>(centre_y);
  row.out_x = x, row.out_y = y_before, row.out_z = depth;
  reprojection_row(row);
}

Reprojected reproject(const ReprojectionInput& input, ReprojectionSource source, float agreement_px) {
  const int width = input.depth.width, height = input.depth.height;
  const Reprojection reprojection(input, source, agreement_px);
  Reprojected out{Plane(width, height), Plane(width, height), Plane(width, height)};
  for_rows(height, [&](int y) { reprojection.row(y, nullptr, out.x.row(y), out.y.row(y), out.depth.row(y)); });
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

namespace {

/// Surface pixels of a row, and those of them without a past.
struct Share {
  int64_t surface = 0, lost = 0;
};

Share row_without_history(const float* depth, int width, const float* x, const float* y, const float* expected,
                          ConstPlaneView stored_depth, const Window& w) {
  constexpr float kOtherDepth = 0.1F;
  Share share;
  for (int i = 0; i < width; ++i) {
    if (!is_surface(depth[i])) continue;
    ++share.surface;
    const float px = std::floor(x[i]), py = std::floor(y[i]);
    const bool inside = px >= static_cast<float>(w.min_x) && px <= static_cast<float>(w.max_x) &&
                        py >= static_cast<float>(w.min_y) && py <= static_cast<float>(w.max_y);
    const float stored = inside ? stored_depth(static_cast<int>(px) - w.min_x, static_cast<int>(py) - w.min_y) : 0;
    const bool same = stored > 0 && std::abs(1 - expected[i] / stored) < kOtherDepth;
    share.lost += same ? 0 : 1;
  }
  return share;
}

double total_share(const std::vector<Share>& rows) {
  Share total;
  for (const Share& row : rows) total.surface += row.surface, total.lost += row.lost;
  return total.surface > 0 ? static_cast<double>(total.lost) / static_cast<double>(total.surface) : 0;
}

}  // namespace

double share_without_history(ConstPlaneView depth, const Reprojected& reprojected, ConstPlaneView stored_depth,
                             Window stored_window) {
  if (stored_depth.empty()) return 0;
  std::vector<Share> shares(static_cast<size_t>(depth.height));
  for_rows(depth.height, [&](int y) {
    shares[static_cast<size_t>(y)] =
        row_without_history(depth.row(y), depth.width, reprojected.x.row(y), reprojected.y.row(y),
                            reprojected.depth.row(y), stored_depth, stored_window);
  });
  return total_share(shares);
}

double share_without_history(ConstPlaneView depth, Window window, const Reprojection& reprojection,
                             ConstPlaneView stored_depth, Window stored_window) {
  constexpr int kLowWindow = 64, kEvery = 8;
  if (stored_depth.empty()) return 0;
  const int every = depth.height < kLowWindow ? 1 : kEvery, first = (window.min_y % every + every) % every;
  std::vector<Share> shares(static_cast<size_t>(depth.height));
  for_rows((depth.height + every - 1) / every, [&](int index) {
    const int y = (every - first) % every + index * every;
    if (y >= depth.height) return;
    Plane past(depth.width, 3);
    reprojection.row(y, nullptr, past.row(0), past.row(1), past.row(2));
    shares[static_cast<size_t>(y)] = row_without_history(depth.row(y), depth.width, past.row(0), past.row(1),
                                                         past.row(2), stored_depth, stored_window);
  });
  return total_share(shares);
}

}  // namespace aftershade::temporal
