#include "tests/motionblur/reference_blur.h"

#include <algorithm>
#include <cmath>

namespace aftershade::tests {

namespace {

struct Vec {
  double x, y;
};
double length(Vec v) { return std::hypot(v.x, v.y); }
double saturate(double v) { return std::clamp(v, 0.0, 1.0); }

class Reference {
 public:
  Reference(const motionblur::ScalableBlurParams& params, int radius, const BlurScene& scene)
      : p_(params), radius_(radius), s_(scene) {}

  /// The blurred colour of pixel C = (x, y).
  std::vector<double> pixel(int x, int y) const {
    const std::vector<double> colour = colour_at(x, y);
    const Vec v_n = neighbourhood(x, y), v_c = velocity(x, y);
    if (length(v_n) <= 0.5 || !finite(colour)) return colour;
    double weights = p_.centre_weight / speed(x, y);
    std::vector<double> sum = colour;
    for (double& value : sum) value *= weights;
    for (int i = 0; i < p_.taps; ++i) {
      if (i == (p_.taps - 1) / 2) continue;
      const double share = (i + 1 + jitter(x, y)) / (p_.taps + 1);
      const double t = -1 * (1 - share) + 1 * share;
      Vec v = v_n;
      if (p_.directions == motionblur::Directions::alternate && i % 2 == 1 && length(v_c) >= 1.5)
        v = {v_c.x / length(v_c) * length(v_n), v_c.y / length(v_c) * length(v_n)};
      const int sx = x + static_cast<int>(std::nearbyint(v.x * t)), sy = y + static_cast<int>(std::nearbyint(v.y * t));
      if (sx < 0 || sy < 0 || sx >= s_.window.width() || sy >= s_.window.height()) continue;
      const std::vector<double> sample = colour_at(sx, sy);
      if (!finite(sample)) continue;
      const double w = weight(x, y, sx, sy, length(v) * std::abs(t));
      weights += w;
      for (size_t c = 0; c < sum.size(); ++c) sum[c] += w * sample[c];
    }
    for (double& value : sum) value /= weights;
    return sum;
  }

 private:
  /// B_S and F_S of slide "Foreground vs. Background", c_S of the two cases, c_B of "Mutually Blurry Samples".
  double weight(int cx, int cy, int sx, int sy, double d) const {
    const double z_c = depth(cx, cy), z_s = depth(sx, sy);
    const double back = z_c == z_s ? 1 : saturate(1 - (z_c - z_s) / p_.soft_depth_extent_m);
    const double front = z_c == z_s ? 1 : saturate(1 - (z_s - z_c) / p_.soft_depth_extent_m);
    const double background = saturate(1 - d / speed(cx, cy)), foreground = saturate(1 - d / speed(sx, sy));
    const double both = speed(sx, sy) >= d && speed(cx, cy) >= d ? 1 : 0;
    return p_.background_weight * back * background + p_.foreground_weight * front * foreground +
           p_.both_moving_weight * both;
  }

  double jitter(int x, int y) const {
    const int ax = x + s_.window.min_x, ay = y + s_.window.min_y;
    if (p_.jitter == motionblur::Jitter::checkerboard) return (ax + ay) % 2 == 0 ? -0.25 : 0.25;
    const auto phase = [](int a) { return static_cast<size_t>((a % 4 + 4) % 4); };
    return kBayer4x4[phase(ay) * 4 + phase(ax)] - 0.5;
  }

  Vec neighbourhood(int x, int y) const {
    Vec longest{0, 0};
    const auto [first_x, last_x] = tiles_around(x, s_.window.min_x, s_.window.width());
    const auto [first_y, last_y] = tiles_around(y, s_.window.min_y, s_.window.height());
    for (int row = first_y; row <= last_y; ++row)
      for (int column = first_x; column <= last_x; ++column)
        if (length(velocity(column, row)) > length(longest)) longest = velocity(column, row);
    return longest;
  }

  std::pair<int, int> tiles_around(int at, int origin, int size) const {
    const int tile = static_cast<int>(std::floor(static_cast<double>(at + origin) / radius_));
    return {std::max((tile - 1) * radius_ - origin, 0), std::min((tile + 2) * radius_ - 1 - origin, size - 1)};
  }

  double depth(int x, int y) const {
    const double z = s_.depth(x, y);
    return z > 0 ? z : HUGE_VAL;
  }
  Vec velocity(int x, int y) const { return {s_.velocity.x(x, y), s_.velocity.y(x, y)}; }
  double speed(int x, int y) const { return std::max(length(velocity(x, y)), 0.5); }
  std::vector<double> colour_at(int x, int y) const {
    std::vector<double> colour;
    for (const Plane& plane : s_.channels) colour.push_back(plane(x, y));
    return colour;
  }
  static bool finite(const std::vector<double>& colour) {
    return std::ranges::all_of(colour, [](double value) { return std::isfinite(value); });
  }

  const motionblur::ScalableBlurParams& p_;
  int radius_;
  const BlurScene& s_;
};

}  // namespace

std::vector<std::vector<double>> reference_blur(const motionblur::ScalableBlurParams& params, int radius,
                                                const BlurScene& scene) {
  const Reference reference(params, radius, scene);
  std::vector<std::vector<double>> out(scene.channels.size());
  for (int y = 0; y < scene.window.height(); ++y)
    for (int x = 0; x < scene.window.width(); ++x) {
      const std::vector<double> pixel = reference.pixel(x, y);
      for (size_t c = 0; c < out.size(); ++c) out[c].push_back(pixel[c]);
    }
  return out;
}

}  // namespace aftershade::tests
