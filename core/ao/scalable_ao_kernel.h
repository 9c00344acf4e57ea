#if defined(AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#undef AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#endif
#include <array>
#include <span>

#include "core/ao/pattern_tile.h"
#include "core/ao/scalable_ao.h"
#include "core/ao/tap_pattern.h"
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

inline constexpr int kLogMaxOffset = 3;    ///< SAO's LOG_MAX_OFFSET: taps nearer than 16 px read level 0
inline constexpr float kMinTapPx = 0.75F;  ///< SAO: a tap never falls on the pixel itself

/// The depth pyramid, read so that each value is put where it was taken.
struct DepthLevels {
  std::array<Samples, kDepthLevels> levels;
  int count;
  int origin_x, origin_y;  ///< absolute coordinates of level 0's index (0, 0)
};

struct ScalableAoRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  DepthLevels depth;
  std::span<const Tap> taps;
  const ScalableAoParams& params;
  float radius_px_x, radius_px_y;        ///< of radius_m: at a depth of 1 m (perspective), everywhere (orthographic)
  float max_radius_px;                   ///< of the vertical projected radius; +inf: no clamp
  float noise_turns;                     ///< added to every pixel's rotation
  std::array<float, 16> rotation_turns;  ///< 4x4, by absolute texel
  int texel_x, texel_y;                  ///< absolute texel coordinates of the grid's (0, 0)
  float* out;
};

/// The point that the tap at pixel (x, y) sees through pyramid level `m`: the level's texel over the pixel holds the
/// depth of one pixel below it, found by walking down z_{m+1}(x,y) = z_m(2x + (y&1), 2y + (x&1)); the point is
/// unprojected from there, so that a plane stays a plane. (SAO unprojects from the tap's own pixel and leans on the
/// bias.)
inline Point tap_point(const DepthLevels& depth, const Lens& lens, Int x, Int y, Int m) {
  Float z = depth.levels[0](x, y);
  Int px = x, py = y;
  for (int level = 1; level < depth.count; ++level) {
    const Mask at_level = m == Int(level);
    if (!any(at_level)) continue;
    const Samples& mip = depth.levels[static_cast<size_t>(level)];
    Int tx = (x + Int(depth.origin_x)) >> level, ty = (y + Int(depth.origin_y)) >> level;
    z = select(at_level, mip(tx - Int(depth.origin_x >> level), ty - Int(depth.origin_y >> level)), z);
    for (int finer = level - 1; finer >= 0; --finer) {
      const Samples& below = depth.levels[static_cast<size_t>(finer)];
      const int first_x = depth.origin_x >> finer, first_y = depth.origin_y >> finer;
      const Int next_x = (tx << 1) + (ty & Int(1)), next_y = (ty << 1) + (tx & Int(1));
      tx = clamp(next_x, first_x, first_x + below.width - 1);
      ty = clamp(next_y, first_y, first_y + below.height - 1);
    }
    px = select(at_level, tx - Int(depth.origin_x), px);
    py = select(at_level, ty - Int(depth.origin_y), py);
  }
  return unproject(lens, to_float(px), to_float(py), z);
}

/// Of d = |v| / r. Linear: "Falloff Function" slide; the others: SAO's factors without their units (algorithms 4.3, B
/// HQ, B fast and A).
inline Float distance_falloff(DistanceFalloff kind, Float d) {
  const Float linear = max(1.0F - d, 0.0F), quadratic = max(1.0F - d * d, 0.0F);
  switch (kind) {
    case DistanceFalloff::linear:
      return linear;
    case DistanceFalloff::quadratic:
      return quadratic;
    case DistanceFalloff::cubic:
      return quadratic * quadratic * quadratic;
    case DistanceFalloff::none:
      break;
  }
  return select(d < 1.0F, Float(1.0F), 0.0F);
}

/// "Falloff Function" slide: max(1 - |v| / r, 0) * max((v / |v|) . n - bias, 0), and its text: "before normalizing the
/// vector we apply a small bias", (v . n - bias_m) / |v|. v = 0 does not occlude.
inline Float tap_occlusion(Point v, Point normal, Float radius, const ScalableAoParams& params) {
  const Float length = sqrt(dot(v, v));
  const Float angular_falloff = max((dot(v, normal) - params.bias_m) / length - params.bias, 0.0F);
  return select(length > 0.0F, distance_falloff(params.falloff, length / radius) * angular_falloff, 0.0F);
}

