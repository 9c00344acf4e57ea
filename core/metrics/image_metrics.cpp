#include "core/metrics/image_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace aftershade::metrics {

namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool same_size(ConstPlaneView a, ConstPlaneView b) { return a.width == b.width && a.height == b.height; }
bool comparable(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  return same_size(a, b) && (mask.empty() || same_size(a, mask));
}

/// Calls visit(a, b) for every counted pixel, row by row.
template <class Visit>
void for_pixels(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask, Visit&& visit) {
  if (!comparable(a, b, mask)) return;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const bool counts = mask.empty() || mask(x, y) > 0.5F;
      if (counts && std::isfinite(a(x, y)) && std::isfinite(b(x, y)))
        visit(static_cast<double>(a(x, y)), static_cast<double>(b(x, y)));
    }
}

struct Mean {
  double sum = 0;
  int64_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return count > 0 ? sum / static_cast<double>(count) : kNan; }
};

template <class Value>
double mean_of(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask, Value&& value) {
  Mean mean;
  for_pixels(a, b, mask, [&](double p, double q) { mean.add(value(p, q)); });
  return mean.value();
}

double square(double x) { return x * x; }
double mean_square(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  return mean_of(a, b, mask, [](double p, double q) { return square(p - q); });
}
double decibel(double mean_square_error) { return -10 * std::log10(mean_square_error); }

constexpr int kWindowRadius = 5;
constexpr size_t kWindow = 2 * kWindowRadius + 1;
std::array<double, kWindow> gaussian_window() {
  constexpr double kSigma = 1.5;
  std::array<double, kWindow> weights{};
  double sum = 0;
  for (int i = -kWindowRadius; i <= kWindowRadius; ++i)
    sum += weights[static_cast<size_t>(i + kWindowRadius)] = std::exp(-0.5 * square(i / kSigma));
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Weighted first and second moments of two images.
struct Moments {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  void add(const Moments& other, double weight) {
    a += weight * other.a;
    b += weight * other.b;
    aa += weight * other.aa;
    bb += weight * other.bb;
    ab += weight * other.ab;
  }
  /// Wang et al. 2004, equation 13.
  double similarity() const {
    constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
    const double variances = aa - a * a + bb - b * b, covariance = ab - a * b;
    return (2 * a * b + kC1) * (2 * covariance + kC2) / ((a * a + b * b + kC1) * (variances + kC2));
  }
};

Moments moments_at(ConstPlaneView a, ConstPlaneView b, int x, int y) {
  const auto finite = [](float v) { return std::isfinite(v) ? static_cast<double>(v) : 0.0; };
  const double p = finite(a(x, y)), q = finite(b(x, y));
  return {p, q, p * p, q * q, p * q};
}
}  // namespace

double rmse(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) { return std::sqrt(mean_square(a, b, mask)); }

double mae(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  return mean_of(a, b, mask, [](double p, double q) { return std::abs(p - q); });
}

double mean_error(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  return mean_of(a, b, mask, [](double p, double q) { return p - q; });
}

double correlation(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  const double mean_a = mean_of(a, b, mask, [](double p, double) { return p; });
  const double mean_b = mean_of(a, b, mask, [](double, double q) { return q; });
  double aa = 0, bb = 0, ab = 0;
  for_pixels(a, b, mask, [&](double p, double q) {
    aa += square(p - mean_a);
    bb += square(q - mean_b);
    ab += (p - mean_a) * (q - mean_b);
  });
  return aa > 0 && bb > 0 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : kNan;
}

double psnr(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) { return decibel(mean_square(a, b, mask)); }

double display_psnr(const Rgb& a, const Rgb& b, ConstPlaneView mask) {
  const auto shown = [](double v) { return std::pow(std::clamp(v, 0.0, 1.0), 1 / 2.2); };
  Mean mean;
  for (size_t c = 0; c < 3; ++c) {
    if (!comparable(a[c], b[c], mask)) return kNan;
    for_pixels(a[c], b[c], mask, [&](double p, double q) { mean.add(square(shown(p) - shown(q))); });
  }
  return decibel(mean.value());
}

double ssim(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  if (!comparable(a, b, mask)) return kNan;
  const auto weights = gaussian_window();
  std::vector<Moments> columns(static_cast<size_t>(std::max(0, a.width)));
  Mean mean;
  for (int y = kWindowRadius; y < a.height - kWindowRadius; ++y) {
    std::fill(columns.begin(), columns.end(), Moments{});
    for (int j = -kWindowRadius; j <= kWindowRadius; ++j)
      for (int x = 0; x < a.width; ++x)
        columns[static_cast<size_t>(x)].add(moments_at(a, b, x, y + j),
                                            weights[static_cast<size_t>(j + kWindowRadius)]);
    for (int x = kWindowRadius; x < a.width - kWindowRadius; ++x) {
      if (!mask.empty() && !(mask(x, y) > 0.5F)) continue;
      Moments window;
      for (int i = -kWindowRadius; i <= kWindowRadius; ++i)
        window.add(columns[static_cast<size_t>(x + i)], weights[static_cast<size_t>(i + kWindowRadius)]);
      mean.add(window.similarity());
    }
  }
  return mean.value();
}

}  // namespace aftershade::metrics
