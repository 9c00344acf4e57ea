#if defined(AFTERSHADE_CORE_AO_HBAO_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_HBAO_KERNEL_H
#undef AFTERSHADE_CORE_AO_HBAO_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_HBAO_KERNEL_H
#endif
#include "core/ao/hbao.h"
#include "core/ao/pattern_tile.h"
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

struct HbaoRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  Samples depth;
  const HbaoParams& params;
  HbaoPattern pattern;
  int texel_px;     ///< taps lie on a lattice of this pitch around the pixel
  float aspect;     ///< fx / fy
  float radius_px;  ///< of the radius, in vertical texels: at a depth of 1 m (perspective), everywhere (orthographic)
  float max_reach_px;  ///< texels; +inf: no limit
  float inv_radius2, tan_bias;
  int texel_x, texel_y;  ///< absolute texel coordinates of the grid's (0, 0)
  const float* wanted;   ///< only texels where it is > 0 are evaluated; null: all
  float* out;
};

/// The surface at a pixel. Its tangent plane, seen `offset` pixels away along the ray r + d, has the depth z / (1 + k)
/// (perspective) or z - k (orthographic), k = kx offset_x + ky offset_y: the direction d - k r lies in it.
struct HbaoCentre {
  Int px, py;
  Float z, ray_x, ray_y;
  Float kx, ky;
};

/// From the centre to what is seen (ox, oy) pixels away at depth z, without the cancellation of two unprojections.
inline Point from_centre(const HbaoRow& row, const HbaoCentre& c, Float ox, Float oy, Float z) {
  const Float scale = row.lens.orthographic ? Float(1.0F) : z;
  const Float farther = z - c.z;
  return {c.ray_x * farther + ox * row.lens.inv_fx * scale, c.ray_y * farther - oy * row.lens.inv_fy * scale, farther};
}

/// k of one pixel along an axis, from the neighbour texel at the shorter distance: "P_x = ||P - P_left|| <
/// ||P - P_right|| ? P_left : P_right" (seed 000, "Pixel Classification Approach"; SDK 11's MinDiff). Background and
/// what is outside never count; with no neighbour left the surface faces the camera.
inline Float shorter_difference(const HbaoRow& row, const HbaoCentre& c, int dx, int dy) {
  const auto length2_and_k = [&](int steps) {
    const Int tx = c.px + Int(steps * dx), ty = c.py + Int(steps * dy);
    const Float z = row.depth(row.depth.clamp_x(tx), row.depth.clamp_y(ty)), s = static_cast<float>(steps);
    const Mask usable = row.depth.contains(tx, ty) & is_surface(z);
    const Point v = from_centre(row, c, static_cast<float>(steps * dx), static_cast<float>(steps * dy), z);
    const Float k = (row.lens.orthographic ? c.z - z : (c.z - z) / z) / s;
    return std::pair(select(usable, dot(v, v), HUGE_VALF), select(usable, k, 0.0F));
  };
  const auto [minus2, k_minus] = length2_and_k(-row.texel_px);
  const auto [plus2, k_plus] = length2_and_k(row.texel_px);
  return select(minus2 < plus2, k_minus, k_plus);
}

/// From the normal: n . (d - k r) = 0. Without a normal the surface faces the camera.
inline void tangent_from_normal(const HbaoRow& row, HbaoCentre& c, Point n) {
  const Float facing = row.lens.orthographic ? n.z : n.x * c.ray_x + n.y * c.ray_y + n.z;
  const Float kx = n.x * row.lens.inv_fx / facing, ky = -(n.y * row.lens.inv_fy) / facing;
  const Mask known = is_finite(kx) & is_finite(ky);
  c.kx = select(known, kx, 0.0F);
  c.ky = select(known, ky, 0.0F);
}

template <bool kInside>
HbaoCentre centre_of(const HbaoRow& row, const Columns<kInside>& x, int y, Float z) {
  const Float px = row.grid.x_of(x, y), py = row.grid.y_of(x, y), ray = row.lens.orthographic ? 0.0F : 1.0F;
  HbaoCentre c{to_int(px),
               to_int(py),
               z,
               (px + 0.5F - row.lens.cx) * row.lens.inv_fx * ray,
               -((py + 0.5F - row.lens.cy) * row.lens.inv_fy) * ray,
               0.0F,
               0.0F};
  if (row.params.tangents == Tangents::normals) {
    tangent_from_normal(row, c, row.grid.normal(row.normals, x, y));
  } else {
    c.kx = shorter_difference(row, c, 1, 0);
    c.ky = shorter_difference(row, c, 0, 1);
  }
  return c;
}