/// Projected radius of a pixel at depth z. RadiusClamp::radius shortens the radius itself, in metres too, so that the
/// falloff still reaches 0 at the outermost tap.
struct ProjectedRadius {
  Float x_px, y_px, m;
};
inline ProjectedRadius projected_radius(const ScalableAoRow& row, Float z) {
  constexpr float kFarOutside = 1e6F;  // keeps tap positions inside an Int
  const Float depth = row.lens.orthographic ? Float(1.0F) : z;
  const Float x_px = row.radius_px_x / depth, y_px = row.radius_px_y / depth;
  const Mask clamped = y_px > row.max_radius_px;
  const Float share = select(clamped, row.max_radius_px / y_px, 1.0F);
  return {min(x_px * share, kFarOutside), min(y_px * share, kFarOutside),
          row.params.radius_clamp == RadiusClamp::radius ? row.params.radius_m * share : Float(row.params.radius_m)};
}

/// What all taps together would weigh in scalable_ao_row, added in the same order.
inline Float falloff_sum(std::span<const Tap> taps, DistanceFalloff falloff) {
  Float sum = 0.0F;
  for (const Tap& tap : taps) sum += distance_falloff(falloff, tap.radius);
  return sum;
}

inline void scalable_ao_row(const ScalableAoRow& row, int y) {
  const Samples& image = row.depth.levels[0];
  const Float all_inside = falloff_sum(row.taps, row.params.falloff);
  const auto tap_count = static_cast<float>(row.taps.size());
  for (int x0 = 0; x0 < row.grid.depth.width; x0 += kLanes) {
    const Int x = row.grid.depth.clamp_x(iota(x0)), iy = y;
    const Float z = row.grid.depth(x, iy);
    const Mask here = is_surface(z);
    const Int px = to_int(row.grid.x_of(x, iy)), py = to_int(row.grid.y_of(x, iy));
    const Point centre = unproject(row.lens, to_float(px), to_float(py), z);
    const Point normal = row.normals(px, py);
    const ProjectedRadius radius = projected_radius(row, select(here, z, 1.0F));
    const Float longest = max(radius.x_px, radius.y_px);
    const Int cell = tile_cell(x + Int(row.texel_x), iy + Int(row.texel_y));
    const SinCos rotation = sincos_turns(gather(row.rotation_turns.data(), cell) + row.noise_turns);
    Float sum = 0.0F, inside = 0.0F;
    for (const Tap& tap : row.taps) {
      const Float dir_x = tap.x * rotation.cos - tap.y * rotation.sin,
                  dir_y = tap.x * rotation.sin + tap.y * rotation.cos;
      // r_i = max(0.75 px, alpha_i r'), mip_i = clamp(floor(log2(r_i)) - 3, 0, 5): algorithms 4.2.
      const Int tx = px + to_int(round_small(dir_x * max(tap.radius * radius.x_px, kMinTapPx)));
      const Int ty = py + to_int(round_small(dir_y * max(tap.radius * radius.y_px, kMinTapPx)));
      const Int level =
          clamp(floor_log2(max(tap.radius * longest, kMinTapPx)) - Int(kLogMaxOffset), 0, row.depth.count - 1);
      const Mask in_frame = image.contains(tx, ty);
      const Point point = tap_point(row.depth, row.lens, image.clamp_x(tx), image.clamp_y(ty), level);
      const Float occlusion = tap_occlusion(point - centre, normal, radius.m, row.params);
      sum += select(in_frame & is_surface(point.z), occlusion, 0.0F);
      inside += select(in_frame, distance_falloff(row.params.falloff, tap.radius), 0.0F);
    }
    // "Total Occlusion" slide: AO_T = (2 scale / S sum AO_s)^2. Taps outside the image are made up for (ours), since to
    // count them as open would brighten the borders: they stand for as much occlusion as those inside, each by the
    // distance falloff of its radius. The factor is 1 where all taps are inside. Taps on background count as open.
    const Float mean = sum / tap_count * select(inside > 0.0F, all_inside / inside, 0.0F);
    const Float total = 2.0F * row.params.scale * mean;
    store(row.out + x0, select(here, 1.0F - sat(row.params.squared ? total * total : total), 1.0F));
  }
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
