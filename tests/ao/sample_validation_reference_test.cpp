#include <gtest/gtest.h>

#include "core/ao/ball_samples.h"
#include "core/ao/sample_validation.h"
#include "core/math/sampling.h"
#include "tests/filter/analytic_surface.h"

/// Neighbourhood validation against a twin written from algorithms 6.
namespace aftershade::tests {
namespace {

using ao::PastSurface;
using ao::SphereSamples;
using ao::ValidationParams;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool is_surface(double z) { return std::isfinite(z) && z > 0; }

struct Twin {
  const SphereSamples& params;
  const ValidationParams& validation;
  const Picture& now;
  const PastSurface& past;
  Lens lens;  ///< of both frames, whose windows start at (0, 0)

  struct Old {
    bool inside = false, seen = false;
    Vec3 point;
  };
  Old old_point(double x, double y) const {
    const int nx = static_cast<int>(std::floor(x)), ny = static_cast<int>(std::floor(y));
    if (std::isnan(x) || nx < 0 || ny < 0 || nx >= past.depth.width || ny >= past.depth.height) return {};
    const double nearest = past.depth(nx, ny);
    if (!is_surface(nearest)) return {true, false, {}};
    double sum = 0, weights = 0;
    for (int j = ny - 1; j <= ny + 1; ++j)
      for (int i = nx - 1; i <= nx + 1; ++i) {
        const double w = std::max(0.0, 1 - std::abs(x - i - 0.5)) * std::max(0.0, 1 - std::abs(y - j - 0.5));
        if (w == 0 || i < 0 || j < 0 || i >= past.depth.width || j >= past.depth.height) continue;
        if (!(std::abs(1 - past.depth(i, j) / nearest) < past.same_depth)) continue;
        sum += w * (lens.orthographic ? past.depth(i, j) : 1.0 / past.depth(i, j)), weights += w;
      }
    const double z = lens.orthographic ? sum / weights : weights / sum;
    return {true, true, lens.point(x, y, z)};
  }

  double change(int x, int y, int index, const Old& p_old) const {
    const Vec3 p = lens.point(x + 0.5, y + 0.5, now.depth(x, y));
    const Vec3 n(now.normals[0](x, y), now.normals[1](x, y), now.normals[2](x, y));
    const auto k = static_cast<size_t>(index), cell = static_cast<size_t>((y & 3) * 4 + (x & 3));
    Vec3 o(ao::ball_samples().x[k], ao::ball_samples().y[k], ao::ball_samples().z[k]);
    const Vec3 mirror(ao::mirror_tile().x[cell], ao::mirror_tile().y[cell], ao::mirror_tile().z[cell]);
    o -= mirror * (2 * o.dot(mirror));
    const double radius = params.radius_m;
    const Vec3 s = p + (o.dot(n) < 0 ? -o : o) * radius;
    if (s.z <= 0) return 0;
    const double scale = lens.orthographic ? 1 : 1 / s.z;
    const int tx = static_cast<int>(std::floor(lens.cx + lens.fx * s.x * scale));
    const int ty = static_cast<int>(std::floor(lens.cy - lens.fy * s.y * scale));
    if (tx < 0 || ty < 0 || tx >= now.depth.width() || ty >= now.depth.height()) return 0;
    const bool seen = is_surface(now.depth(tx, ty));
    const Vec3 q = seen ? lens.point(tx + 0.5, ty + 0.5, now.depth(tx, ty)) : Vec3(0, 0, 0);
    const Old q_old =
        seen ? old_point(past.x(tx, ty), past.y(tx, ty))
             : old_point(static_cast<double>(past.x(x, y)) + (tx - x), static_cast<double>(past.y(x, y)) + (ty - y));
    const double expected = seen ? past.expected(tx, ty) : kInfinite;
    const bool occludes = seen && (q - p).dot(n) > params.bias * radius;
    if (!occludes && !(q_old.seen && q_old.point.z < expected)) return 0;
    if (!q_old.inside) return kInfinite;
    const double a = seen ? std::min((q - p).length(), 2 * radius) : 2 * radius;
    const double b = q_old.seen ? std::min((q_old.point - p_old.point).length(), 2 * radius) : 2 * radius;
    const double footprint = (lens.orthographic ? 1.0 : p.z) / std::min(lens.fx, lens.fy);
    return std::max(0.0, std::abs(a - b) - validation.validation_footprints * footprint);
  }

  double confidence(int x, int y, int first, int count) const {
    const Old p_old = old_point(past.x(x, y), past.y(x, y));
    if (!is_surface(now.depth(x, y)) || !p_old.seen) return 0;
    double worst = 0;
    for (int i = first; i < first + count; ++i) worst = std::max(worst, change(x, y, i, p_old));
    return 1 / (1 + validation.validation_sharpness * worst / params.radius_m);
  }
};

/// Bumps with steps and holes, shifted between the frames.
View bumps(const Lens& lens, double shift) {
  return [=](double px, double y) {
    const double x = px + shift;
    if (x > 60 && x < 80 && y > 30 && y < 45) return Hit{};
    const double u = x / 17, v = y / 11, step = std::fmod(x + 3 * shift, 40) < 12 ? -0.5 : 0.0;
    return Hit{3 + 0.3 * std::sin(u) * std::cos(v) + step, (lens.ray(px, y) * -1).normalized()};
  };
}

TEST(SampleConfidenceReference, AgreesWithTheTwin) {
  constexpr int kWidth = 120, kHeight = 90;
  for (const bool orthographic : {false, true}) {
    const Lens lens{100, 90, 60, 45, orthographic};
    const Picture before = picture(kWidth, kHeight, lens, bumps(lens, 0)),
                  now = picture(kWidth, kHeight, lens, bumps(lens, 2.3));
    Plane x(kWidth, kHeight), y(kWidth, kHeight), expected(kWidth, kHeight);
    for (int j = 0; j < kHeight; ++j)
      for (int i = 0; i < kWidth; ++i) {
        const bool known = hash_counters(static_cast<uint32_t>(i), static_cast<uint32_t>(j)) % 50 != 0;
        x(i, j) = known ? static_cast<float>(i) + 2.8F : kNan;
        y(i, j) = static_cast<float>(j) + 0.5F;
        expected(i, j) = now.depth(i, j);
      }
    SphereSamples params;
    params.radius_m = 0.3F;
    const ValidationParams validation;
    const PastSurface past{before.depth, before.projection, 0, 0, x, y, expected};
    const filter::Surface surface = now.surface();
    const Plane fast =
        ao::sample_confidence(params, validation, surface, filter::full_grid(surface), {5, 8, {}, {}}, past);
    const Twin twin{params, validation, now, past, lens};
    int off = 0, partly = 0, lost = 0;
    for (int j = 0; j < kHeight; ++j)
      for (int i = 0; i < kWidth; ++i) {
        const double exact = twin.confidence(i, j, 5, 8);
        off += !(std::abs(fast(i, j) - exact) < 1e-3);  // a sample whose pixel or side rounds the other way
        partly += exact > 0.01 && exact < 0.99 ? 1 : 0;
        lost += exact == 0 ? 1 : 0;
      }
    EXPECT_LT(off, kWidth * kHeight / 200) << orthographic;
    EXPECT_GT(partly, 500);
    EXPECT_GT(lost, 200);
  }
}

}  // namespace
}  // namespace aftershade::tests
