#include "core/metrics/image_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/metrics/row_sums.h"

namespace aftershade::metrics {

namespace {
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool same_size(ConstPlaneView a, ConstPlaneView b) { return a.width == b.width && a.height == b.height; }
bool comparable(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  return same_size(a, b) && (mask.empty() || same_size(a, mask));
}
bool counts(ConstPlaneView mask, int x, int y) { return mask.empty() || mask(x, y) > 0.5F; }

/// Sum::add(a, b) of every counted pixel.
template <class Sum>
Sum sum_pixels(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  if (!comparable(a, b, mask)) return {};
  return row_sums<Sum>(a.height, [&](int y, Sum& sum) {
    for (int x = 0; x < a.width; ++x)
      if (counts(mask, x, y) && std::isfinite(a(x, y)) && std::isfinite(b(x, y)))
        sum.add(static_cast<double>(a(x, y)), static_cast<double>(b(x, y)));
  });
}

double square(double x) { return x * x; }
double ratio(double sum, int64_t count) { return count > 0 ? sum / static_cast<double>(count) : kNan; }

struct Errors : ErrorSums {
  void add(double a, double b) {
    errors += a - b;
    absolute += std::abs(a - b);
    squares += square(a - b);
    ++count;
  }
};

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

/// As a display shows it: 0..1, NaN for NaN.
double shown(float v) {
  return v > 0 ? std::pow(static_cast<double>(std::min(v, 1.0F)), 1 / 2.2) : v <= 0 ? 0 : static_cast<double>(v);
}
}  // namespace

ErrorSums& ErrorSums::operator+=(const ErrorSums& other) {
  errors += other.errors;
  absolute += other.absolute;
  squares += other.squares;
  count += other.count;
  return *this;
}
double ErrorSums::mean() const { return ratio(errors, count); }
double ErrorSums::mean_absolute() const { return ratio(absolute, count); }
double ErrorSums::root_mean_square() const { return std::sqrt(ratio(squares, count)); }
double ErrorSums::psnr() const { return -10 * std::log10(ratio(squares, count)); }

ErrorSums error_sums(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) { return sum_pixels<Errors>(a, b, mask); }
double rmse(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  return error_sums(a, b, mask).root_mean_square();
}
double mae(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) { return error_sums(a, b, mask).mean_absolute(); }
double mean_error(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) { return error_sums(a, b, mask).mean(); }
double psnr(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) { return error_sums(a, b, mask).psnr(); }

Covariance& Covariance::operator+=(const Covariance& other) {
  if (other.count == 0) return *this;
  const auto n = static_cast<double>(count), m = static_cast<double>(other.count);
  const double da = other.mean_a - mean_a, db = other.mean_b - mean_b, share = m / (n + m);
  aa += other.aa + da * da * n * share;
  bb += other.bb + db * db * n * share;
  ab += other.ab + da * db * n * share;
  mean_a += da * share;
  mean_b += db * share;
  count += other.count;
  return *this;
}
void Covariance::add(double a, double b) { *this += Covariance{a, b, 0, 0, 0, 1}; }
double Covariance::correlation() const {
  return aa > 0 && bb > 0 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : kNan;
}
Covariance covariance(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  return sum_pixels<Covariance>(a, b, mask);
}
double correlation(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  return covariance(a, b, mask).correlation();
}

void MeanSum::add(double value) {
  sum += value;
  ++count;
}
MeanSum& MeanSum::operator+=(const MeanSum& other) {
  sum += other.sum;
  count += other.count;
  return *this;
}
double MeanSum::mean() const { return ratio(sum, count); }

MeanSum mean_sum(ConstPlaneView values, ConstPlaneView mask) {
  if (!mask.empty() && !same_size(values, mask)) return {};
  return row_sums<MeanSum>(values.height, [&](int y, MeanSum& sum) {
    for (int x = 0; x < values.width; ++x)
      if (counts(mask, x, y) && std::isfinite(values(x, y))) sum.add(static_cast<double>(values(x, y)));
  });
}

Displayed displayed(const Rgb& a, const Rgb& b, ConstPlaneView mask) {
  Displayed out;
  const bool both = !b[0].empty();
  const int width = a[0].width, height = a[0].height;
  for (size_t c = 0; c < 3; ++c)
    if (!comparable(a[0], a[c], mask) || (both && !same_size(a[0], b[c]))) return out;
  out.luma_a = Plane(width, height);
  if (both) out.luma_b = Plane(width, height);
  out.errors = row_sums<Errors>(height, [&](int y, Errors& sum) {
    constexpr float kLuma[3] = {0.2126F, 0.7152F, 0.0722F};
    for (size_t c = 0; c < 3; ++c)
      for (int x = 0; x < width; ++x) {
        const double p = shown(a[c](x, y)), q = both ? shown(b[c](x, y)) : 0;
        out.luma_a(x, y) += kLuma[c] * static_cast<float>(p);
        if (!both) continue;
        out.luma_b(x, y) += kLuma[c] * static_cast<float>(q);
        // A value that is infinite is shown as 1, but is none that counts.
        if (counts(mask, x, y) && std::isfinite(a[c](x, y)) && std::isfinite(b[c](x, y))) sum.add(p, q);
      }
  });
  return out;
}

double display_psnr(const Rgb& a, const Rgb& b, ConstPlaneView mask) { return displayed(a, b, mask).errors.psnr(); }

MeanSum ssim_sum(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) {
  if (!comparable(a, b, mask)) return {};
  const auto weights = gaussian_window();
  return row_sums<MeanSum>(a.height - 2 * kWindowRadius, [&](int row, MeanSum& mean) {
    const int y = row + kWindowRadius;
    std::vector<Moments> columns(static_cast<size_t>(a.width));
    for (int j = -kWindowRadius; j <= kWindowRadius; ++j)
      for (int x = 0; x < a.width; ++x)
        columns[static_cast<size_t>(x)].add(moments_at(a, b, x, y + j),
                                            weights[static_cast<size_t>(j + kWindowRadius)]);
    for (int x = kWindowRadius; x < a.width - kWindowRadius; ++x) {
      if (!counts(mask, x, y)) continue;
      Moments window;
      for (int i = -kWindowRadius; i <= kWindowRadius; ++i)
        window.add(columns[static_cast<size_t>(x + i)], weights[static_cast<size_t>(i + kWindowRadius)]);
      mean.add(window.similarity());
    }
  });
}

double ssim(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask) { return ssim_sum(a, b, mask).mean(); }

}  // namespace aftershade::metrics
