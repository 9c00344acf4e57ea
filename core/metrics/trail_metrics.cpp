#include "core/metrics/trail_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aftershade::metrics {

namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
constexpr double kVisible = 0.03;  ///< error of AO that is seen

bool same_size(ConstPlaneView a, ConstPlaneView b) { return a.width == b.width && a.height == b.height; }

/// Frames, counted back from frame t - 1 (1), to the nearest one in which the pixel was not as it is now (inside or
/// outside); 0 when there is none.
int frames_since_change(std::span<const ConstPlaneView> footprints, int x, int y) {
  const bool now = footprints.back()(x, y) > 0.5F;
  for (size_t back = 1; back < footprints.size(); ++back)
    if ((footprints[footprints.size() - 1 - back](x, y) > 0.5F) != now) return static_cast<int>(back);
  return 0;
}

/// frames_since_change of the pixels that are (not) inside now, 0 elsewhere.
Plane ages(std::span<const ConstPlaneView> footprints, bool inside) {
  if (footprints.empty()) return {};
  const ConstPlaneView last = footprints.back();
  const bool comparable = std::all_of(footprints.begin(), footprints.end(), [&](auto p) { return same_size(p, last); });
  Plane out(last.width, last.height, comparable ? 0.0F : kNoValue);
  for (int y = 0; comparable && y < last.height; ++y)
    for (int x = 0; x < last.width; ++x)
      if ((last(x, y) > 0.5F) == inside) out(x, y) = static_cast<float>(frames_since_change(footprints, x, y));
  return out;
}

/// Sums until finish() makes them means.
void add(AgeError& sum, double error) {
  sum.mean += error;
  sum.absolute += std::abs(error);
  sum.visible += std::abs(error) > kVisible ? 1 : 0;
  ++sum.count;
}
AgeError finish(const AgeError& sum) {
  if (sum.count == 0) return {kNan, kNan, kNan, 0};
  const auto n = static_cast<double>(sum.count);
  return {sum.mean / n, sum.absolute / n, sum.visible / n, sum.count};
}
}  // namespace

Plane frames_since_left(std::span<const ConstPlaneView> footprints) { return ages(footprints, false); }
Plane frames_since_entered(std::span<const ConstPlaneView> footprints) { return ages(footprints, true); }

std::vector<AgeError> error_by_age(std::span<const ConstPlaneView> images, std::span<const ConstPlaneView> truths,
                                   std::span<const ConstPlaneView> ages_of, int max_age) {
  std::vector<AgeError> sums(static_cast<size_t>(std::max(max_age, 0)));
  for (size_t k = 0; k < std::min({images.size(), truths.size(), ages_of.size()}); ++k) {
    const ConstPlaneView image = images[k], truth = truths[k], age = ages_of[k];
    if (!same_size(image, truth) || !same_size(image, age)) continue;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double error = static_cast<double>(image(x, y)) - static_cast<double>(truth(x, y));
        const float a = age(x, y);
        if (a >= 1 && a <= static_cast<float>(max_age) && std::isfinite(error))
          add(sums[static_cast<size_t>(a) - 1], error);
      }
  }
  std::transform(sums.begin(), sums.end(), sums.begin(), finish);
  return sums;
}

AgeError total_error(std::span<const AgeError> by_age) {
  AgeError sum;
  for (const AgeError& age : by_age) {
    if (age.count == 0) continue;
    const auto n = static_cast<double>(age.count);
    sum = {sum.mean + n * age.mean, sum.absolute + n * age.absolute, sum.visible + n * age.visible,
           sum.count + age.count};
  }
  return finish(sum);
}

double half_life_frames(std::span<const double> errors) {
  if (errors.empty() || !std::isfinite(errors[0]) || errors[0] == 0) return kNan;
  const double half = std::abs(errors[0]) / 2;
  for (size_t k = 1; k < errors.size(); ++k) {
    const double before = std::abs(errors[k - 1]), now = std::abs(errors[k]);
    if (!(now <= half)) continue;
    const double way = now > 0 ? std::log(before / half) / std::log(before / now) : 1;
    return static_cast<double>(k - 1) + way;
  }
  return std::numeric_limits<double>::infinity();
}

std::vector<double> step_response(std::span<const ConstPlaneView> images, ConstPlaneView start, ConstPlaneView end,
                                  ConstPlaneView mask) {
  std::vector<double> out;
  for (const ConstPlaneView image : images) {
    double way = 0, whole = 0;
    const bool comparable =
        same_size(image, start) && same_size(image, end) && (mask.empty() || same_size(image, mask));
    for (int y = 0; comparable && y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double from = static_cast<double>(start(x, y)), step = static_cast<double>(end(x, y)) - from,
                     come = static_cast<double>(image(x, y)) - from;
        if ((!mask.empty() && !(mask(x, y) > 0.5F)) || !std::isfinite(step * come)) continue;
        way += come * step;
        whole += step * step;
      }
    out.push_back(whole > 0 ? way / whole : kNan);
  }
  return out;
}

int frames_to_reach(std::span<const double> response, double share) {
  size_t first = response.size();
  while (first > 0 && response[first - 1] >= share) --first;
  return first < response.size() ? static_cast<int>(first) + 1 : 0;
}

}  // namespace aftershade::metrics
