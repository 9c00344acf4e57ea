#pragma once
#include <array>
#include <functional>
#include <vector>

/// LDR-FLIP straight from the paper (Andersson et al. 2020): scalar, double, full two-dimensional kernels.
namespace aftershade::metrics::naive {

using Color = std::array<double, 3>;

struct Image {
  int width, height;
  std::vector<Color> pixels;
  const Color& clamped(int x, int y) const;  ///< the nearest pixel
};

Color linear_to_xyz(const Color& rgb);
Color xyz_to_linear(const Color& xyz);
Color lab(const Color& xyz);
double color_error(const Color& rgb_a, const Color& rgb_b);  ///< of two even surfaces, 0..1

/// Errors of every pixel, row by row.
std::vector<double> ldr_flip(const Image& a, const Image& b, double pixels_per_degree);

/// Sum of kernel(dx, dy) * value over a square of 2 radius + 1 pixels; positive weights are scaled to the sum 1 and
/// negative ones to -1.
double filtered(const Image& image, int x, int y, int radius, const std::function<double(int, int)>& kernel,
                const std::function<double(const Color&)>& value);

}  // namespace aftershade::metrics::naive
