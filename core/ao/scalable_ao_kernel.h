#if defined(AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#undef AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_SCALABLE_AO_KERNEL_H
#endif
#include <array>
#include <span>
#include <vector>

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
  Samples image;
  const float* mips;  ///< all levels but the image, in one plane
  int mip_stride, count;
  int origin_x, origin_y;  ///< absolute coordinates of level 0's index (0, 0)
  /// By level: where absolute texel (0, 0) would be in `mips`, and what puts pixels under texels (seen_through).
  std::array<int32_t, 16> first, whole, odd, even;
};

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

struct Texels {
  Int x, y;
};

/// The pixel whose depth level `m` has over pixel (x, y), absolute coordinates, by the walk down from level to level:
/// z_{m+1}(x,y) = z_m(2x + (y&1), 2y + (x&1)), clamped to the image.
inline Texels walked_down(const DepthLevels& depth, Int x, Int y, Int m) {
  Texels at{x >> m, y >> m};
  for (int finer = kDepthLevels - 2; finer >= 0; --finer) {
    const Mask on_the_way = m >= Int(finer + 1);
    const auto step = [&](Int next, Int stay, int origin, int size) {
      return select(on_the_way, clamp(next, origin >> finer, (origin + size - 1) >> finer), stay);
    };
    const Int next_x = (at.x << 1) + (at.y & 1), next_y = (at.y << 1) + (at.x & 1);
    at = {step(next_x, at.x, depth.origin_x, depth.image.width),
          step(next_y, at.y, depth.origin_y, depth.image.height)};
  }
  return at;
}

/// The same at once where nothing is clamped: below the texel's own bits, the lowest bit of its row and that of its
/// column take turns.
inline Texels seen_through(const DepthLevels& depth, Int x, Int y, Int m) {
  const Int whole = look_up(depth.whole.data(), m), odd = look_up(depth.odd.data(), m),
            even = look_up(depth.even.data(), m);
  const Int from_x = Int(0) - ((x >> m) & 1), from_y = Int(0) - ((y >> m) & 1);  // no bit or all bits
  return {(x & whole) | (odd & from_y) | (even & from_x), (y & whole) | (odd & from_x) | (even & from_y)};
}

/// The point that the tap at pixel (x, y) sees through pyramid level `m`: the level's texel over the pixel holds the
/// depth of one pixel below it; the point is unprojected from there, so that a plane stays a plane. (SAO unprojects
/// from the tap's own pixel and leans on the bias.)
inline Point tap_point(const DepthLevels& depth, const Lens& lens, Int x, Int y, Int m) {
  const Mask fine = m < Int(1);
  if (all(fine)) return unproject(lens, to_float(x), to_float(y), depth.image(x, y));
  const Int absolute_x = x + Int(depth.origin_x), absolute_y = y + Int(depth.origin_y);
  Texels pixel = seen_through(depth, absolute_x, absolute_y, m);
  if (!all(depth.image.contains(pixel.x - Int(depth.origin_x), pixel.y - Int(depth.origin_y))))
    pixel = walked_down(depth, absolute_x, absolute_y, m);
  const Int texel = look_up(depth.first.data(), m) + (absolute_y >> m) * Int(depth.mip_stride) + (absolute_x >> m);
  Float z = gather(depth.mips, select(fine, Int(0), texel));
  if (any(fine)) z = select(fine, depth.image(x, y), z);
  return unproject(lens, to_float(pixel.x - Int(depth.origin_x)), to_float(pixel.y - Int(depth.origin_y)), z);
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
