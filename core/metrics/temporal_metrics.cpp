#include "core/metrics/temporal_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/metrics/row_sums.h"

namespace aftershade::metrics {

namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

bool same_size(ConstPlaneView a, ConstPlaneView b) { return a.width == b.width && a.height == b.height; }
bool counts(ConstPlaneView mask, int x, int y) { return mask.empty() || mask(x, y) > 0.5F; }
double square(double v) { return v * v; }
double ratio(double a, double b) { return b > 0 ? a / b : kNan; }

struct Position {
  double x, y;
  bool known() const { return std::isfinite(x) && std::isfinite(y); }
};

bool fits(const Motion& motion, ConstPlaneView plane) {
  return same_size(motion.x, plane) && same_size(motion.y, plane) &&
         (motion.valid.empty() || same_size(motion.valid, plane));
}
Position before(const Motion& motion, int x, int y) {
  if (!counts(motion.valid, x, y)) return {kNan, kNan};
  return {static_cast<double>(motion.x(x, y)), static_cast<double>(motion.y(x, y))};
}

/// Calls visit(x, y, weight) for the pixels of the bilinear tent at `at` that weigh anything; false, without any call,
/// when one lies outside.
template <class Visit>
bool for_taps(Position at, int width, int height, Visit&& visit) {
  const double u = at.x - 0.5, v = at.y - 0.5;
  if (!at.known() || !(u >= 0 && v >= 0 && u <= width - 1 && v <= height - 1)) return false;
  const int x0 = static_cast<int>(u), y0 = static_cast<int>(v);
  const double fx = u - x0, fy = v - y0;
  for (const auto& [y, wy] : {std::pair(y0, 1 - fy), {y0 + 1, fy}})
    for (const auto& [x, wx] : {std::pair(x0, 1 - fx), {x0 + 1, fx}})
      if (wx > 0 && wy > 0) visit(x, y, wx * wy);
  return true;
}

/// NaN outside or where a value that counts is not finite.
double bilinear(ConstPlaneView plane, Position at) {
  double sum = 0;
  const bool inside = for_taps(at, plane.width, plane.height,
                               [&](int x, int y, double w) { sum += w * static_cast<double>(plane(x, y)); });
  return inside && std::isfinite(sum) ? sum : kNan;
}

/// A plane of value(x, y).
template <class Value>
Plane plane_of(int width, int height, Value&& value) {
  Plane out(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) out(x, y) = static_cast<float>(value(x, y));
  });
  return out;
}

double nearest_rank(std::vector<float>& values, double share) {
  if (values.empty()) return kNan;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
  const auto at = values.begin() + std::max<std::ptrdiff_t>(rank, 0);
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}
}  // namespace

Plane same_surface(const Motion& motion, ConstPlaneView expected_depth, ConstPlaneView depth_before, double epsilon) {
  if (!fits(motion, expected_depth) || !same_size(expected_depth, depth_before))
    return Plane(expected_depth.width, expected_depth.height, kNoValue);
  return plane_of(expected_depth.width, expected_depth.height, [&](int x, int y) {
    const double expected = static_cast<double>(expected_depth(x, y));
    bool same = std::isfinite(expected) && expected > 0;
    const bool inside =
        for_taps(before(motion, x, y), depth_before.width, depth_before.height, [&](int tx, int ty, double) {
          const double z = static_cast<double>(depth_before(tx, ty));
          same = same && std::isfinite(z) && z > 0 && std::abs(1 - z / expected) <= epsilon;
        });
    return inside && same ? 1 : 0;
  });
}

Plane warped(ConstPlaneView image_before, const Motion& motion) {
  if (!fits(motion, image_before)) return Plane(image_before.width, image_before.height, kNoValue);
  return plane_of(image_before.width, image_before.height,
                  [&](int x, int y) { return bilinear(image_before, before(motion, x, y)); });
}

Plane change_along(ConstPlaneView now, ConstPlaneView image_before, const Motion& motion) {
  if (!same_size(now, image_before) || !fits(motion, now)) return Plane(now.width, now.height, kNoValue);
  return plane_of(now.width, now.height, [&](int x, int y) {
    return static_cast<double>(now(x, y)) - bilinear(image_before, before(motion, x, y));
  });
}

ErrorSums warping_error_sums(ConstPlaneView now, ConstPlaneView image_before, const Motion& motion,
                             ConstPlaneView mask) {
  return error_sums(now, warped(image_before, motion), mask);
}

double warping_error(ConstPlaneView now, ConstPlaneView image_before, const Motion& motion, ConstPlaneView mask) {
  return warping_error_sums(now, image_before, motion, mask).root_mean_square();
}

Plane flicker_above_truth(ConstPlaneView now, ConstPlaneView image_before, ConstPlaneView true_change,
                          const Motion& motion) {
  if (!same_size(now, image_before) || !same_size(now, true_change) || !fits(motion, now))
    return Plane(now.width, now.height, kNoValue);
  return plane_of(now.width, now.height, [&](int x, int y) {
    const double change = static_cast<double>(now(x, y)) - bilinear(image_before, before(motion, x, y));
    return std::abs(static_cast<float>(change) - true_change(x, y));  // as exact as the truth's: equal changes are 0
  });
}

