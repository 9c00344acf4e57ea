#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "core/parallel/rows.h"
#include "core/report/worst_frames.h"

namespace aftershade::report {

namespace {

constexpr double kOne = 65536;

/// Errors of the frame's pixels, row by row.
struct ErrorMap {
  int width = 0, height = 0;
  std::vector<uint32_t> errors;
  uint32_t* row(int y) { return errors.data() + static_cast<size_t>(y) * static_cast<size_t>(width); }
};

/// A comparison with NaN is false, so NaN becomes 0.
double seen(float value, bool grey) {
  const double clipped = value > 0 ? std::min(static_cast<double>(value), 1.0) : 0.0;
  return grey ? clipped : std::sqrt(clipped);
}

bool comparable(const Pixels& a, const Pixels& b) { return !a.empty() && a.size() == b.size(); }

uint32_t quantised(double squares, size_t planes) {
  return static_cast<uint32_t>(std::lround(squares / static_cast<double>(planes) * kOne));
}

/// Greatest minus smallest of the pictures' values at a pixel, squared, the mean of the planes.
uint32_t spread(const std::vector<const Pixels*>& pictures, int x, int y) {
  const size_t planes = pictures[0]->size();
  double squares = 0;
  for (size_t plane = 0; plane < planes; ++plane) {
    double least = 1, most = 0;
    for (const Pixels* picture : pictures) {
      const double value = seen((*picture)[plane](x, y), planes == 1);
      least = std::min(least, value);
      most = std::max(most, value);
    }
    squares += (most - least) * (most - least);
  }
  return quantised(squares, planes);
}

/// Adds the spread of some pictures to the map; returns its sum.
uint64_t add_spread(const std::vector<const Pixels*>& pictures, ErrorMap& map) {
  std::vector<uint64_t> sums(static_cast<size_t>(map.height));
  for_rows(map.height, [&](int y) {
    uint32_t* const row = map.row(y);
    uint64_t sum = 0;
    for (int x = 0; x < map.width; ++x) {
      const uint32_t error = spread(pictures, x, y);
      row[x] += error;
      sum += error;
    }
    sums[static_cast<size_t>(y)] = sum;
  });
  return std::accumulate(sums.begin(), sums.end(), uint64_t{0});
}

/// The groups of pictures whose spread is an error: pairs with the reference, else all candidates together.
std::vector<std::vector<const Pixels*>> compared(const std::vector<Pixels>& candidates, const Pixels& reference,
                                                 const Pixels& input) {
  std::vector<std::vector<const Pixels*>> groups;
  const Pixels& other = reference.empty() ? input : reference;
  if (!reference.empty() || candidates.size() == 1) {
    for (const Pixels& candidate : candidates)
      if (comparable(candidate, other)) groups.push_back({&candidate, &other});
    return groups;
  }
  auto& all = groups.emplace_back();
  for (const Pixels& candidate : candidates)
    if (comparable(candidate, candidates[0])) all.push_back(&candidate);
  if (all.empty()) groups.clear();
  return groups;
}

/// Where a box of the region's size holds most error, by sliding it over sums of columns.
Window worst_region(ErrorMap& map, int region_px) {
  const int width = std::min(region_px, map.width), height = std::min(region_px, map.height);
  std::vector<uint64_t> columns(static_cast<size_t>(map.width));
  const auto add_row = [&](int y, int sign) {
    for (int x = 0; x < map.width; ++x)
      columns[static_cast<size_t>(x)] += static_cast<uint64_t>(sign * int64_t{map.row(y)[x]});
  };
  int best_x = 0, best_y = 0;
  uint64_t best = 0, middle = 0;
  const int middle_x = (map.width - width) / 2, middle_y = (map.height - height) / 2;
  for (int y = 0; y < height - 1; ++y) add_row(y, 1);
  for (int y = 0; y + height <= map.height; ++y) {
    add_row(y + height - 1, 1);
    uint64_t sum = std::accumulate(columns.begin(), columns.begin() + width, uint64_t{0});
    for (int x = 0;; ++x) {
      if (y == middle_y && x == middle_x) middle = sum;
      if (sum > best) best = sum, best_x = x, best_y = y;
      if (x + width >= map.width) break;
      sum += columns[static_cast<size_t>(x + width)] - columns[static_cast<size_t>(x)];
    }
    add_row(y, -1);
  }
  if (middle == best) best_x = middle_x, best_y = middle_y;
  return {best_x, best_y, best_x + width - 1, best_y + height - 1};
}

}  // namespace

FrameError frame_error(const std::vector<Pixels>& candidates, const Pixels& reference, const Pixels& input,
                       int region_px) {
  const auto first = std::find_if(candidates.begin(), candidates.end(), [](const Pixels& p) { return !p.empty(); });
  if (first == candidates.end()) return {};
  ErrorMap map{first->front().width, first->front().height, {}};
  map.errors.resize(static_cast<size_t>(map.width) * static_cast<size_t>(map.height));
  if (map.errors.empty()) return {};
  uint64_t worst = 0;
  for (const auto& group : compared(candidates, reference, input)) worst = std::max(worst, add_spread(group, map));
  const double mean = static_cast<double>(worst) / kOne / static_cast<double>(map.errors.size());
  return {std::sqrt(mean), worst_region(map, region_px)};
}

}  // namespace aftershade::report
