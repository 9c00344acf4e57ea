#include "core/metrics/flip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/metrics/flip_filters.h"
#include "core/parallel/rows.h"

namespace aftershade::metrics {

namespace {
using Color = std::array<double, 3>;

/// Exponents and the two ends of the remapping (2020 paper, section 4.3, table 2).
constexpr double kColorExponent = 0.7, kFeatureExponent = 0.5;
constexpr double kSmallErrors = 0.4, kSmallErrorsShare = 0.95;

/// Linear Rec.709 to XYZ of a D65 white, in lowest terms of the primaries of IEC 61966-2-1.
constexpr double kToXyz[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                                 {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                                 {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
constexpr double kWhiteX = kToXyz[0][0] + kToXyz[0][1] + kToXyz[0][2];
constexpr double kWhiteZ = kToXyz[2][0] + kToXyz[2][1] + kToXyz[2][2];

/// Y, X - Y and Y - Z, with white at X = Y = Z = 1: Y_y C_x C_z of the paper without their factors and offset, which
/// filters of sum 1 leave alone.
Color to_opponent(const Color& rgb) {
  const auto dot = [&](const double(&m)[3]) { return m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2]; };
  const double x = dot(kToXyz[0]) / kWhiteX, y = dot(kToXyz[1]), z = dot(kToXyz[2]) / kWhiteZ;
  return {y, x - y, y - z};
}

/// The inverse of kToXyz.
struct FromXyz {
  double m[3][3];
  constexpr FromXyz() : m() {
    const auto& a = kToXyz;
    const auto minor = [&](int i, int j) {
      const int i0 = (i + 1) % 3, i1 = (i + 2) % 3, j0 = (j + 1) % 3, j1 = (j + 2) % 3;
      return a[i0][j0] * a[i1][j1] - a[i0][j1] * a[i1][j0];
    };
    const double determinant = a[0][0] * minor(0, 0) + a[0][1] * minor(0, 1) + a[0][2] * minor(0, 2);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] = minor(j, i) / determinant;
  }
};
constexpr FromXyz kFromXyz;

/// What is left of a colour inside the cube of displayable ones.
Color displayable(const Color& opponent) {
  const Color xyz{(opponent[0] + opponent[1]) * kWhiteX, opponent[0], (opponent[0] - opponent[2]) * kWhiteZ};
  Color rgb{};
  for (size_t c = 0; c < 3; ++c) {
    const auto& m = kFromXyz.m[c];
    rgb[c] = std::clamp(m[0] * xyz[0] + m[1] * xyz[1] + m[2] * xyz[2], 0.0, 1.0);
  }
  return rgb;
}

/// CIELAB with the chroma scaled by lightness: colours differ less where it is dark (Hunt effect, section 4.1).
Color to_hunt_lab(const Color& rgb) {
  constexpr double kDelta = 6.0 / 29;
  const auto f = [](double t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
  };
  const Color opponent = to_opponent(rgb);
  const double x = f(opponent[0] + opponent[1]), y = f(opponent[0]), z = f(opponent[0] - opponent[2]);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

/// HyAB, a distance for large differences (section 4.1), to the power 0.7.
double color_distance(const Color& a, const Color& b) {
  return std::pow(std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]), kColorExponent);
}

/// Small distances take up most of 0..1; the distance from green to blue, about the greatest, is 1 (section 4.1).
double remapped(double distance) {
  static const double greatest = color_distance(to_hunt_lab({0, 1, 0}), to_hunt_lab({0, 0, 1}));
  const double knee = kSmallErrors * greatest;
  if (distance < knee) return distance * kSmallErrorsShare / knee;
  return kSmallErrorsShare + (distance - knee) / (greatest - knee) * (1 - kSmallErrorsShare);
}

struct ColorPlanes {
  std::array<Plane, 3> planes;
  ColorPlanes(int width, int height) {
    for (Plane& plane : planes) plane = Plane(width, height);
  }
  Color at(int x, int y) const {
    return {static_cast<double>(planes[0](x, y)), static_cast<double>(planes[1](x, y)),
            static_cast<double>(planes[2](x, y))};
  }
  void set(int x, int y, const Color& color) {
    for (size_t c = 0; c < 3; ++c) planes[c](x, y) = static_cast<float>(color[c]);
  }
};

/// An image as a viewer sees it at his distance: colours in Hunt-adjusted CIELAB, and how much each pixel is an edge
/// and a point.
struct Seen {
  ColorPlanes lab;
  Plane edges, points;
};

/// sqrt(a^2 + b^2).
Plane magnitude(const Plane& a, const Plane& b) {
  Plane out(a.width(), a.height());
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x) out(x, y) = std::sqrt(a(x, y) * a(x, y) + b(x, y) * b(x, y));
  });
  return out;
}

