#if defined(AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#undef AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#endif
#include <array>
#include <span>
#include <vector>

#include "core/ao/depth_levels.h"
#include "core/ao/scalable_ao.h"
#include "core/ao/tap_pattern.h"
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

inline constexpr float kMinTapPx = 0.75F;  ///< SAO: a tap never falls on the pixel itself

/// Taps in their directions at one row of the 4x4 pattern: kColumns values a tap and axis, of which the lanes of x0
/// load kLanes from x0 & 3 on.
struct DirectionTable {
  static constexpr int kColumns = kLanes + 3;
  std::vector<float> x, y;
};

struct ScalableAoRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  const DepthLevels& depth;
  std::span<const Tap> taps;
  std::span<const float> tap_falloffs;  ///< what each tap weighs at most
  const DirectionTable& directions;     ///< of this row
  const ScalableAoParams& params;
  float radius_px_x, radius_px_y;  ///< of radius_m: at a depth of 1 m (perspective), everywhere (orthographic)
  float max_radius_px;             ///< of the vertical projected radius; +inf: no clamp
  float* out;
};

/// The point that the tap at pixel (x, y) sees through pyramid level `m`, unprojected from where its depth was taken, so
/// that a plane stays a plane. (SAO unprojects from the tap's own pixel and leans on the bias.)
inline Point tap_point(const DepthLevels& depth, const Lens& lens, Int x, Int y, Int m) {
  const DepthSample sample = depth_sample(depth, x, y, m);
  return unproject(lens, to_float(sample.x), to_float(sample.y), sample.z);
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

/// kInside: all lanes are texels of the grid.
template <bool kInside>
void scalable_ao_vector(const ScalableAoRow& row, float all_inside, int x0, int y) {
  const Columns<kInside> x(x0, row.grid.depth.width);
  const Float z = x(row.grid.depth.row(y));
  const Mask here = is_surface(z);
  if (!any(here)) return store(row.out + x0, 1.0F);
  const Samples& image = row.depth.image;
  const Float fx = row.grid.x_of(x, y), fy = row.grid.y_of(x, y);
  const Int px = to_int(fx), py = to_int(fy);
  const Point centre = unproject(row.lens, fx, fy, z);
  const Point normal = row.grid.normal(row.normals, x, y);
  const ProjectedRadius radius = projected_radius(row, select(here, z, 1.0F));
  const Float longest = max(radius.x_px, radius.y_px);
  const float *dir_x = row.directions.x.data() + (x0 & 3), *dir_y = row.directions.y.data() + (x0 & 3);
  Float sum = 0.0F, inside = 0.0F;
  for (size_t i = 0; i < row.taps.size(); ++i) {
    const float tap_radius = row.taps[i].radius;
    const size_t column = i * DirectionTable::kColumns;
    // r_i = max(0.75 px, alpha_i r'), mip_i = clamp(floor(log2(r_i)) - 3, 0, 5): algorithms 4.2.
    const Int tx = px + to_int(round_small(load(dir_x + column) * max(tap_radius * radius.x_px, kMinTapPx)));
    const Int ty = py + to_int(round_small(load(dir_y + column) * max(tap_radius * radius.y_px, kMinTapPx)));
    const Int level =
        clamp(floor_log2(max(tap_radius * longest, kMinTapPx)) - Int(kLogMaxOffset), 0, row.depth.count - 1);
    const Mask in_frame = image.contains(tx, ty);
    const Point point = tap_point(row.depth, row.lens, image.clamp_x(tx), image.clamp_y(ty), level);
    const Float occlusion = tap_occlusion(point - centre, normal, radius.m, row.params);
    sum += select(in_frame & is_surface(point.z), occlusion, 0.0F);
    inside += select(in_frame, Float(row.tap_falloffs[i]), 0.0F);
  }
  // "Total Occlusion" slide: AO_T = (2 scale / S sum AO_s)^2. Taps outside the image are made up for (ours), since to
  // count them as open would brighten the borders: they stand for as much occlusion as those inside, each by the
  // distance falloff of its radius. The factor is 1 where all taps are inside. Taps on background count as open.
  const Float mean = sum / static_cast<float>(row.taps.size()) * select(inside > 0.0F, all_inside / inside, 0.0F);
  const Float total = 2.0F * row.params.scale * mean;
  store(row.out + x0, select(here, 1.0F - sat(row.params.squared ? total * total : total), 1.0F));
}

inline void scalable_ao_row(const ScalableAoRow& row, int y) {
  float all_inside = 0;  // added in the order of the taps
  for (const float falloff : row.tap_falloffs) all_inside += falloff;
  for_each_vector(row.grid.depth.width, 0, 0,
                  [&](int x0, auto inside) { scalable_ao_vector<decltype(inside)::value>(row, all_inside, x0, y); });
}

inline void add_row(const float* values, int width, float* sums) {
  for (int x = 0; x < width; x += kLanes) store(sums + x, load(sums + x) + load(values + x));
}
inline void divide_row(float divisor, int width, float* values) {
  for (int x = 0; x < width; x += kLanes) store(values + x, load(values + x) / divisor);
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
