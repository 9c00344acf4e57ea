#if defined(AFTERSHADE_CORE_AO_SPHERE_TAP_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_SPHERE_TAP_H
#undef AFTERSHADE_CORE_AO_SPHERE_TAP_H
#else
#define AFTERSHADE_CORE_AO_SPHERE_TAP_H
#endif
#include "core/ao/ball_samples.h"
#include "core/ao/pattern_tile.h"
#include "core/ao/sphere_kernel.h"
#include "core/filter/lane_geometry.h"

/// One point of the sphere kernel and the pixel that it is tested at: what the AO and the check of its history share.
HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

inline Point operator*(Point p, Float s) { return {p.x * s, p.y * s, p.z * s}; }

struct SphereTaps {
  SphereTaps(const SphereSamples& params, const filter::Surface& surface, const filter::SampleGrid& at)
      : grid(at),
        normals(surface),
        lens(surface.projection),
        depth(surface.depth),
        radius_m(params.radius_m),
        radius_px_x(params.radius_m * surface.projection.fx),
        radius_px_y(params.radius_m * surface.projection.fy),
        bias_m(params.bias * params.radius_m),
        hemisphere(params.volume == SphereVolume::hemisphere),
        dither(params.dither),
        ball_x(ball_samples().x.data()),
        ball_y(ball_samples().y.data()),
        ball_z(ball_samples().z.data()),
        texel_x((surface.origin_x + at.origin_x) / at.step),
        texel_y((surface.origin_y + at.origin_y) / at.step) {}
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  Samples depth;
  float radius_m, radius_px_x, radius_px_y;  ///< px: at a depth of 1 m (perspective), everywhere (orthographic)
  float bias_m;
  bool hemisphere, dither;
  const float *ball_x, *ball_y, *ball_z;
  int texel_x, texel_y;  ///< absolute texel coordinates of the grid's (0, 0)
};

/// Whole numbers of a SampleRange for the texels of one row.
struct RangeRow {
  RangeRow(const SampleRange& range, int y)
      : first(range.first_at.empty() ? nullptr : range.first_at.row(y)),
        count(range.count_at.empty() ? nullptr : range.count_at.row(y)),
        every_first(range.first),
        every_count(range.count) {}
  const float *first, *count;
  int every_first, every_count;
  Int first_of(int x0) const { return first ? to_int(load(first + x0)) : Int(every_first); }
  Int count_of(int x0) const { return count ? to_int(load(count + x0)) : Int(every_count); }
  /// The first point of all lanes from x0 on; -1 where they have different ones.
  int shared_first(int x0) const {
    if (!first) return every_first;
    const float shared = first[x0];
    return all(load(first + x0) == shared) ? static_cast<int>(shared) : -1;
  }
};

/// The texel around whose point the ball lies.
struct BallCentre {
  Int x, y;  ///< its pixel
  Point point, normal, mirror;
  Float ray_x, ray_y;  ///< of the pixel, at depth 1
};
template <bool kInside>
BallCentre ball_centre(const SphereTaps& taps, const Columns<kInside>& x, int y) {
  const Float fx = taps.grid.x_of(x, y), fy = taps.grid.y_of(x, y), z = x(taps.grid.depth.row(y));
  const Int cell = tile_cell(x.index + Int(taps.texel_x), y + taps.texel_y);
  const MirrorTile& tile = mirror_tile();
  return {to_int(fx),
          to_int(fy),
          unproject(taps.lens, fx, fy, z),
          taps.grid.normal(taps.normals, x, y),
          {gather(tile.x.data(), cell), gather(tile.y.data(), cell), gather(tile.z.data(), cell)},
          (fx + 0.5F - taps.lens.cx) * taps.lens.inv_fx,
          -((fy + 0.5F - taps.lens.cy) * taps.lens.inv_fy)};
}

/// Point i of the sequence after `first` of each lane, which `shared` is where it is not negative.
inline Point ball_point(const SphereTaps& taps, Int first, int shared, int i) {
  if (shared >= 0) {
    const auto at = (static_cast<unsigned>(shared) + static_cast<unsigned>(i)) & (kSequenceLength - 1U);
    return {taps.ball_x[at], taps.ball_y[at], taps.ball_z[at]};
  }
  const Int at = (first + Int(i)) & Int(kSequenceLength - 1);
  return {gather(taps.ball_x, at), gather(taps.ball_y, at), gather(taps.ball_z, at)};
}

struct SphereTap {
  Int x, y;       ///< the pixel where the point is looked for, clamped to the image
  Mask in_frame;  ///< and is it there?
  Float z;        ///< depth of the point
  Point surface;  ///< what is seen at the pixel
};

/// Point `o` of the unit ball. Crysis reflects the offsets at a random plane per pixel; StarCraft II flips them into
/// the normal's hemisphere (algorithms 8). Pixel positions are relative to the centre's, so they do not depend on the
/// data window.
inline SphereTap sphere_tap(const SphereTaps& taps, const BallCentre& centre, Point o) {
  constexpr float kFarOutside = 1e6F;  // keeps positions inside an Int
  if (taps.dither) o = o - centre.mirror * (2.0F * dot(o, centre.mirror));
  if (taps.hemisphere) o = select(dot(o, centre.normal) < 0.0F, Point{-o.x, -o.y, -o.z}, o);
  const Float z = centre.point.z + taps.radius_m * o.z;
  // (X + R o.x) / (Z + R o.z) - X / Z = R (o.x - o.z X / Z) / (Z + R o.z)
  const bool flat = taps.lens.orthographic;
  const Float across = flat ? o.x : (o.x - o.z * centre.ray_x) / z;
  const Float up = flat ? o.y : (o.y - o.z * centre.ray_y) / z;
  const Float dx = clamp(taps.radius_px_x * across, -kFarOutside, kFarOutside);
  const Float dy = clamp(taps.radius_px_y * -up, -kFarOutside, kFarOutside);
  const Int x = centre.x + to_int(round_small(dx)), y = centre.y + to_int(round_small(dy));
  const Int sx = taps.depth.clamp_x(x), sy = taps.depth.clamp_y(y);
  return {sx, sy, taps.depth.contains(x, y) & (z > 0.0F), z,
          unproject(taps.lens, to_float(sx), to_float(sy), taps.depth(sx, sy))};
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