/// `shown` is linear light, 0..1.
Seen seen(const ColorPlanes& shown, const FlipKernels& kernels) {
  const int width = shown.planes[0].width(), height = shown.planes[0].height();
  ColorPlanes opponent(width, height), lab(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) opponent.set(x, y, to_opponent(shown.at(x, y)));
  });
  const Plane& luminance = opponent.planes[0];  // of which Y_y is 116 Y - 16, and the detectors' normalised channel Y
  const Plane smooth_x = filtered_along_x(luminance, kernels.smooth);
  Plane edges = magnitude(filtered_along_y(filtered_along_x(luminance, kernels.edge), kernels.smooth),
                          filtered_along_y(smooth_x, kernels.edge));
  Plane points = magnitude(filtered_along_y(filtered_along_x(luminance, kernels.point), kernels.smooth),
                           filtered_along_y(smooth_x, kernels.point));

  const auto both_ways = [](const Plane& plane, const Kernel& kernel) {
    return filtered_along_y(filtered_along_x(plane, kernel), kernel);
  };
  const Plane achromatic = both_ways(luminance, kernels.achromatic);
  const Plane red_green = both_ways(opponent.planes[1], kernels.red_green);
  const Plane wide = both_ways(opponent.planes[2], kernels.blue_yellow_wide);
  const Plane narrow = both_ways(opponent.planes[2], kernels.blue_yellow_narrow);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const float blue_yellow = kernels.wide_share * wide(x, y) + (1 - kernels.wide_share) * narrow(x, y);
      const Color color{static_cast<double>(achromatic(x, y)), static_cast<double>(red_green(x, y)),
                        static_cast<double>(blue_yellow)};
      lab.set(x, y, to_hunt_lab(displayable(color)));
    }
  });
  return {std::move(lab), std::move(edges), std::move(points)};
}

/// Colour difference, raised where features differ (section 4.3).
double difference_at(const Seen& a, const Seen& b, int x, int y) {
  const double edges = std::abs(static_cast<double>(a.edges(x, y)) - static_cast<double>(b.edges(x, y)));
  const double points = std::abs(static_cast<double>(a.points(x, y)) - static_cast<double>(b.points(x, y)));
  const double features = std::pow(std::max(edges, points) * std::sqrt(0.5), kFeatureExponent);
  const double color = remapped(color_distance(a.lab.at(x, y), b.lab.at(x, y)));
  return color > 0 ? std::pow(color, 1 - features) : 0;
}