Distribution distribution(std::span<const ConstPlaneView> values, std::span<const ConstPlaneView> masks) {
  std::vector<float> counted;
  double sum = 0;
  for (size_t k = 0; k < values.size(); ++k) {
    const ConstPlaneView plane = values[k], mask = k < masks.size() ? masks[k] : ConstPlaneView{};
    if (!mask.empty() && !same_size(plane, mask)) continue;
    for (int y = 0; y < plane.height; ++y)
      for (int x = 0; x < plane.width; ++x)
        if (counts(mask, x, y) && std::isfinite(plane(x, y))) {
          counted.push_back(plane(x, y));
          sum += static_cast<double>(plane(x, y));
        }
  }
  const auto count = static_cast<int64_t>(counted.size());
  const double mean = ratio(sum, static_cast<double>(count));
  const double p95 = nearest_rank(counted, 0.95), p99 = nearest_rank(counted, 0.99);
  return {mean, p95, p99, count};
}

namespace {
/// The values that the surface of pixel (x, y) of the last frame had, newest first, as far back as it can be followed.
std::vector<double> along_trajectory(std::span<const ConstPlaneView> frames, std::span<const Motion> motions, int x,
                                     int y) {
  std::vector<double> values;
  Position at{x + 0.5, y + 0.5};
  for (size_t k = frames.size(); k-- > 0;) {
    const double value = bilinear(frames[k], at);
    if (!std::isfinite(value)) break;
    values.push_back(value);
    const int px = static_cast<int>(at.x), py = static_cast<int>(at.y);
    const Position was = k > 0 ? before(motions[k], px, py) : Position{kNan, kNan};
    at = {was.x + (at.x - px - 0.5), was.y + (at.y - py - 0.5)};
  }
  return values;
}

double deviation(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) squares += square(v - mean) / n;
  return std::sqrt(squares);
}

double second_difference(const std::vector<double>& values) {
  double squares = 0;
  for (size_t k = 2; k < values.size(); ++k) squares += square(values[k] - 2 * values[k - 1] + values[k - 2]);
  return values.size() > 2 ? std::sqrt(squares / static_cast<double>(values.size() - 2)) : kNan;
}
}  // namespace

TrajectoryNoise trajectory_noise(std::span<const ConstPlaneView> frames, std::span<const Motion> motions,
                                 int least_frames) {
  if (frames.empty()) return {};
  const ConstPlaneView last = frames.back();
  TrajectoryNoise out{Plane(last.width, last.height, kNoValue), Plane(last.width, last.height, kNoValue)};
  bool comparable = motions.size() == frames.size();
  for (size_t k = 0; k < frames.size() && comparable; ++k)
    comparable = same_size(frames[k], last) && (k == 0 || fits(motions[k], last));
  if (!comparable) return out;
  for (int y = 0; y < last.height; ++y)
    for (int x = 0; x < last.width; ++x) {
      const std::vector<double> values = along_trajectory(frames, motions, x, y);
      if (values.empty() || static_cast<int>(values.size()) < least_frames) continue;
      out.deviation(x, y) = static_cast<float>(deviation(values));
      out.high_pass(x, y) = static_cast<float>(second_difference(values));
    }
  return out;
}

double gradient_ratio(ConstPlaneView image, ConstPlaneView truth, ConstPlaneView mask) {
  if (!same_size(image, truth) || (!mask.empty() && !same_size(mask, image))) return kNan;
  const auto energy = [](ConstPlaneView p, int x, int y) {
    return square(0.5 * (static_cast<double>(p(x + 1, y)) - static_cast<double>(p(x - 1, y)))) +
           square(0.5 * (static_cast<double>(p(x, y + 1)) - static_cast<double>(p(x, y - 1))));
  };
  double of_image = 0, of_truth = 0;
  for (int y = 1; y + 1 < image.height; ++y)
    for (int x = 1; x + 1 < image.width; ++x) {
      const double a = energy(image, x, y), r = energy(truth, x, y);
      if (!counts(mask, x, y) || !std::isfinite(a + r)) continue;
      of_image += a;
      of_truth += r;
    }
  return std::sqrt(ratio(of_image, of_truth));
}

SeamSums& SeamSums::operator+=(const SeamSums& other) {
  inside += other.inside;
  across += other.across;
  return *this;
}
double SeamSums::ratio() const { return metrics::ratio(across.mean(), inside.mean()); }

SeamSums tile_seam_sums(ConstPlaneView image, ConstPlaneView truth, int tile_px, int first_x, int first_y,
                        ConstPlaneView mask) {
  if (!same_size(image, truth) || tile_px <= 0 || (!mask.empty() && !same_size(mask, image))) return {};
  return row_sums<SeamSums>(image.height, [&](int y, SeamSums& sums) {
    const auto error = [&](int i, int j) {
      return counts(mask, i, j) ? static_cast<double>(image(i, j)) - static_cast<double>(truth(i, j)) : kNan;
    };
    const auto add = [&](double step, bool across) {
      if (std::isfinite(step)) (across ? sums.across : sums.inside).add(std::abs(step));
    };
    const bool first_row = (y - first_y) % tile_px == 0;
    for (int x = 0; x < image.width; ++x) {
      const double here = error(x, y);
      if (x > 0) add(here - error(x - 1, y), (x - first_x) % tile_px == 0);
      if (y > 0) add(here - error(x, y - 1), first_row);
    }
  });
}

double tile_seam_ratio(ConstPlaneView image, ConstPlaneView truth, int tile_px, int first_x, int first_y) {
  return tile_seam_sums(image, truth, tile_px, first_x, first_y).ratio();
}

Plane border_mask(int width, int height, int border_px) {
  return plane_of(width, height, [&](int x, int y) {
    return std::min({x, y, width - 1 - x, height - 1 - y}) < border_px ? 1 : 0;
  });
}

}  // namespace aftershade::metrics
