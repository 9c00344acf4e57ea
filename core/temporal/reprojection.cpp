#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/temporal/reprojection.cpp"  // this file, compiled once a SIMD target
#include "core/temporal/reprojection.h"

#include <hwy/foreach_target.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "core/parallel/rows.h"
#include "core/temporal/history_share.h"
#include "core/temporal/reprojection_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

void past_row(const ReprojectionRow& row, const float* not_needed, float* x, float* y, float* depth) {
  reprojection_row(row, not_needed, x, y, depth);
}

void past_rows(const Reprojection& reprojection, Reprojected& out) {
  for_rows(out.x.height(), [&](int y) {
    reprojection_row(reprojection.row(y), nullptr, out.x.row(y), out.y.row(y), out.depth.row(y));
  });
}

int64_t sum_of_lanes(Float v) {
  std::array<float, kLanes> lanes;
  store(lanes.data(), v);
  return static_cast<int64_t>(std::accumulate(lanes.begin(), lanes.end(), 0.0F));
}

/// `past(x)`: of pixels x, x + 1, ...
template <class Past>
HistoryShare share_of_row(const float* depth, int width, ConstPlaneView stored, const Window& window,
                          const Past& past) {
  Float surface = 0.0F, lost = 0.0F;
  for (int x = 0; x < width; x += kLanes)
    count_lost({stored, window}, load(depth + x), past(x), iota(x) < Int(width), surface, lost);
  return {sum_of_lanes(surface), sum_of_lanes(lost)};
}

HistoryShare share_of_past(const Reprojection& reprojection, int y, ConstPlaneView stored, const Window& window) {
  const ReprojectionRow row = reprojection.row(y);
  return share_of_row(row.depth, row.width, stored, window, [&](int x) { return past_at(row, x); });
}

HistoryShare share_of_planes(ConstPlaneView depth, const Reprojected& past, int y, ConstPlaneView stored,
                             const Window& window) {
  return share_of_row(depth.row(y), depth.width, stored, window, [&](int x) {
    return Point{load(past.x.row(y) + x), load(past.y.row(y) + x), load(past.depth.row(y) + x)};
  });
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::temporal {

namespace {

HWY_EXPORT(past_row);
HWY_EXPORT(past_rows);
HWY_EXPORT(share_of_past);
HWY_EXPORT(share_of_planes);

bool is_surface(float depth) { return std::isfinite(depth) && depth > 0; }

double total_share(const std::vector<HistoryShare>& rows) {
  HistoryShare total;
  for (const HistoryShare& row : rows) total.surface += row.surface, total.lost += row.lost;
  return total.surface > 0 ? static_cast<double>(total.lost) / static_cast<double>(total.surface) : 0;
}

}  // namespace

Reprojection::Reprojection(const ReprojectionInput& input, ReprojectionSource source, float agreement_px)
    : input_(input),
      vectors_(source == ReprojectionSource::automatic && !input.mv_prev_x.empty() && !input.mv_prev_y.empty()),
      agreement_px_(agreement_px) {}

ReprojectionRow Reprojection::row(int y) const {
  const double centre_y = input_.window.min_y + y + 0.5;
  ReprojectionRow row{};
  row.depth = input_.depth.row(y);
  if (vectors_) row.mv_x = input_.mv_prev_x.row(y), row.mv_y = input_.mv_prev_y.row(y);
  if (input_.camera) row.camera = filter::static_motion(*input_.camera, centre_y);
  row.holes_are_invalid = input_.holes_are_invalid;
  row.agreement_px = agreement_px_;
  row.width = input_.depth.width;
  row.min_x = input_.window.min_x;
  row.centre_y = static_cast<float>(centre_y);
  return row;
}

void Reprojection::row(int y, const float* not_needed, float* x, float* y_before, float* depth) const {
  HWY_DYNAMIC_DISPATCH(past_row)(row(y), not_needed, x, y_before, depth);
}

Reprojected reproject(const ReprojectionInput& input, ReprojectionSource source, float agreement_px) {
  const int width = input.depth.width, height = input.depth.height;
  const auto blank = [&] { return Plane::for_overwrite(width, height); };
  Reprojected out{blank(), blank(), blank()};
  HWY_DYNAMIC_DISPATCH(past_rows)(Reprojection(input, source, agreement_px), out);
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
  if (stored_depth.empty()) return 0;
  std::vector<HistoryShare> shares(static_cast<size_t>(depth.height));
  for_rows(depth.height, [&](int y) {
    shares[static_cast<size_t>(y)] =
        HWY_DYNAMIC_DISPATCH(share_of_planes)(depth, reprojected, y, stored_depth, stored_window);
  });
  return total_share(shares);
}

double share_without_history(ConstPlaneView depth, Window window, const Reprojection& reprojection,
                             ConstPlaneView stored_depth, Window stored_window) {
  constexpr int kLowWindow = 64, kEvery = 8;
  if (stored_depth.empty()) return 0;
  const int every = depth.height < kLowWindow ? 1 : kEvery, first = (window.min_y % every + every) % every;
  std::vector<HistoryShare> shares(static_cast<size_t>(depth.height));
  for_rows((depth.height + every - 1) / every, [&](int index) {
    const int y = (every - first) % every + index * every;
    if (y >= depth.height) return;
    shares[static_cast<size_t>(y)] = HWY_DYNAMIC_DISPATCH(share_of_past)(reprojection, y, stored_depth, stored_window);
  });
  return total_share(shares);
}

}  // namespace aftershade::temporal
#endif
