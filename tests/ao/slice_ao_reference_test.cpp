#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "core/ao/reference_ao.h"
#include "core/ao/slice_ao.h"
#include "core/ao/thickness.h"
#include "core/math/sampling.h"
#include "tests/filter/analytic_surface.h"

/// Slice AO against a twin in double; it and rays through the depth buffer against the corner table.
namespace aftershade::tests {
namespace {

using ao::ReferenceAoParams;
using ao::SliceAoParams;

/// One pixel, straight from the definition: every slice a mask of 100000 elevations, summed with cos(t - gamma) sin t.
struct Twin {
  const SliceAoParams& params;
  const Picture& p;
  const Plane& thickness;
  Lens lens;

  Vec3 point(int x, int y) const { return lens.point(p.origin_x + x + 0.5, p.origin_y + y + 0.5, p.depth(x, y)); }

  double visibility(int x, int y) const {
    const Vec3 centre = point(x, y), n(p.normals[0](x, y), p.normals[1](x, y), p.normals[2](x, y));
    const Vec3 view = lens.orthographic ? Vec3(0, 0, -1) : centre.normalized() * -1;
    const Vec3 s = view.cross(std::abs(view.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)).normalized(), t = view.cross(s);
    const double shift = kBayer4x4[static_cast<size_t>(((p.origin_y + y) & 3) * 4 + ((p.origin_x + x) & 3))];
    double hidden = 0, whole = 0;
    for (int k = 0; k < 2 * params.slices; ++k) {
      const double angle = std::numbers::pi * (k + shift) / params.slices;
      side(centre, n, view, s * std::cos(angle) + t * std::sin(angle), x, y, hidden, whole);
    }
    return 1 - hidden / whole;
  }

