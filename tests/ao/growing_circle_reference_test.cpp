#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "core/ao/growing_circle.h"
#include "core/math/sampling.h"
#include "tests/filter/analytic_surface.h"

/// The growing circle against a twin written from algorithms 5.2, and against its own continuous integral.
namespace aftershade::tests {
namespace {

using ao::CircleGrowth;
using ao::GrowingCircleParams;

double tap_occlusion(const Vec3& v, const Vec3& n, double radius, double bias) {
  const double length = v.length();
  return length == 0 ? 0 : std::max(0.0, n.dot(v) / length - bias) * std::clamp(1 - length / radius, 0.0, 1.0);
}

double share_of_radius(CircleGrowth growth, double t) { return growth == CircleGrowth::sqrt ? std::sqrt(t) : t; }

struct Twin {
  const GrowingCircleParams& params;
  const Picture& p;
  Lens lens;
  int screen_px;

  Vec3 point(int x, int y) const { return lens.point(p.origin_x + x + 0.5, p.origin_y + y + 0.5, p.depth(x, y)); }

  double visibility(int x, int y) const {
    if (!std::isfinite(p.depth(x, y))) return 1;
    const Vec3 centre = point(x, y), n(p.normals[0](x, y), p.normals[1](x, y), p.normals[2](x, y));
    const double scale = lens.orthographic ? 1 : 1 / centre.z;
    const double rx = params.radius_m * lens.fx * scale, ry = params.radius_m * lens.fy * scale;
    const double share = std::min(1.0, static_cast<double>(params.reach_screens) * screen_px / std::max(rx, ry));
    const double rotation =
        params.pixel_rotation
            ? static_cast<double>(kBayer4x4[static_cast<size_t>(((p.origin_y + y) & 3) * 4 + ((p.origin_x + x) & 3))])
            : 0;
    double sum = 0, inside = 0, all = 0;
    for (int i = 0; i < params.taps; ++i) {
      const double r = share_of_radius(params.growth, (i + 0.5) / params.taps) * share;
      const double angle = 2 * std::numbers::pi * (i * (2 - std::numbers::phi) + rotation);
      const int tx = x + static_cast<int>(std::lround(std::cos(angle) * r * rx));
      const int ty = y + static_cast<int>(std::lround(std::sin(angle) * r * ry));
      all += 1 - r;
      if (tx < 0 || ty < 0 || tx >= p.depth.width() || ty >= p.depth.height()) continue;
      inside += 1 - r;
      if (std::isfinite(p.depth(tx, ty))) sum += tap_occlusion(point(tx, ty) - centre, n, params.radius_m, params.bias);
    }
    return inside == 0 ? 1 : 1 - std::min(1.0, params.strength * sum / params.taps * all / inside);
  }
};

/// Bumps of several sizes around a hole of background.
View bumps(const Lens& lens) {
  return [=](double x, double y) {
    if (x > 60 && x < 80 && y > 30 && y < 45) return Hit{};
    const double u = x / 17, v = y / 11;
    const double z = 3 + 0.4 * std::sin(u) * std::cos(v) + (x + 2 * y > 150 ? 0.7 : 0.0);
    return Hit{z, (lens.ray(x, y) * -1 + Vec3(0.3 * std::cos(u), 0.2 * std::sin(v), 0)).normalized()};
  };
}

TEST(GrowingCircleReference, AgreesWithTheTwin) {
  int variants = 0;
  for (const bool orthographic : {false, true})
    for (const CircleGrowth growth : {CircleGrowth::linear, CircleGrowth::sqrt})
      for (const float screens : {0.5F, 0.1F}) {
        const Lens lens{120, 100, 71, 43, orthographic};
        const Picture p = picture(141, 97, lens, bumps(lens), -5, 3);
        GrowingCircleParams params;
        params.growth = growth;
        params.reach_screens = screens;
        params.pixel_rotation = variants++ % 3 != 0;
        const Plane fast = ao::growing_circle(params, p.surface(), filter::full_grid(p.surface()), 141, 0);
        const Twin twin{params, p, lens, 141};
        int off = 0;
        double dark = 0;
        for (int y = 0; y < p.depth.height(); ++y)
          for (int x = 0; x < p.depth.width(); ++x) {
            const double exact = twin.visibility(x, y);
            off += !(std::abs(fast(x, y) - exact) < 2e-5);  // a tap whose position rounds the other way
            dark += 1 - exact;
          }
        EXPECT_LT(off, 141 * 97 / 500) << orthographic << screens << static_cast<int>(growth);
        EXPECT_GT(dark, 300);
      }
}

/// A floor and a perpendicular wall seen from 45 degrees: z = z0 - |Y|, distance from the edge sqrt(2) |Y|.
constexpr float kCornerFocal = 260;
Picture corner(int columns) {
  const Lens lens{kCornerFocal, kCornerFocal, 0, 0, true};
  return picture(
      columns, 640, lens,
      [](double, double y) {
        const double h = -y / static_cast<double>(kCornerFocal);
        return Hit{10 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
      },
      -columns / 2, -320);
}

/// Occlusion in the limit of infinitely many taps, radius 1.
double corner_integral(const GrowingCircleParams& params, double distance) {
  const double h = -distance / std::numbers::sqrt2;
  const Vec3 n = Vec3(0, 1, -1).normalized();
  constexpr int kRadii = 1000, kAngles = 720;
  double sum = 0;
  for (int k = 0; k < kAngles; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / kAngles, x = std::cos(angle), y = std::sin(angle);
    for (int i = 0; i < kRadii; ++i) {
      const double r = share_of_radius(params.growth, (i + 0.5) / kRadii);
      sum += tap_occlusion({r * x, r * y, std::abs(h) - std::abs(h + r * y)}, n, 1, params.bias);
    }
  }
  return std::min(1.0, params.strength * sum / kRadii / kAngles);
}

struct Spread {
  double mean = 0, deviation = 0;
};

/// Mean and deviation over four pixels of row `y` in the middle and 64 frames' rotations.
Spread corner_occlusion(GrowingCircleParams params, const Picture& p, int row) {
  params.per_frame_noise = true;
  filter::SampleGrid grid;
  grid.step = 2;  // AO only where it is looked at: 4 picked pixels
  grid.depth = Plane(4, 1, p.depth(0, row));
  grid.pixel_x = Plane(4, 1);
  grid.pixel_y = Plane(4, 1, static_cast<float>(row));
  for (int x = 0; x < 4; ++x) grid.pixel_x(x, 0) = static_cast<float>(p.depth.width() / 2 + x);
  double sum = 0, squares = 0;
  constexpr int kFrames = 64;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Plane out = ao::growing_circle(params, p.surface(), grid, 640, frame);
    for (int x = 0; x < 4; ++x) {
      sum += 1 - out(x, 0);
      squares += std::pow(1 - out(x, 0), 2);
    }
  }
  const double n = 4 * kFrames, mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

TEST(GrowingCircleReference, CornerMatchesItsContinuousIntegralAndSixteenTapsScatterAroundIt) {
  const Picture p = corner(640);
  for (const CircleGrowth growth : {CircleGrowth::linear, CircleGrowth::sqrt})
    for (const double wanted : {.05, .10, .20, .35, .50, .70}) {  // algorithms 12.1
      GrowingCircleParams params;
      params.growth = growth;
      params.radius_m = 1;
      params.strength = 2.5F;  // never saturates: the mean of what is clamped would be another integral
      const int row = 320 + static_cast<int>(wanted / std::numbers::sqrt2 * static_cast<double>(kCornerFocal));
      const double distance = (row + 0.5 - 320) / static_cast<double>(kCornerFocal) * std::numbers::sqrt2;
      const double exact = corner_integral(params, distance);
      const Spread literal = corner_occlusion(params, p, row);
      params.taps = 768;
      const Spread many = corner_occlusion(params, p, row);
      std::printf("%s d = %.4f: integral %.4f, 768 taps %.4f +- %.4f, 16 taps %.4f +- %.4f\n",
                  growth == CircleGrowth::sqrt ? "sqrt  " : "linear", distance, exact, many.mean, many.deviation,
                  literal.mean, literal.deviation);
      EXPECT_NEAR(many.mean, exact, 0.002);
      EXPECT_NEAR(literal.mean, exact, 0.01) << "rotations average 16 taps to about the same";
      EXPECT_LT(literal.deviation, 0.06);
    }
}

}  // namespace
}  // namespace aftershade::tests
