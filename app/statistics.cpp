#include "app/statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/text.h"

namespace aftershade::app {

namespace {

struct Order {
  double min, median, max;
};
Order order_of(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *middle, *high};
}

std::string percent(int64_t part, int64_t whole) {
  return fixed(whole ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0, 1) + " %";
}

}  // namespace

DepthStatistics depth_statistics(ConstPlaneView depth) {
  DepthStatistics out;
  std::vector<float> values;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      std::isfinite(depth(x, y)) ? values.push_back(depth(x, y)) : void(++out.background);
  out.foreground = static_cast<int64_t>(values.size());
  if (values.empty()) return out;
  const Order order = order_of(values);
  out.min_m = order.min, out.median_m = order.median, out.max_m = order.max;
  return out;
}

std::string text_of(const DepthStatistics& s) {
  const std::string background = "background " + percent(s.background, s.foreground + s.background);
  if (s.foreground == 0) return background;
  return cat("nearest ", fixed(s.min_m, 3), " m, median ", fixed(s.median_m, 3), " m, farthest ", fixed(s.max_m, 3),
             " m, ", background);
}

VelocityStatistics velocity_statistics(ConstPlaneView x, ConstPlaneView y) {
  VelocityStatistics out;
  std::vector<float> lengths;
  for (int row = 0; row < x.height; ++row)
    for (int column = 0; column < x.width; ++column) {
      const float length = std::hypot(x(column, row), y(column, row));
      std::isfinite(length) ? lengths.push_back(length) : void(++out.unknown);
    }
  out.known = static_cast<int64_t>(lengths.size());
  if (lengths.empty()) return out;
  const Order order = order_of(lengths);
  out.median_px = order.median, out.max_px = order.max;
  return out;
}

std::string text_of(const VelocityStatistics& s) {
  return cat("median ", fixed(s.median_px, 2), " px, longest ", fixed(s.max_px, 2), " px, unknown ",
             percent(s.unknown, s.known + s.unknown));
}

}  // namespace aftershade::app