  void side(const Vec3& centre, const Vec3& n, const Vec3& view, const Vec3& across, int x, int y, double& hidden,
            double& whole) const {
    const Vec3 beside = across.cross(view);
    const double nd = n.dot(across), nv = n.dot(view), weight = std::hypot(nd, nv), gamma = std::atan2(nd, nv);
    constexpr int kParts = 20000;
    std::vector<bool> mask(kParts, false);
    const double end = gamma + std::numbers::pi / 2;
    const Vec3 far = centre + across * (0.001 * centre.z);  // a nearby point fixes the line in the image
    const double scale = lens.orthographic ? 1 : far.z, here = lens.orthographic ? 1 : centre.z;
    double dx = lens.fx * (far.x / scale - centre.x / here), dy = -lens.fy * (far.y / scale - centre.y / here);
    const double longest = std::max(std::abs(dx), std::abs(dy));
    dx /= longest;
    dy /= longest;
    for (int i = 1; i < p.depth.width() + p.depth.height(); ++i) {
      const int sx = x + static_cast<int>(std::floor(dx * i + 0.5)),
                sy = y + static_cast<int>(std::floor(dy * i + 0.5));
      if (sx < 0 || sy < 0 || sx >= p.depth.width() || sy >= p.depth.height()) break;
      if (!(std::isfinite(p.depth(sx, sy)) && p.depth(sx, sy) > 0)) continue;
      const Vec3 front = point(sx, sy), ray = lens.orthographic ? Vec3(0, 0, 1) : front.normalized(),
                 d = front - centre;
      const double c = d.dot(beside), ne = n.dot(beside);
      double low = 9, high = -9;
      constexpr int kPieces = 400;  // points of the thing's depth that lie inside the sphere
      for (int j = 0; j <= kPieces; ++j) {
        const double l = static_cast<double>(thickness(sx, sy)) * j / kPieces;
        const double a = d.dot(across) + c * ne * nd / (weight * weight) + l * ray.dot(across),
                     b = d.dot(view) + c * ne * nv / (weight * weight) + l * ray.dot(view);
        if (a * a + b * b > static_cast<double>(params.radius_m) * static_cast<double>(params.radius_m) || a <= 0)
          continue;
        low = std::min(low, std::atan2(a, b));
        high = std::max(high, std::atan2(a, b));
      }
      for (int m = std::max(0, static_cast<int>(low / end * kParts)); m < std::min(kParts * 1.0, high / end * kParts);
           ++m)
        mask[static_cast<size_t>(m)] = true;
    }
    for (int m = 0; m < kParts; ++m) {
      const double theta = end * (m + 0.5) / kParts,
                   part = weight * std::cos(theta - gamma) * std::sin(theta) * end / kParts;
      whole += part;
      hidden += mask[static_cast<size_t>(m)] ? part : 0;
    }
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

TEST(SliceAoReference, AgreesWithTheTwin) {
  for (const bool orthographic : {false, true}) {
    const float f = orthographic ? 30.0F : 90.0F;
    const Lens lens{f, f * 0.9F, 71, 43, orthographic};
    const Picture p = picture(141, 97, lens, bumps(lens), -5, 3);
    SliceAoParams params;
    params.slices = 3;
    params.steps = 0;
    params.pixel_filter_px = 0;
    params.border = ao::Border::open;
    const Plane thickness = ao::thickness_map(params, p.depth, p.projection);
    const Plane fast = ao::slice_ao(params, p.surface(), filter::full_grid(p.surface()), 0);
    const Twin twin{params, p, thickness, lens};
    int off = 0, all = 0;
    double dark = 0;
    for (int y = 2; y < 97; y += 9)
      for (int x = 1; x < 141; x += 7) {
        if (!std::isfinite(p.depth(x, y))) continue;
        const double exact = twin.visibility(x, y);
        off += !(std::abs(fast(x, y) - exact) < 2e-3);
        dark += 1 - exact;
        ++all;
      }
    EXPECT_LE(off, all / 50) << orthographic << " of " << all;
    EXPECT_GT(dark, all / 50);
  }
}

/// A floor and a perpendicular wall seen from 45 degrees, R = 1: z = z0 - |Y|, distance from the edge sqrt(2) |Y|.
constexpr float kFocal = 260;
struct CornerRow {
  double distance, cosine, uniform_squared;
};
// algorithms 12.1: "ref cosine hard R" and "ref uniform 1-r^2"; "GTAO hard R" is within 0.001 of the first.
constexpr CornerRow kTable[] = {{.05, .469, .451}, {.10, .437, .405}, {.20, .374, .320},
                                {.35, .282, .211}, {.50, .195, .125}, {.70, .094, .045}};
const Picture& corner() {
  static const Picture made = picture(
      640, 640, Lens{kFocal, kFocal, 0, 0, true},
      [](double, double y) {
        const double h = -y / static_cast<double>(kFocal);
        return Hit{10 - std::abs(h), Vec3(0, h > 0 ? -1 : 1, -1).normalized()};
      },
      -320, -320);
  return made;
}
/// 16 pixels around the row, interpolated to `distance` by a line through two rows.
template <class Ao>
double corner_occlusion(double distance, const Ao& occlusion_of) {
  const double row = 320 + distance / std::numbers::sqrt2 * static_cast<double>(kFocal) - 0.5;
  const int first = static_cast<int>(std::floor(row));
  filter::SampleGrid grid;
  grid.step = 2;
  grid.depth = Plane(4, 4);
  grid.pixel_x = Plane(4, 4);
  grid.pixel_y = Plane(4, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      grid.pixel_x(x, y) = static_cast<float>(318 + x);
      grid.pixel_y(x, y) = static_cast<float>(first + (y & 1));
      grid.depth(x, y) = corner().depth(318 + x, first + (y & 1));
    }
  const Plane out = occlusion_of(corner().surface(), grid);
  double sum = 0;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      sum += (1 - static_cast<double>(out(x, y))) * ((y & 1) != 0 ? row - first : first + 1 - row) / 8;
  return sum;
}

TEST(SliceAoReference, CornerTable) {
  SliceAoParams slices;
  slices.slices = 32;
  slices.steps = 0;
  slices.pixel_filter_px = 0;
  ReferenceAoParams rays;
  rays.rays = 2048;
  rays.pixel_filter_px = 0;
  ReferenceAoParams uniform = rays;
  uniform.weighting = ao::RayWeighting::uniform;
  uniform.falloff = ao::RayFalloff::squared;
  for (const CornerRow& entry : kTable) {
    const double sliced = corner_occlusion(
        entry.distance, [&](const auto& surface, const auto& grid) { return ao::slice_ao(slices, surface, grid, 0); });
    const double traced = corner_occlusion(
        entry.distance, [&](const auto& surface, const auto& grid) { return ao::reference_ao(rays, surface, grid); });
    const double squared = corner_occlusion(entry.distance, [&](const auto& surface, const auto& grid) {
      return ao::reference_ao(uniform, surface, grid);
    });
    std::printf("d = %.2f: slices %.4f, rays %.4f (table %.3f); uniform 1-r^2 %.4f (table %.3f)\n", entry.distance,
                sliced, traced, entry.cosine, squared, entry.uniform_squared);
    EXPECT_NEAR(sliced, entry.cosine, 0.01);
    EXPECT_NEAR(traced, entry.cosine, 0.003);
    EXPECT_NEAR(squared, entry.uniform_squared, 0.003);
  }
}

}  // namespace
}  // namespace aftershade::tests
