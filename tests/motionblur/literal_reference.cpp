#include "tests/motionblur/literal_reference.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace aftershade::tests {

namespace {

struct Vec {
  double x, y;
};
Vec operator*(double s, Vec v) { return {s * v.x, s * v.y}; }
Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y; }
double length(Vec v) { return std::hypot(v.x, v.y); }
Vec norm(Vec v) { return 1 / (length(v) + 1e-5) * v; }

double saturate(double v) { return std::clamp(v, 0.0, 1.0); }
double lerp(double a, double b, double t) { return a + (b - a) * t; }
double cone(double d, double r) { return saturate(1 - d / r); }
double cylinder(double d, double r) {
  const double t = saturate((d - 0.95 * r) / (1.05 * r - 0.95 * r));
  return 1 - t * t * (3 - 2 * t);
}

struct Tile {
  int x, y;
};

/// The scene, its tiles, and the sum over taps.
class Gather {
 public:
  Gather(int radius, const BlurScene& scene) : radius_(radius), s_(scene) {}

  int width() const { return s_.window.width(); }
  int height() const { return s_.window.height(); }
  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width() && y < height(); }
  int column(int x) const { return x + s_.window.min_x; }  ///< absolute
  int row(int y) const { return y + s_.window.min_y; }
  double z(int x, int y) const { return s_.depth(x, y) > 0 && s_.depth(x, y) < 1e30F ? s_.depth(x, y) : 1e30; }
  Vec v(int x, int y) const { return {s_.velocity.x(x, y), s_.velocity.y(x, y)}; }
  double speed(int x, int y) const { return std::max(length(v(x, y)), 0.5); }

  Tile tile_of(int absolute_x, int absolute_y) const {
    const auto of = [&](int a) { return static_cast<int>(std::floor(static_cast<double>(a) / radius_)); };
    return {of(absolute_x), of(absolute_y)};
  }
  bool exists(Tile t) const {
    const Tile first = tile_of(s_.window.min_x, s_.window.min_y), last = tile_of(s_.window.max_x, s_.window.max_y);
    return t.x >= first.x && t.y >= first.y && t.x <= last.x && t.y <= last.y;
  }
  /// The longest velocity in a tile, {0, 0} if it does not exist.
  Vec tile_max(Tile t) const {
    Vec longest{0, 0};
    for (int y = std::max(t.y * radius_ - s_.window.min_y, 0); y < height() && tile_of(0, row(y)).y == t.y; ++y)
      for (int x = std::max(t.x * radius_ - s_.window.min_x, 0); x < width() && tile_of(column(x), 0).x == t.x; ++x)
        if (length(v(x, y)) > length(longest)) longest = v(x, y);
    return longest;
  }

  std::vector<double> colour(int x, int y) const {
    std::vector<double> out;
    for (const Plane& plane : s_.channels) out.push_back(plane(x, y));
    return out;
  }
  static bool finite(const std::vector<double>& colour) {
    return std::ranges::all_of(colour, [](double value) { return std::isfinite(value); });
  }

 private:
  int radius_;
  const BlurScene& s_;
};

/// Weighted mean of a pixel and its taps.
class Mean {
 public:
  Mean(std::vector<double> centre, double weight) : sum_(std::move(centre)), weight_(weight) {
    for (double& value : sum_) value *= weight;
  }
  void add(const std::vector<double>& colour, double weight) {
    weight_ += weight;
    for (size_t c = 0; c < sum_.size(); ++c) sum_[c] += weight * colour[c];
  }
  std::vector<double> value() const {
    std::vector<double> out = sum_;
    for (double& value : out) value /= weight_;
    return out;
  }

 private:
  std::vector<double> sum_;
  double weight_;
};

int rounded(double v) { return static_cast<int>(std::nearbyint(v)); }

/// Algorithms 2.2.
std::vector<double> mcguire_pixel(const motionblur::Mcguire2012Params& p, const Gather& g, int x, int y) {
  const std::vector<double> own = g.colour(x, y);
  Vec v_n{0, 0};
  const Tile tile = g.tile_of(g.column(x), g.row(y));
  for (int ty = -1; ty <= 1; ++ty)
    for (int tx = -1; tx <= 1; ++tx)
      if (const Vec v = g.tile_max({tile.x + tx, tile.y + ty}); length(v) > length(v_n)) v_n = v;
  if (length(v_n) <= 0.5 || !Gather::finite(own)) return own;
  Mean mean(own, 1 / g.speed(x, y));
  const double j = unit_float(hash_counters(static_cast<uint32_t>(g.column(x)), static_cast<uint32_t>(g.row(y)))) - 0.5;
  for (int i = 0; i < p.taps; ++i) {
    if (i == (p.taps - 1) / 2) continue;
    const double t = lerp(-1, 1, (i + j + 1) / (p.taps + 1));
    const int sx = x + rounded(t * v_n.x), sy = y + rounded(t * v_n.y);
    if (!g.inside(sx, sy) || !Gather::finite(g.colour(sx, sy))) continue;
    const double d = std::abs(t) * length(v_n), extent = p.soft_depth_extent_m;
    const double f = saturate(1 - (g.z(sx, sy) - g.z(x, y)) / extent);
    const double b = saturate(1 - (g.z(x, y) - g.z(sx, sy)) / extent);
    mean.add(g.colour(sx, sy), f * cone(d, g.speed(sx, sy)) + b * cone(d, g.speed(x, y)) +
                                   2 * cylinder(d, g.speed(sx, sy)) * cylinder(d, g.speed(x, y)));
  }
  return mean.value();
}

