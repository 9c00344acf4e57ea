#include "tests/motionblur/reference_blur.h"

#include <algorithm>
#include <cmath>
#include <map>

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

  /// The blurred colour of pixel C = (x, y): the mean of all passes.
  std::vector<double> pixel(int x, int y) const {
    std::vector<double> mean(s_.channels.size());
    for (int pass = 0; pass < p_.passes; ++pass) {
      const std::vector<double> one = pixel_of_pass(x, y, pass);
      for (size_t c = 0; c < mean.size(); ++c) mean[c] += one[c] / p_.passes;
    }
    return mean;
  }

 private:
  std::vector<double> pixel_of_pass(int x, int y, int pass) const {
    const std::vector<double> colour = colour_at(x, y);
    const Vec v_n = neighbourhood(x, y), v_c = velocity(x, y);
    if (length(v_n) <= 0.5 || !finite(colour)) return colour;
    double weights = p_.centre_weight / speed(x, y);
    std::vector<double> sum = colour;
    for (double& value : sum) value *= weights;
    for (int i = 0; i < p_.taps; ++i) {
      if (i == (p_.taps - 1) / 2) continue;
      const double share = (i + 1 + jitter(x, y, pass)) / (p_.taps + 1);
      const double t = -1 * (1 - share) + 1 * share;
      const Vec v = direction(i, v_n, v_c, x, y);
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

  /// What tap i is taken along.
  Vec direction(int i, Vec v_n, Vec v_c, int x, int y) const {
    const auto with_length_of_v_n = [&](Vec v) {
      return length(v) < 1.5 ? v_n : Vec{v.x / length(v) * length(v_n), v.y / length(v) * length(v_n)};
    };
    if (p_.directions == motionblur::Directions::alternate) return i % 2 == 1 ? with_length_of_v_n(v_c) : v_n;
    if (p_.directions == motionblur::Directions::alternate_literal) return i % 2 == 1 ? v_c : v_n;
    if (p_.directions == motionblur::Directions::neighbourhood) return v_n;
    const int outwards = std::abs(i - (p_.taps - 1) / 2);
    if (outwards % 3 == 1) return v_n;
    return with_length_of_v_n(outwards % 3 == 2 ? v_c : tile_maximum(x, y));
  }

  /// B_S and F_S of slide "Foreground vs. Background", c_S of the two cases, c_B of "Mutually Blurry Samples".
  double weight(int cx, int cy, int sx, int sy, double d) const {
    const double z_c = depth(cx, cy), z_s = depth(sx, sy);
    const bool relative = p_.comparison == motionblur::DepthComparison::relative;
    const double extent = relative ? std::min(z_c, z_s) : p_.soft_depth_extent_m;
    const double back = z_c == z_s ? 1 : saturate(1 - (z_c - z_s) / extent);
    const double front = z_c == z_s ? 1 : saturate(1 - (z_s - z_c) / extent);
    const double background = saturate(1 - d / speed(cx, cy)), foreground = saturate(1 - d / speed(sx, sy));
    const double both = speed(sx, sy) >= d && speed(cx, cy) >= d ? 1 : 0;
    return p_.background_weight * back * background + p_.foreground_weight * front * foreground +
           p_.both_moving_weight * both;
  }

  double jitter(int x, int y, int pass) const {
    const int ax = x + s_.window.min_x, ay = y + s_.window.min_y;
    const auto phase = [](int a) { return static_cast<size_t>((a % 4 + 4) % 4); };
    const double first = p_.jitter == motionblur::Jitter::checkerboard ? ((ax + ay) % 2 == 0 ? -0.25 : 0.25)
                                                                       : kBayer4x4[phase(ay) * 4 + phase(ax)] - 0.5;
    const double shifted = first + static_cast<double>(pass) / p_.passes;
    return shifted < 0.5 ? shifted : shifted - 1;
  }

  Vec tile_maximum(int x, int y) const {
    const int tile_x = tile_of(x + s_.window.min_x), tile_y = tile_of(y + s_.window.min_y);
    Vec longest{0, 0};
    for_pixels_around(x, y, [&](int column, int row) {
      if (tile_of(column + s_.window.min_x) != tile_x || tile_of(row + s_.window.min_y) != tile_y) return;
      if (length(velocity(column, row)) > length(longest)) longest = velocity(column, row);
    });
    return longest;
  }

  Vec neighbourhood(int x, int y) const {
    const std::pair tile{tile_of(x + s_.window.min_x), tile_of(y + s_.window.min_y)};
    const auto known = neighbourhoods_.find(tile);
    return known != neighbourhoods_.end() ? known->second : neighbourhoods_[tile] = longest_around(x, y);
  }

  Vec longest_around(int x, int y) const {
    Vec longest = tile_maximum(x, y);
    for_pixels_around(x, y, [&](int column, int row) {
      const Vec v = velocity(column, row);
      if (length(v) > length(longest) && counts(x, y, column, row)) longest = v;
    });
    return longest;
  }

  /// Does the velocity at (column, row) count in the neighbourhood of (x, y)?
  bool counts(int x, int y, int column, int row) const {
    if (p_.dilation == motionblur::Dilation::square) return true;
    const int ax = column + s_.window.min_x, ay = row + s_.window.min_y;
    const int tile_x = tile_of(x + s_.window.min_x), tile_y = tile_of(y + s_.window.min_y);
    if (p_.dilation == motionblur::Dilation::line) {
      const Vec from{ax + 0.5, ay + 0.5}, v = velocity(column, row);
      return crosses({from.x - tile_x * radius_, from.y - tile_y * radius_}, v);
    }
    const int ox = tile_of(ax) - tile_x, oy = tile_of(ay) - tile_y;
    const Vec v = tile_maximum(column, row);  // the tile's maximum decides for the tile
    if (length(v) > length(velocity(column, row))) return false;
    const auto sign = [](double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; };
    return std::abs(sign(ox * v.x) + sign(oy * v.y)) == std::abs(ox) + std::abs(oy);
  }

  /// Does the segment from p - v to p + v meet the tile, whose corner is the origin? Walked in many small steps.
  bool crosses(Vec p, Vec v) const {
    constexpr int steps = 4000;
    for (int i = -steps; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps, x = p.x + t * v.x, y = p.y + t * v.y;
      if (x >= 0 && x <= radius_ && y >= 0 && y <= radius_) return true;
    }
    return false;
  }

  int tile_of(int absolute) const { return static_cast<int>(std::floor(static_cast<double>(absolute) / radius_)); }

  template <class Visit>
  void for_pixels_around(int x, int y, const Visit& visit) const {
    const auto [first_x, last_x] = tiles_around(x, s_.window.min_x, s_.window.width());
    const auto [first_y, last_y] = tiles_around(y, s_.window.min_y, s_.window.height());
    for (int row = first_y; row <= last_y; ++row)
      for (int column = first_x; column <= last_x; ++column) visit(column, row);
  }

  std::pair<int, int> tiles_around(int at, int origin, int size) const {
    const int tile = tile_of(at + origin);
    return {std::max((tile - 1) * radius_ - origin, 0), std::min((tile + 2) * radius_ - 1 - origin, size - 1)};
  }

  double depth(int x, int y) const {
    const double z = s_.depth(x, y);
    return z > 0 ? z : HUGE_VAL;
  }
  Vec velocity(int x, int y) const { return {stored(s_.velocity.x(x, y)), stored(s_.velocity.y(x, y))}; }
  /// -K to K as 0 to 1 in steps of 1/255, in float as a texture's value is.
  double stored(float v) const {
    if (p_.velocity_bits == motionblur::VelocityBits::exact) return v;
    const auto k = static_cast<float>(radius_);
    const float step = std::nearbyintf(255.0F * std::clamp(0.5F * (v / k) + 0.5F, 0.0F, 1.0F));
    return (step / 255.0F * 2.0F - 1.0F) * k;
  }
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
  mutable std::map<std::pair<int, int>, Vec> neighbourhoods_;  ///< by tile
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