/// Steeper than any horizon that matters; keeps squares finite. NaN becomes the lowest: it occludes nothing.
inline Float bounded_tan(Float t) { return clamp(t, -1e9F, 1e9F); }
inline Float sin_of_tan(Float t) { return t / sqrt(1.0F + t * t); }

/// tan of the tangent plane's elevation toward the lattice offset: -T.z / |T.xy|, T = d - k r, and the bias added in
/// tangent space (algorithms 1.2).
inline Float lifted_tangent(const HbaoRow& row, const HbaoCentre& c, Float ox, Float oy) {
  const Float k = c.kx * ox + c.ky * oy;
  const Float tx = ox * row.lens.inv_fx - k * c.ray_x, ty = -(oy * row.lens.inv_fy) - k * c.ray_y;
  return bounded_tan(k / sqrt(tx * tx + ty * ty)) + row.tan_bias;
}

/// What the taps of one direction have found so far.
struct Horizon {
  Float raised;  ///< tan of the horizon above the lifted tangent
  Float occlusion;
};

/// "if d2 < R^2 and tanS > tanH: ao += (1 - d2/R^2) (sinS - sinH); tanH = tanS" (algorithms 1.2).
inline void raise(Horizon& horizon, const HbaoRow& row, Point v, Float lifted, Mask usable) {
  const Float flat2 = v.x * v.x + v.y * v.y, share2 = (flat2 + v.z * v.z) * row.inv_radius2;
  const Float tan_tap = bounded_tan(-v.z / sqrt(flat2)), tan_horizon = lifted + horizon.raised;
  const Mask above = usable & (share2 < 1.0F) & (tan_tap > tan_horizon);
  if (!any(above)) return;
  const Float gain = (1.0F - share2) * (sin_of_tan(tan_tap) - sin_of_tan(tan_horizon));
  horizon.occlusion += select(above, gain, 0.0F);
  horizon.raised = select(above, tan_tap - lifted, horizon.raised);
}

/// How the taps of a pixel are laid out, in texels.
struct Layout {
  Float radius, step, taps, shift;
};

/// step = r / (n + 1), n = min(steps, r); if n steps reach farther than the limit: n = max(floor(limit / step + shift),
/// 1), step = limit / n (algorithms 1.2).
inline Layout layout(const HbaoRow& row, Float z, Float shift) {
  constexpr float kFarOutside = 1e5F;  // texels: beyond any image, and tap positions stay inside an Int
  const Float radius = min(row.radius_px / (row.lens.orthographic ? Float(1.0F) : z), kFarOutside);
  const Float n = min(static_cast<float>(row.params.steps), radius), step = radius / (n + 1.0F);
  const Mask too_far = row.max_reach_px / step < n;
  const Float fewer = max(floor(row.max_reach_px / step + shift), 1.0F);
  return {radius, select(too_far, row.max_reach_px / fewer, step), select(too_far, fewer, n), shift};
}

/// Flat distance falloffs of a direction's taps inside the image, and of all its taps.
struct Coverage {
  Float inside, all;
  /// 1 where all are inside. With no tap, or none that weighs, nothing is missing.
  Float share() const { return select(all > 0.0F, inside / all, 1.0F); }
};

struct Direction {
  Float x, y;  ///< texels per vertical texel of reach: (fx/fy cos, sin), so that angles are true in camera space
};

/// Measures the tap at lattice offset (ox, oy).
inline void take_tap(const HbaoRow& row, const HbaoCentre& c, const Layout& taps, Float ox, Float oy, Float lifted,
                     Mask usable, Horizon& horizon, Coverage& coverage) {
  const auto texel_px = static_cast<float>(row.texel_px);
  const Float px = ox * texel_px, py = oy * texel_px;
  const Int tx = c.px + to_int(px), ty = c.py + to_int(py);
  const Mask inside = row.depth.contains(tx, ty);
  const Float z = row.depth(row.depth.clamp_x(tx), row.depth.clamp_y(ty));
  const Mask seen = row.params.border == HbaoBorder::clamp ? usable : usable & inside;
  raise(horizon, row, from_centre(row, c, px, py, z), lifted, seen & is_surface(z));
  if (row.params.border != HbaoBorder::renormalise) return;
  const Float rx = ox / row.aspect;
  const Float weight = max(1.0F - (rx * rx + oy * oy) / (taps.radius * taps.radius), 0.0F);
  coverage.all += select(usable, weight, 0.0F);
  coverage.inside += select(usable & inside, weight, 0.0F);
}

