#include "core/metrics/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel/rows.h"

namespace aftershade::metrics {

namespace {
constexpr double kPi = std::numbers::pi;

/// A Gaussian of the contrast sensitivity's model in space, a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees (Andersson
/// et al. 2020, section 4.1, table 1).
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kAchromatic{1, 0.0047}, kRedGreen{1, 0.0053};
constexpr Sensitivity kBlueYellowWide{34.1, 0.04}, kBlueYellowNarrow{13.5, 0.025};
constexpr double kWidestB = 0.04;

/// Width of the features that are looked for, in degrees (section 4.2).
constexpr double kFeatureWidth_deg = 0.082;

/// Three standard deviations.
int radius_of(double deviation_px) { return static_cast<int>(std::ceil(3 * deviation_px)); }

/// `weight` at x = -radius .. radius. Positive weights are scaled to the sum 1, negative ones to -1.
template <class Weight>
Kernel kernel_of(int radius, Weight&& weight) {
  double positive = 0, negative = 0;
  for (int x = -radius; x <= radius; ++x) (weight(x) > 0 ? positive : negative) += weight(x);
  Kernel kernel;
  for (int x = -radius; x <= radius; ++x) {
    const double w = weight(x);
    kernel.push_back(static_cast<float>(w > 0 ? w / positive : w < 0 ? -w / negative : 0));
  }
  return kernel;
}

struct SensitivityShape {
  double b, pixels_per_degree;
  double operator()(int x) const {
    const double degrees = x / pixels_per_degree;
    return std::exp(-kPi * kPi * degrees * degrees / b);
  }
};

/// Sum of the unscaled Gaussian over the square of pixels that the filter covers.
double volume(const Sensitivity& s, int radius, double pixels_per_degree) {
  double sum = 0;
  for (int x = -radius; x <= radius; ++x) sum += SensitivityShape{s.b, pixels_per_degree}(x);
  return s.a * std::sqrt(kPi / s.b) * sum * sum;
}
}  // namespace

FlipKernels flip_kernels(double pixels_per_degree) {
  FlipKernels kernels;
  const int radius = radius_of(std::sqrt(kWidestB / (2 * kPi * kPi)) * pixels_per_degree);  // one for all channels
  const auto sensitivity = [&](const Sensitivity& s) {
    return kernel_of(radius, SensitivityShape{s.b, pixels_per_degree});
  };
  kernels.achromatic = sensitivity(kAchromatic);
  kernels.red_green = sensitivity(kRedGreen);
  kernels.blue_yellow_wide = sensitivity(kBlueYellowWide);
  kernels.blue_yellow_narrow = sensitivity(kBlueYellowNarrow);
  const double wide = volume(kBlueYellowWide, radius, pixels_per_degree);
  kernels.wide_share = static_cast<float>(wide / (wide + volume(kBlueYellowNarrow, radius, pixels_per_degree)));

  const double deviation = 0.5 * kFeatureWidth_deg * pixels_per_degree;
  const auto gaussian = [&](int x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const int reach = radius_of(deviation);
  kernels.smooth = kernel_of(reach, gaussian);
  kernels.edge = kernel_of(reach, [&](int x) { return -x * gaussian(x); });
  kernels.point = kernel_of(reach, [&](int x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); });
  return kernels;
}

Plane filtered_along_x(ConstPlaneView image, const Kernel& kernel) {
  Plane out(image.width, image.height);
  const int radius = static_cast<int>(kernel.size() / 2);
  for_rows(image.height, [&](int y) {
    std::vector<float> line(static_cast<size_t>(image.width + 2 * radius));
    for (size_t i = 0; i < line.size(); ++i)
      line[i] = image(std::clamp(static_cast<int>(i) - radius, 0, image.width - 1), y);
    float* row = out.row(y);
    for (size_t k = 0; k < kernel.size(); ++k)
      for (int x = 0; x < image.width; ++x) row[x] += kernel[k] * line[k + static_cast<size_t>(x)];
  });
  return out;
}

Plane filtered_along_y(ConstPlaneView image, const Kernel& kernel) {
  Plane out(image.width, image.height);
  const int radius = static_cast<int>(kernel.size() / 2);
  for_rows(image.height, [&](int y) {
    float* row = out.row(y);
    for (size_t k = 0; k < kernel.size(); ++k) {
      const float* line = image.row(std::clamp(y + static_cast<int>(k) - radius, 0, image.height - 1));
      for (int x = 0; x < image.width; ++x) row[x] += kernel[k] * line[x];
    }
  });
  return out;
}

}  // namespace aftershade::metrics
