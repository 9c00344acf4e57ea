#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "core/ao/ball_samples.h"
#include "core/ao/sphere_kernel.h"
#include "tests/filter/analytic_surface.h"

/// The sphere kernel against a twin written from its description, and against its own continuous integral.
namespace aftershade::tests {
namespace {

using ao::SphereSamples;
using ao::SphereVolume;

bool is_surface(double z) { return std::isfinite(z) && z > 0; }

double smoothstep(double x) { return x * x * (3 - 2 * x); }

struct Twin {
  const SphereSamples& params;
  const Picture& p;
  Lens lens;

  Vec3 point(int x, int y) const { return lens.point(p.origin_x + x + 0.5, p.origin_y + y + 0.5, p.depth(x, y)); }

  Vec3 offset(int i, int x, int y, const Vec3& n) const {
    const auto k = static_cast<size_t>(i);
    Vec3 o(ao::ball_samples().x[k], ao::ball_samples().y[k], ao::ball_samples().z[k]);
    const auto cell = static_cast<size_t>(((p.origin_y + y) & 3) * 4 + ((p.origin_x + x) & 3));
    const Vec3 mirror(ao::mirror_tile().x[cell], ao::mirror_tile().y[cell], ao::mirror_tile().z[cell]);
    if (params.dither) o -= mirror * (2 * o.dot(mirror));
    if (params.volume == SphereVolume::hemisphere && o.dot(n) < 0) o = -o;
    return o;
  }