/// ACES as a rational polynomial: Narkowicz's fit with its factor 0.6 on the input taken out (2021 paper, table 1).
constexpr double kAces[6] = {0.36 * 2.51, 0.6 * 0.03, 0, 0.36 * 2.43, 0.6 * 0.59, 0.14};
double tone_mapped(double x) {
  return (kAces[0] * x * x + kAces[1] * x + kAces[2]) / (kAces[3] * x * x + kAces[4] * x + kAces[5]);
}
/// The x > 0 that is mapped to 0.85.
double brightest_shown() {
  constexpr double kShown = 0.85;
  const double a = kAces[0] - kShown * kAces[3], b = kAces[1] - kShown * kAces[4], c = kAces[2] - kShown * kAces[5];
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

/// Two images of one size and where they count.
class Pair {
 public:
  Pair(const Rgb& image, const Rgb& reference) : image_(image), reference_(reference) {
    comparable_ = true;
    for (size_t c = 0; c < 3; ++c)
      for (ConstPlaneView plane : {image[c], reference[c]})
        comparable_ &= plane.width == width() && plane.height == height();
  }
  bool comparable() const { return comparable_; }
  int width() const { return image_[0].width; }
  int height() const { return image_[0].height; }
  bool counts(int x, int y) const {
    for (size_t c = 0; c < 3; ++c)
      if (!std::isfinite(image_[c](x, y)) || !std::isfinite(reference_[c](x, y))) return false;
    return true;
  }

  /// LDR-FLIP of both after `show` of each value; at least `errors` where that is a number.
  template <class Show>
  void raise(Plane& errors, Show&& show, const FlipKernels& kernels) const {
    const Seen a = seen(shown(image_, show), kernels), b = seen(shown(reference_, show), kernels);
    for_rows(height(), [&](int y) {
      for (int x = 0; x < width(); ++x)
        if (counts(x, y)) errors(x, y) = std::fmax(errors(x, y), static_cast<float>(difference_at(a, b, x, y)));
    });
  }

 private:
  template <class Show>
  ColorPlanes shown(const Rgb& rgb, Show&& show) const {
    ColorPlanes out(width(), height());
    for_rows(height(), [&](int y) {
      for (int x = 0; x < width(); ++x)
        for (size_t c = 0; c < 3 && counts(x, y); ++c)
          out.planes[c](x, y) =
              static_cast<float>(std::clamp(show(std::max(static_cast<double>(rgb[c](x, y)), 0.0)), 0.0, 1.0));
    });
    return out;
  }

  Rgb image_, reference_;
  bool comparable_;
};

Plane unknown_errors(const Pair& pair) {
  return Plane(pair.width(), pair.height(), std::numeric_limits<float>::quiet_NaN());
}
}  // namespace

Plane ldr_flip(const Rgb& image, const Rgb& reference, double pixels_per_degree) {
  const Pair pair(image, reference);
  Plane errors = unknown_errors(pair);
  if (pair.comparable())
    pair.raise(
        errors, [](double v) { return v; }, flip_kernels(pixels_per_degree));
  return errors;
}

Exposures flip_exposures(const Rgb& reference) {
  constexpr double kMostStops = 32;
  std::vector<double> luminances;
  for (int y = 0; y < reference[0].height; ++y)
    for (int x = 0; x < reference[0].width; ++x) {
      const auto value = [&](size_t c) { return std::max(static_cast<double>(reference[c](x, y)), 0.0); };
      const double luminance = 0.2126 * value(0) + 0.7152 * value(1) + 0.0722 * value(2);
      if (std::isfinite(luminance)) luminances.push_back(luminance);
    }
  std::sort(luminances.begin(), luminances.end());
  if (luminances.empty() || luminances.back() <= 0) return {0, 0, 1};
  auto first = luminances.begin();
  const auto median = [&] { return first[(luminances.end() - first - 1) / 2]; };
  if (median() <= 0) first = std::upper_bound(first, luminances.end(), 0.0);
  const double brightest = brightest_shown();
  const double start = std::log2(brightest / luminances.back());
  const double stop = std::min(std::log2(brightest / median()), start + kMostStops);
  return {start, stop, std::max(2, static_cast<int>(std::ceil(stop - start)))};
}

Plane hdr_flip(const Rgb& image, const Rgb& reference, double pixels_per_degree) {
  const Pair pair(image, reference);
  Plane errors = unknown_errors(pair);
  if (!pair.comparable()) return errors;
  const Exposures exposures = flip_exposures(reference);
  const FlipKernels kernels = flip_kernels(pixels_per_degree);
  for (int i = 0; i < exposures.count; ++i) {
    const double factor = std::exp2(exposures.at(i));
    pair.raise(
        errors, [factor](double v) { return tone_mapped(factor * v); }, kernels);
  }
  return errors;
}

}  // namespace aftershade::metrics
