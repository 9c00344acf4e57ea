#include "tests/support/truth.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/math/sampling.h"
#include "core/parallel/rows.h"

namespace aftershade::tests {

namespace {
double fraction(double x) { return x - std::floor(x); }

/// Van der Corput's radical inverse in base 2.
double radical_inverse(uint32_t i) {
  uint32_t bits = 0;
  for (int b = 0; b < 32; ++b) bits |= ((i >> b) & 1U) << (31 - b);
  return static_cast<double>(bits) * 0x1p-32;
}

double falloff(Falloff kind, double r) {
  switch (kind) {
    case Falloff::hard:
      return 1;
    case Falloff::squared:
      return 1 - r * r;
    case Falloff::linear:
      return 1 - r;
  }
  return 0;
}

/// Two unit vectors that complete `n` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
struct Tangents {
  Vec3 s, t;
};
Tangents tangents(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

}  // namespace

double ambient_occlusion_at(const PlacedScene& placed, const Vec3& position, const Vec3& normal, const AoTruth& truth,
                            uint32_t seed) {
  // Hammersley's points, shifted on the torus by the seed (Cranley and Patterson 1976).
  const double shift_u = static_cast<double>(unit_float(hash_counters(seed, 1)));
  const double shift_v = static_cast<double>(unit_float(hash_counters(seed, 2)));
  const Tangents frame = tangents(normal);
  const Vec3 origin = position + normal * kSurfaceOffset_m;
  double occlusion = 0;
  for (int i = 0; i < truth.rays; ++i) {
    const double u = fraction((i + 0.5) / truth.rays + shift_u);
    const double azimuth = 2 * std::numbers::pi * fraction(radical_inverse(static_cast<uint32_t>(i)) + shift_v);
    const double z = truth.weighting == Weighting::uniform ? u : std::sqrt(u);
    const double r = std::sqrt(1 - z * z);
    const Vec3 direction = frame.s * (r * std::cos(azimuth)) + frame.t * (r * std::sin(azimuth)) + normal * z;
    const Ray ray{origin, direction, 0, truth.radius_m};
    if (truth.falloff == Falloff::hard)
      occlusion += placed.blocked(ray) ? 1 : 0;
    else if (const auto distance = placed.trace_distance(ray))
      occlusion += falloff(truth.falloff, *distance / truth.radius_m);
  }
  return 1 - occlusion / truth.rays;
}

Plane ambient_occlusion_truth(const Scene& scene, double time, int width, int height, const AoTruth& truth) {
  const PlacedScene placed(scene, time);
  const RayFan rays(camera_at(scene, time, width, height));
  Plane out(width, height, 1);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x)
      if (const auto hit = placed.trace(rays(x + 0.5, y + 0.5)))
        out(x, y) =
            static_cast<float>(ambient_occlusion_at(placed, hit->position, hit->normal, truth,
                                                    hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y))));
  });
  return out;
}

namespace {
/// Where the points of an object were a frame before.
class FrameBefore {
 public:
  FrameBefore(const Motion& motion, double time)
      : now_(motion.object_to_world(time)), before_(motion.object_to_world(time - 1)), moved_(now_ != before_) {}
  bool moved() const { return moved_; }
  Vec3 position(const Hit& hit) const { return moved_ ? transform_point(hit.object_position, before_) : hit.position; }
  Vec3 normal(const Hit& hit) const {
    if (!moved_) return hit.normal;
    const double side = transform_direction(hit.object_normal, now_).dot(hit.normal) < 0 ? -1 : 1;
    return transform_direction(hit.object_normal, before_) * side;
  }

 private:
  Mat4 now_, before_;
  bool moved_;
};
}  // namespace

Plane ambient_occlusion_change(const Scene& scene, double time, int width, int height, const AoTruth& truth) {
  std::vector<FrameBefore> before;
  for (const Object& object : scene.objects) before.emplace_back(object.motion, time);
  Plane out(width, height);
  if (std::none_of(before.begin(), before.end(), [](const FrameBefore& b) { return b.moved(); })) return out;
  const PlacedScene placed(scene, time), placed_before(scene, time - 1);
  const RayFan rays(camera_at(scene, time, width, height));
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x)
      if (const auto hit = placed.trace(rays(x + 0.5, y + 0.5))) {
        const uint32_t seed = hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
        const FrameBefore& was = before[hit->object];
        out(x, y) =
            static_cast<float>(ambient_occlusion_at(placed, hit->position, hit->normal, truth, seed) -
                               ambient_occlusion_at(placed_before, was.position(*hit), was.normal(*hit), truth, seed));
      }
  });
  return out;
}

std::vector<Plane> motion_blur_truth(const Scene& scene, double time, double shutter_frames, int samples,
                                     const RenderSettings& settings) {
  std::vector<Plane> sum;
  for (int c = 0; c < 4; ++c) sum.emplace_back(settings.width, settings.height);
  for (int i = 0; i < samples; ++i) {
    const double when = time + shutter_frames * ((i + 0.5) / samples - 0.5);
    const Shaded part = shade(PlacedScene(scene, when), settings);
    for (size_t c = 0; c < sum.size(); ++c)
      for (int y = 0; y < settings.height; ++y)
        for (int x = 0; x < settings.width; ++x) sum[c](x, y) += part.rgba[c](x, y) / static_cast<float>(samples);
  }
  return sum;
}

}  // namespace aftershade::tests
