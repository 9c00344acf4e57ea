#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "core/ao/scalable_ao.h"
#include "core/ao/tap_pattern.h"
#include "core/math/sampling.h"
#include "tests/filter/analytic_surface.h"

/// Scalable AO against a twin written from the slides, and against its own continuous integral.
namespace aftershade::tests {
namespace {

using ao::DistanceFalloff;
using ao::RadiusClamp;
using ao::ScalableAoParams;
using ao::TapPattern;

/// AO_s of the "Falloff Function" slide, with the bias of its text, and the falloffs of algorithms 4.3.
double distance_falloff(DistanceFalloff kind, double d) {
  if (d >= 1) return 0;
  switch (kind) {
    case DistanceFalloff::linear:
      return 1 - d;
    case DistanceFalloff::quadratic:
      return 1 - d * d;
    case DistanceFalloff::cubic:
      return std::pow(1 - d * d, 3);
    case DistanceFalloff::none:
      break;
  }
  return 1;
}
double falloff(const Vec3& v, const Vec3& n, double r, const ScalableAoParams& params) {
  const double length = v.length(), bias = static_cast<double>(params.bias),
               bias_m = static_cast<double>(params.bias_m);
  if (length == 0) return 0;
  return distance_falloff(params.falloff, length / r) * std::max((v.dot(n) - bias_m) / length - bias, 0.0);
}

struct Twin {
  const ScalableAoParams& params;
  const Picture& p;
  Lens lens;

  bool is_surface(int x, int y) const { return std::isfinite(p.depth(x, y)) && p.depth(x, y) > 0; }
  Vec3 point(int x, int y) const { return lens.point(p.origin_x + x + 0.5, p.origin_y + y + 0.5, p.depth(x, y)); }

  /// The pixel whose depth level m holds over pixel (x, y): z_m(X,Y) = z_{m-1}(2X + (Y&1), 2Y + (X&1)), clamped.
  std::pair<int, int> source(int x, int y, int m) const {
    int X = (p.origin_x + x) >> m, Y = (p.origin_y + y) >> m;
    for (int k = m - 1; k >= 0; --k) {
      const int nx = 2 * X + (Y & 1), ny = 2 * Y + (X & 1);
      X = std::clamp(nx, p.origin_x >> k, (p.origin_x + p.depth.width() - 1) >> k);
      Y = std::clamp(ny, p.origin_y >> k, (p.origin_y + p.depth.height() - 1) >> k);
    }
    return {X - p.origin_x, Y - p.origin_y};
  }

  double visibility(int x, int y) const {
    double sum = 0;
    for (int pass = 0; pass < params.passes; ++pass) sum += visibility_of_pass(x, y, pass);
    return sum / params.passes;
  }