/// Algorithms 3.1.
class Guertin {
 public:
  Guertin(const motionblur::Guertin2014Params& p, int radius, const BlurScene& scene)
      : p_(p), radius_(radius), g_(radius, scene) {}

  std::vector<double> pixel(int x, int y) const {
    const std::vector<double> own = g_.colour(x, y);
    const Tile tile = chosen_tile(x, y);
    const Vec v_max = neighbour_max(tile), v = g_.v(x, y);
    if (length(v_max) <= 0.5 || !Gather::finite(own)) return own;
    const Vec w_n = 1 / length(v_max) * v_max;
    Vec w_p{-w_n.y, w_n.x};
    if (dot(w_p, v) < 0) w_p = -1 * w_p;
    const double share = saturate((g_.speed(x, y) - 0.5) / p_.slow_px);
    Vec w_c = (1 - share) * w_p + share * norm(v);
    w_c = 1 / length(w_c) * w_c;
    Mean mean(own, p_.taps / (p_.centre_divisor * g_.speed(x, y)));
    const double along_own = p_.split == motionblur::TapSplit::even ? 0.5 : variance(tile);
    for (int i = 0; i < p_.taps; ++i) {
      const double t = lerp(-1, 1, (i + 1 + p_.tap_jitter * jitter(x, y)) / (p_.taps + 1));
      const Vec d = std::floor((i + 1) * along_own) > std::floor(i * along_own) ? w_c : w_n;
      add_tap(x, y, t * length(v_max), d, w_c, mean);
    }
    return mean.value();
  }

 private:
  void add_tap(int x, int y, double at, Vec d, Vec w_c, Mean& mean) const {
    const int sx = x + rounded(at * d.x), sy = y + rounded(at * d.y);
    if (!g_.inside(sx, sy) || !Gather::finite(g_.colour(sx, sy))) return;
    const double distance = std::abs(at), a = std::abs(dot(w_c, d)), b = std::abs(dot(norm(g_.v(sx, sy)), d));
    const double s = g_.speed(sx, sy), c = g_.speed(x, y);
    mean.add(g_.colour(sx, sy), z_compare(g_.z(sx, sy), g_.z(x, y)) * cone(distance, s) * b +
                                    z_compare(g_.z(x, y), g_.z(sx, sy)) * cone(distance, c) * a +
                                    2 * cylinder(distance, std::min(s, c)) * std::max(a, b));
  }
  static double z_compare(double a, double b) { return saturate(1 - (a - b) / std::min(a, b)); }

  /// x / p + y / p^2 modulo 1, p the plastic number.
  double jitter(int x, int y) const {
    const double p = 1.32471795724474602596;
    const double at = g_.column(x) / p + g_.row(y) / (p * p);
    return 2 * (at - std::floor(at)) - 1;
  }

  Tile chosen_tile(int x, int y) const {
    const int ax = g_.column(x), ay = g_.row(y);
    const Tile own = g_.tile_of(ax, ay);
    if (length(neighbour_max(own)) <= 0.5) return own;
    const uint32_t bits = hash_counters(static_cast<uint32_t>(ax), static_cast<uint32_t>(ay), 0, 1);
    const int shift =
        static_cast<int>(std::floor(0.5 + (2.0 * unit_float(bits) - 1) * 0.25 * p_.tile_jitter * radius_));
    const Tile other = bits % 2 == 1 ? g_.tile_of(ax + shift, ay) : g_.tile_of(ax, ay + shift);
    return g_.exists(other) ? other : own;
  }

  /// Tiles that move toward or away from this one: beside it at all, at a corner within 45 degrees of the line through
  /// both.
  Vec neighbour_max(Tile tile) const {
    Vec longest = g_.tile_max(tile);
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Vec v = g_.tile_max({tile.x + x, tile.y + y}), offset{double(x), double(y)};
        const double least = x != 0 && y != 0 ? std::sqrt(0.5) * length(v) * length(offset) * (1 + 1e-12) : 0;
        if (std::abs(dot(v, offset)) <= least) continue;
        if (length(v) > length(longest)) longest = v;
      }
    return longest;
  }

  double variance(Tile tile) const {
    double sum = 0;
    int count = 0;
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const Tile other{tile.x + x, tile.y + y};
        if ((x == 0 && y == 0) || !g_.exists(other)) continue;
        sum += std::abs(dot(norm(neighbour_max(tile)), norm(neighbour_max(other))));
        ++count;
      }
    return count > 0 ? 1 - sum / count : 0;
  }

  const motionblur::Guertin2014Params& p_;
  int radius_;
  Gather g_;
};

template <class Pixel>
std::vector<std::vector<double>> all_pixels(const BlurScene& scene, const Pixel& pixel) {
  std::vector<std::vector<double>> out(scene.channels.size());
  for (int y = 0; y < scene.window.height(); ++y)
    for (int x = 0; x < scene.window.width(); ++x) {
      const std::vector<double> colour = pixel(x, y);
      for (size_t c = 0; c < out.size(); ++c) out[c].push_back(colour[c]);
    }
  return out;
}

}  // namespace

std::vector<std::vector<double>> reference_blur(const motionblur::Mcguire2012Params& params, int radius,
                                                const BlurScene& scene) {
  const Gather gather(radius, scene);
  return all_pixels(scene, [&](int x, int y) { return mcguire_pixel(params, gather, x, y); });
}

std::vector<std::vector<double>> reference_blur(const motionblur::Guertin2014Params& params, int radius,
                                                const BlurScene& scene) {
  const Guertin guertin(params, radius, scene);
  return all_pixels(scene, [&](int x, int y) { return guertin.pixel(x, y); });
}

}  // namespace aftershade::tests