/// What one direction occludes, and how much it counts: by its taps' share inside the image where
/// the border is renormalised (ours).
struct Slice {
  Float occlusion, weight;
};

/// One direction: the near tap at "Snap(shift step + 1 texel)", read as one texel farther along the direction, which
/// replaces one of the n steps, then the far taps j = 1 .. n - 1, a step apart from Snap(shift step) on.
inline Slice integrate_direction(const HbaoRow& row, const HbaoCentre& c, const Layout& taps, Direction dir) {
  const auto texel_px = static_cast<float>(row.texel_px);
  const auto lifted = [&](Float ox, Float oy) { return lifted_tangent(row, c, ox * texel_px, oy * texel_px); };
  Horizon horizon{0.0F, 0.0F};
  Coverage coverage{0.0F, 0.0F};
  const Float first = taps.shift * taps.step, near = first + 1.0F;
  const Float nx = round_small(dir.x * near), ny = round_small(dir.y * near), near_tangent = lifted(nx, ny);
  take_tap(row, c, taps, nx, ny, near_tangent, taps.radius >= 1.0F, horizon, coverage);
  const Float start_x = round_small(dir.x * first), start_y = round_small(dir.y * first);
  const Float step_x = round_small(dir.x * taps.step), step_y = round_small(dir.y * taps.step);
  const Float line_tangent = lifted(step_x, step_y);
  if (row.params.literal)  // SDK 11 keeps the horizon itself, not its height above the tangent
    horizon.raised =
        select(horizon.raised > 0.0F, max(near_tangent + horizon.raised - line_tangent, 0.0F), horizon.raised);
  for (int j = 1; j < row.params.steps; ++j) {
    const auto count = static_cast<float>(j);
    const Mask usable = taps.taps - 1.0F >= count;
    if (!any(usable)) break;
    if (row.params.literal) {
      take_tap(row, c, taps, start_x + step_x * count, start_y + step_y * count, line_tangent, usable, horizon,
               coverage);
    } else {
      const Float reach = first + count * taps.step;
      const Float ox = round_small(dir.x * reach), oy = round_small(dir.y * reach);
      take_tap(row, c, taps, ox, oy, lifted(ox, oy), usable, horizon, coverage);
    }
  }
  return {horizon.occlusion, coverage.share()};
}

/// ao^exponent, ao in [0, 1].
inline Float power(Float ao, float exponent) { return select(ao > 0.0F, exp2(exponent * log2(ao)), 0.0F); }

template <bool kInside>
void hbao_vector(const HbaoRow& row, int x0, int y) {
  const Mask wanted = row.wanted ? load(row.wanted + x0) > 0.0F : Mask(Float(0.0F) < 1.0F);
  const Columns<kInside> x(x0, row.grid.depth.width);
  const Float z = x(row.grid.depth.row(y));
  const Mask here = is_surface(z);
  if (!any(wanted & here)) return store(row.out + x0, select(wanted, Float(1.0F), load(row.out + x0)));
  const HbaoCentre centre = centre_of(row, x, y, select(here, z, 1.0F));
  const Int cell = tile_cell(x.index + Int(row.texel_x), y + row.texel_y);
  const Float rotation = gather(row.pattern.rotation.data(), cell);
  const Layout taps = layout(row, centre.z, gather(row.pattern.shift.data(), cell));
  const float sector = 1.0F / static_cast<float>(row.params.directions);
  Float occlusion = 0.0F, weights = 0.0F;
  for (int i = 0; i < row.params.directions; ++i) {
    const SinCos angle = sincos_turns((static_cast<float>(i) + rotation) * sector);
    const Slice slice = integrate_direction(row, centre, taps, {angle.cos * row.aspect, angle.sin});
    occlusion += slice.weight * slice.occlusion;
    weights += slice.weight;
  }
  const Float ao = sat(1.0F - select(weights > 0.0F, row.params.strength * (occlusion / weights), 0.0F));
  const Float shaped = row.params.power_exponent == 1 ? ao : power(ao, row.params.power_exponent);
  const Mask open = (!here) | (taps.radius < 1.0F);
  store(row.out + x0, select(wanted, select(open, 1.0F, shaped), load(row.out + x0)));
}

inline void hbao_row(const HbaoRow& row, int y) {
  for_each_vector(row.grid.depth.width, 0, 0,
                  [&](int x0, auto inside) { hbao_vector<decltype(inside)::value>(row, x0, y); });
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
