#include "tests/metrics/flip_reference.h"

#include <algorithm>
#include <cmath>

namespace aftershade::metrics::naive {

namespace {
constexpr double kPi = 3.14159265358979323846;
const Color kWhite = linear_to_xyz({1, 1, 1});
}  // namespace

const Color& Image::clamped(int x, int y) const {
  x = std::clamp(x, 0, width - 1), y = std::clamp(y, 0, height - 1);
  return pixels[static_cast<size_t>(y * width + x)];
}

// The matrices of IEC 61966-2-1 before their rounding to four digits.
Color linear_to_xyz(const Color& c) {
  return {0.412386563 * c[0] + 0.357591491 * c[1] + 0.180450491 * c[2],
          0.212636822 * c[0] + 0.715182982 * c[1] + 0.072180196 * c[2],
          0.019330620 * c[0] + 0.119197164 * c[1] + 0.950372587 * c[2]};
}
Color xyz_to_linear(const Color& c) {
  return {3.241003233 * c[0] - 1.537398969 * c[1] - 0.498615882 * c[2],
          -0.969224252 * c[0] + 1.875929984 * c[1] + 0.041554226 * c[2],
          0.055639420 * c[0] - 0.204011206 * c[1] + 1.057148977 * c[2]};
}

Color lab(const Color& xyz) {
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double x = f(xyz[0] / kWhite[0]), y = f(xyz[1] / kWhite[1]), z = f(xyz[2] / kWhite[2]);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double color_error(const Color& rgb_a, const Color& rgb_b) {
  const auto hunt = [](const Color& rgb) {
    const Color c = lab(linear_to_xyz(rgb));
    return Color{c[0], 0.01 * c[0] * c[1], 0.01 * c[0] * c[2]};
  };
  const auto distance = [&](const Color& p, const Color& q) {
    const Color a = hunt(p), b = hunt(q);
    const double chroma = std::sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
    return std::pow(std::abs(a[0] - b[0]) + chroma, 0.7);
  };
  const double greatest = distance({0, 1, 0}, {0, 0, 1}), d = distance(rgb_a, rgb_b);
  if (d < 0.4 * greatest) return 0.95 / (0.4 * greatest) * d;
  return 0.95 + (d - 0.4 * greatest) / (0.6 * greatest) * 0.05;
}

double filtered(const Image& image, int x, int y, int radius, const std::function<double(int, int)>& kernel,
                const std::function<double(const Color&)>& value) {
  double positive = 0, negative = 0, weight_positive = 0, weight_negative = 0;
  for (int j = -radius; j <= radius; ++j)
    for (int i = -radius; i <= radius; ++i) {
      const double w = kernel(i, j), v = value(image.clamped(x + i, y + j));
      (w > 0 ? positive : negative) += w * v;
      (w > 0 ? weight_positive : weight_negative) += w;
    }
  return positive / weight_positive - (weight_negative < 0 ? negative / weight_negative : 0);
}

namespace {
/// Y_y, C_x, C_z (section 4.1).
Color opponent(const Color& rgb) {
  const Color xyz = linear_to_xyz(rgb);
  const double x = xyz[0] / kWhite[0], y = xyz[1] / kWhite[1], z = xyz[2] / kWhite[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}
Color from_opponent(const Color& c) {
  const double y = (c[0] + 16) / 116, x = c[1] / 500 + y, z = y - c[2] / 200;
  return xyz_to_linear({x * kWhite[0], y * kWhite[1], z * kWhite[2]});
}

Color seen_color(const Image& image, int x, int y, double pixels_per_degree) {
  constexpr double a1[3] = {1, 1, 34.1}, b1[3] = {0.0047, 0.0053, 0.04}, a2[3] = {0, 0, 13.5},
                   b2[3] = {1e-5, 1e-5, 0.025};
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * pixels_per_degree));
  Color seen{};
  for (size_t c = 0; c < 3; ++c) {
    const auto kernel = [&](int i, int j) {
      const double square = (i * i + j * j) / (pixels_per_degree * pixels_per_degree);
      return a1[c] * std::sqrt(kPi / b1[c]) * std::exp(-kPi * kPi * square / b1[c]) +
             a2[c] * std::sqrt(kPi / b2[c]) * std::exp(-kPi * kPi * square / b2[c]);
    };
    seen[c] = filtered(image, x, y, radius, kernel, [&](const Color& rgb) { return opponent(rgb)[c]; });
  }
  Color rgb = from_opponent(seen);
  for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
  return rgb;
}

struct Features {
  double edge, point;
};
Features features(const Image& image, int x, int y, double pixels_per_degree) {
  const double s = 0.5 * 0.082 * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * s));
  const auto g = [&](int i, int j) { return std::exp(-(i * i + j * j) / (2 * s * s)); };
  const auto luminance = [](const Color& rgb) { return (opponent(rgb)[0] + 16) / 116; };
  const auto along = [&](const std::function<double(int, int)>& kernel) {
    return filtered(image, x, y, radius, kernel, luminance);
  };
  return {
      std::hypot(along([&](int i, int j) { return -i * g(i, j); }), along([&](int i, int j) { return -j * g(i, j); })),
      std::hypot(along([&](int i, int j) { return (i * i / (s * s) - 1) * g(i, j); }),
                 along([&](int i, int j) { return (j * j / (s * s) - 1) * g(i, j); }))};
}
}  // namespace

std::vector<double> ldr_flip(const Image& a, const Image& b, double pixels_per_degree) {
  std::vector<double> errors;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const double color = color_error(seen_color(a, x, y, pixels_per_degree), seen_color(b, x, y, pixels_per_degree));
      const Features p = features(a, x, y, pixels_per_degree), q = features(b, x, y, pixels_per_degree);
      const double feature = std::max(std::abs(p.edge - q.edge), std::abs(p.point - q.point)) / std::sqrt(2.0);
      errors.push_back(std::pow(color, 1 - std::sqrt(feature)));
    }
  return errors;
}

}  // namespace aftershade::metrics::naive