  double visibility(int x, int y, int first, int count) const {
    if (!is_surface(p.depth(x, y))) return 1;
    const Vec3 centre = point(x, y), n(p.normals[0](x, y), p.normals[1](x, y), p.normals[2](x, y));
    double sum = 0;
    int inside = 0;
    for (int i = first; i < first + count; ++i) {
      const Vec3 s = centre + offset(i % ao::kSequenceLength, x, y, n) * static_cast<double>(params.radius_m);
      if (s.z <= 0) continue;
      const double scale = lens.orthographic ? 1 : 1 / s.z;
      const int tx = static_cast<int>(std::floor(lens.cx + lens.fx * s.x * scale)) - p.origin_x;
      const int ty = static_cast<int>(std::floor(lens.cy - lens.fy * s.y * scale)) - p.origin_y;
      if (tx < 0 || ty < 0 || tx >= p.depth.width() || ty >= p.depth.height()) continue;
      ++inside;
      const double z = p.depth(tx, ty);
      if (!is_surface(z)) continue;
      const double hidden = z < s.z ? 1 : 0;
      if (params.volume == SphereVolume::sphere) {
        sum += hidden + (0.5 - hidden) * std::clamp((centre.z - z) / z, 0.0, 1.0);
      } else if ((point(tx, ty) - centre).dot(n) > params.bias * params.radius_m) {
        sum += hidden * smoothstep(std::min(1.0, params.radius_m / std::abs(centre.z - z)));
      }
    }
    if (inside == 0) return 1;
    const double open = 1 - sum / inside;
    return params.volume == SphereVolume::sphere ? std::clamp(open * open + open, 0.0, 1.0) : open;
  }
};

View bumps(const Lens& lens) {
  return [=](double x, double y) {
    if (x > 60 && x < 80 && y > 30 && y < 45) return Hit{};
    const double u = x / 17, v = y / 11;
    const double z = 3 + 0.4 * std::sin(u) * std::cos(v) + (x + 2 * y > 150 ? 1.9 : 0.0);
    return Hit{z, (lens.ray(x, y) * -1 + Vec3(0.3 * std::cos(u), 0.2 * std::sin(v), 0)).normalized()};
  };
}

TEST(SphereKernelReference, AgreesWithTheTwin) {
  for (const bool orthographic : {false, true})
    for (const SphereVolume volume : {SphereVolume::hemisphere, SphereVolume::sphere})
      for (const bool dither : {false, true}) {
        const Lens lens{120, 100, 71, 43, orthographic};
        const Picture p = picture(141, 97, lens, bumps(lens), -5, 3);
        SphereSamples params;
        params.volume = volume;
        params.dither = dither;
        params.radius_m = orthographic ? 0.3F : 0.6F;
        const Plane fast = ao::sphere_kernel(params, p.surface(), filter::full_grid(p.surface()), {4090, 24, {}, {}});
        const Twin twin{params, p, lens};
        int off = 0;
        double dark = 0;
        for (int y = 0; y < p.depth.height(); ++y)
          for (int x = 0; x < p.depth.width(); ++x) {
            const double exact = twin.visibility(x, y, 4090, 24);
            off += !(std::abs(fast(x, y) - exact) < 1e-4);  // a test that rounds the other way
            dark += 1 - exact;
          }
        EXPECT_LT(off, 141 * 97 / 500) << orthographic << dither << static_cast<int>(volume);
        EXPECT_GT(dark, 500);
      }
}

/// A floor and a perpendicular wall seen from 45 degrees: z = z0 - |Y|, distance from the edge sqrt(2) |Y|.
constexpr float kFocal = 260;
Picture corner() {
  const Lens lens{kFocal, kFocal, 0, 0, true};
  return picture(
      540, 640, lens,
      [](double, double y) {
        const double h = -y / static_cast<double>(kFocal);
        return Hit{10 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
      },
      -270, -320);
}

/// The estimator in the limit of infinitely many points, radius 1: the hidden share of the half ball, sliced across x.
double corner_integral(double distance, double bias) {
  const double h = -distance / std::numbers::sqrt2;
  constexpr int kSteps = 2000;
  double hidden = 0, all = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double y = 2 * (i + 0.5) / kSteps - 1, z = 2 * (j + 0.5) / kSteps - 1;
      const double chord = 1 - y * y - z * z;
      if (chord <= 0 || y - z < 0) continue;  // below the floor, whose normal is (0, 1, -1) / sqrt(2)
      const double weight = std::sqrt(chord), seen = std::abs(h) - std::abs(h + y);  // relative to p
      const bool above = (y - seen) / std::numbers::sqrt2 > bias;
      all += weight;
      hidden += above && seen < z ? weight : 0;
    }
  return hidden / all;
}

struct Spread {
  double mean = 0, deviation = 0;
};
/// Over 64 frames and the 4x4 phases of the tile, at distance row + 0.5 px from the edge.
Spread corner_occlusion(const Picture& p, int row, int samples) {
  SphereSamples params;
  filter::SampleGrid grid;
  grid.step = 2;  // AO only where it is looked at: 4 picked pixels
  grid.depth = Plane(4, 1, p.depth(0, row));
  grid.pixel_x = Plane(4, 1);
  grid.pixel_y = Plane(4, 1, static_cast<float>(row));
  for (int x = 0; x < 4; ++x) grid.pixel_x(x, 0) = static_cast<float>(p.depth.width() / 2 + x);
  double sum = 0, squares = 0;
  constexpr int kFrames = 64;
  for (int frame = 0; frame < kFrames; ++frame) {
    const Plane out =
        ao::sphere_kernel(params, p.surface(), grid, {ao::first_of_frame(frame, samples), samples, {}, {}});
    for (int x = 0; x < 4; ++x) {
      sum += 1 - out(x, 0);
      squares += std::pow(1 - out(x, 0), 2);
    }
  }
  const double n = 4 * kFrames, mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

TEST(SphereKernelReference, CornerMatchesItsContinuousIntegral) {
  const Picture p = corner();
  for (const double wanted : {.05, .10, .20, .35, .50, .70}) {
    const int row = 320 + static_cast<int>(wanted / std::numbers::sqrt2 * kFocal);
    const double distance = (row + 0.5 - 320) / kFocal * std::numbers::sqrt2;
    const double exact = corner_integral(distance, SphereSamples{}.bias);
    const Spread many = corner_occlusion(p, row, ao::kSequenceLength), literal = corner_occlusion(p, row, 16);
    std::printf("d/R = %.4f (table %.2f): integral %.4f, %d points %.4f, 16 points %.4f +- %.4f\n", distance, wanted,
                exact, ao::kSequenceLength, many.mean, literal.mean, literal.deviation);
    EXPECT_NEAR(many.mean, exact, 0.01);
    EXPECT_NEAR(literal.mean, exact, 0.01) << "unbiased";
    EXPECT_LT(literal.deviation, 0.09) << "16 independent points would scatter by up to 0.125";
  }
}

TEST(SphereKernelReference, WithoutBiasTheCornersFootIsHalfHidden) {
  EXPECT_NEAR(corner_integral(1e-6, 0), 0.5, 1e-3);
  EXPECT_NEAR(corner_integral(1.0, 0), 0, 1e-3);
}

}  // namespace
}  // namespace aftershade::tests