  double visibility_of_pass(int x, int y, int pass) const {
    if (!is_surface(x, y)) return 1;
    const Vec3 centre = point(x, y), n(p.normals[0](x, y), p.normals[1](x, y), p.normals[2](x, y));
    const bool mirrored = params.pattern == TapPattern::mirrored;
    const int directions = mirrored ? params.taps / 2 : params.taps;
    const double scale = lens.orthographic ? 1 : 1 / centre.z;
    const double r_y = params.radius_m * lens.fy * scale;
    const double limit =
        static_cast<double>(params.max_radius_px) * p.display_height / static_cast<double>(params.reference_height_px);
    const double share = params.max_radius_px > 0 ? std::min(1.0, limit / r_y) : 1;
    const double falloff_radius = params.radius_m * (params.radius_clamp == RadiusClamp::radius ? share : 1);
    const double bayer = kBayer4x4[static_cast<size_t>(((p.origin_y + y) & 3) * 4 + ((p.origin_x + x) & 3))];
    const double rotation = bayer * (mirrored ? 0.5 : 1.0) + pass * 0.6180339887498949;
    double sum = 0;
    double inside = 0, all = 0;
    for (int i = 0; i < directions; ++i)
      for (int sign = 1; sign >= (mirrored ? -1 : 1); sign -= 2) {
        const double alpha = (i + 0.5) / directions;
        all += distance_falloff(params.falloff, alpha);
        const double turns = (mirrored ? 0.5 : 1.0) * alpha * ao::spiral_turns(directions) + rotation;
        const double angle = 2 * std::numbers::pi * turns;
        const double rx = alpha * params.radius_m * lens.fx * scale * share, ry = alpha * r_y * share;
        const int tx = x + static_cast<int>(std::lround(sign * std::cos(angle) * std::max(0.75, rx)));
        const int ty = y + static_cast<int>(std::lround(sign * std::sin(angle) * std::max(0.75, ry)));
        if (tx < 0 || ty < 0 || tx >= p.depth.width() || ty >= p.depth.height()) continue;
        inside += distance_falloff(params.falloff, alpha);
        const int level = std::clamp(static_cast<int>(std::floor(std::log2(std::max({0.75, rx, ry})))) - 3, 0, 5);
        const auto [sx, sy] = params.depth_mips ? source(tx, ty, level) : std::pair(tx, ty);
        if (is_surface(sx, sy)) sum += falloff(point(sx, sy) - centre, n, falloff_radius, params);
      }
    const int taps = mirrored ? 2 * directions : directions;
    const double total = inside == 0 ? 0 : 2 * static_cast<double>(params.scale) / taps * sum * all / inside;
    return 1 - std::min(1.0, params.squared ? total * total : total);
  }
};

/// Bumps of several sizes in front of a hole of background.
View bumps(const Lens& lens) {
  return [=](double x, double y) {
    if (x > 60 && x < 80 && y > 30 && y < 45) return Hit{};
    const double u = x / 17, v = y / 11;
    const double z = 3 + 0.4 * std::sin(u) * std::cos(v) + (x + 2 * y > 150 ? 0.7 : 0.0);
    return Hit{z, (lens.ray(x, y) * -1 + Vec3(0.3 * std::cos(u), 0.2 * std::sin(v), 0)).normalized()};
  };
}

void expect_twin(const ScalableAoParams& params, const Picture& p, const Lens& lens) {
  const filter::DepthPyramid pyramid(p.depth, 6, p.origin_x, p.origin_y);
  const Plane fast = ao::scalable_ao(params, p.surface(), pyramid, filter::full_grid(p.surface()), 0);
  const Twin twin{params, p, lens};
  int off = 0;
  double dark = 0;
  for (int y = 0; y < p.depth.height(); ++y)
    for (int x = 0; x < p.depth.width(); ++x) {
      const double exact = twin.visibility(x, y);
      off += !(std::abs(fast(x, y) - exact) < 2e-4);  // a tap whose position rounds the other way
      dark += 1 - exact;
    }
  const int allowed = params.passes * p.depth.width() * p.depth.height() / 1000;
  EXPECT_LT(off, allowed) << params::write(ScalableAoParams::table(), &params);
  EXPECT_GT(dark, 500) << params::write(ScalableAoParams::table(), &params);
}

TEST(ScalableAoReference, AgreesWithTheTwin) {
  int variants = 0;
  for (const bool orthographic : {false, true})
    for (const bool mips : {false, true})
      for (const TapPattern pattern : {TapPattern::mirrored, TapPattern::spiral}) {
        const Lens lens{120, 100, 71, 43, orthographic};
        const Picture p = picture(141, 97, lens, bumps(lens), -5, 3);
        ScalableAoParams params;
        params.pattern = pattern;
        params.taps = pattern == TapPattern::mirrored ? 6 : 9;
        params.depth_mips = mips;
        params.max_radius_px = variants % 2 == 0 ? 0.0F : 20.0F;
        params.reference_height_px = 97;
        expect_twin(params, p, lens);
        ++variants;
      }
}

TEST(ScalableAoReference, AgreesWithTheTwinWhereTheSlidesLeaveRoom) {
  const Lens lens{120, 100, 71, 43};
  const Picture p = picture(141, 97, lens, bumps(lens), -5, 3);
  ScalableAoParams params;
  params.scale = 1.5F;
  for (const DistanceFalloff falloff :
       {DistanceFalloff::linear, DistanceFalloff::quadratic, DistanceFalloff::cubic, DistanceFalloff::none}) {
    params.falloff = falloff;
    expect_twin(params, p, lens);
  }
  ScalableAoParams text;  // "before normalizing the vector we apply a small bias"
  text.bias = 0;
  text.bias_m = 0.03F;
  expect_twin(text, p, lens);
  ScalableAoParams clamped;
  clamped.max_radius_px = 15;
  clamped.reference_height_px = 97;
  clamped.radius_clamp = RadiusClamp::taps;
  expect_twin(clamped, p, lens);
  ScalableAoParams linear_sum;
  linear_sum.squared = false;
  linear_sum.scale = 1;
  expect_twin(linear_sum, p, lens);
  ScalableAoParams repeated;
  repeated.passes = 3;
  repeated.taps = 4;
  expect_twin(repeated, p, lens);
  repeated.pattern = TapPattern::mirrored;
  expect_twin(repeated, p, lens);
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

/// The estimator in the limit of infinitely many taps, radius 1, scale 1, bias 0: taps uniform in radius and in angle.
double corner_integral(double distance) {
  const double h = -distance / std::numbers::sqrt2;
  const Vec3 n = Vec3(0, 1, -1).normalized();
  constexpr int kRadii = 1000, kAngles = 720;
  ScalableAoParams params;
  params.bias = 0;
  double sum = 0;
  for (int k = 0; k < kAngles; ++k) {
    const double angle = 2 * std::numbers::pi * (k + 0.5) / kAngles, x = std::cos(angle), y = std::sin(angle);
    for (int i = 0; i < kRadii; ++i) {
      const double r = (i + 0.5) / kRadii, tap_h = h + r * y;
      sum += falloff({r * x, r * y, std::abs(h) - std::abs(tap_h)}, n, 1, params);
    }
  }
  return std::pow(2 * sum / kRadii / kAngles, 2);
}

/// Mean and spread over pixels of row `y` in the middle 4 columns, over many rotations.
struct Spread {
  double mean = 0, deviation = 0;
};
Spread corner_occlusion(ScalableAoParams params, const Picture& p, int row) {
  params.resolution = ao::Resolution::full;
  params.per_frame_noise = true;
  const filter::DepthPyramid pyramid(p.depth, 1);
  filter::SampleGrid grid;
  grid.step = 2;  // AO only where it is looked at: 4 picked pixels
  grid.depth = Plane(4, 1, p.depth(0, row));
  grid.pixel_x = Plane(4, 1);
  grid.pixel_y = Plane(4, 1, static_cast<float>(row));
  for (int x = 0; x < 4; ++x) grid.pixel_x(x, 0) = static_cast<float>(p.depth.width() / 2 + x);
  double sum = 0, squares = 0;
  constexpr int kFrames = 64;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Plane out = ao::scalable_ao(params, p.surface(), pyramid, grid, frame);
    for (int x = 0; x < 4; ++x) {
      sum += 1 - out(x, 0);
      squares += std::pow(1 - out(x, 0), 2);
    }
  }
  const double n = 4 * kFrames, mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

TEST(ScalableAoReference, CornerMatchesItsContinuousIntegralAndTheTable) {
  // algorithms 12.1, column "VV scale 1"
  const std::pair<double, double> table[] = {{.05, .047}, {.10, .032}, {.20, .015},
                                             {.35, .005}, {.50, .001}, {.70, .000}};
  const Picture p = corner(640);
  ScalableAoParams params;
  params.taps = 768;
  params.scale = 1;
  params.bias = 0;
  params.depth_mips = false;
  for (const auto& [wanted, published] : table) {
    const int row = 320 + static_cast<int>(wanted / std::numbers::sqrt2 * kCornerFocal);
    const double distance = (row + 0.5 - 320) / kCornerFocal * std::numbers::sqrt2;
    const Spread measured = corner_occlusion(params, p, row);
    std::printf("d = %.4f (table %.2f): integral %.4f, measured %.4f, published %.3f\n", distance, wanted,
                corner_integral(distance), measured.mean, published);
    EXPECT_NEAR(measured.mean, corner_integral(distance), 0.001);
    EXPECT_NEAR(corner_integral(wanted), published, 0.001);
  }
}

TEST(ScalableAoReference, FewTapsScatterAroundTheIntegral) {
  const Picture p = corner(640);
  const int row = 320 + static_cast<int>(0.1 / std::numbers::sqrt2 * kCornerFocal);
  const double exact = corner_integral((row + 0.5 - 320) / kCornerFocal * std::numbers::sqrt2);
  ScalableAoParams params;
  params.scale = 1;
  params.bias = 0;
  params.depth_mips = false;
  for (const auto& [pattern, taps] : {std::pair(TapPattern::mirrored, 4), std::pair(TapPattern::spiral, 9)}) {
    params.pattern = pattern;
    params.taps = taps;
    const Spread few = corner_occlusion(params, p, row);
    std::printf("%d taps at d = 0.1 R: mean %.4f, deviation %.4f, integral %.4f\n", taps, few.mean, few.deviation,
                exact);
    // E[x^2] = E[x]^2 + variance: the square makes few taps darker than many.
    EXPECT_GT(few.mean, 0.5 * exact);
    EXPECT_LT(few.mean, 3 * exact);
    EXPECT_LT(few.deviation, 2 * exact);
  }
}

}  // namespace
}  // namespace aftershade::tests
