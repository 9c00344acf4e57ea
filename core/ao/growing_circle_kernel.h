#if defined(AFTERSHADE_CORE_AO_GROWING_CIRCLE_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_GROWING_CIRCLE_KERNEL_H
#undef AFTERSHADE_CORE_AO_GROWING_CIRCLE_KERNEL_H
#else
#define AFTERSHADE_CORE_AO_GROWING_CIRCLE_KERNEL_H
#endif
#include <array>
#include <span>

#include "core/ao/pattern_tile.h"
#include "core/ao/tap_pattern.h"
#include "core/filter/lane_geometry.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

struct GrowingCircleRow {
  GridSamples grid;
  NormalSamples normals;
  Lens lens;
  Samples depth;
  std::span<const Tap> taps;
  float radius_m;
  float radius_px_x, radius_px_y;  ///< of radius_m: at a depth of 1 m (perspective), everywhere (orthographic)
  float max_radius_px;             ///< of the longer projected radius
  float bias, strength;
  std::array<float, 16> rotation_turns;  ///< 4x4, by absolute texel
  int texel_x, texel_y;                  ///< absolute texel coordinates of the grid's (0, 0)
  float* out;
};

/// "How close the points are to each other and if the nearby point is in front of the surface normal" (seed 001);
/// v = 0 does not occlude.
inline Float closeness_in_front(Point v, Point normal, float radius, float bias) {
  const Float length = sqrt(dot(v, v));
  const Float in_front = max(dot(v, normal) / length - bias, 0.0F);
  return select(length > 0.0F, in_front * max(1.0F - length / radius, 0.0F), 0.0F);
}

template <bool kInside>
void growing_circle_vector(const GrowingCircleRow& row, int x0, int y) {
  const Columns<kInside> x(x0, row.grid.depth.width);
  const Float z = x(row.grid.depth.row(y));
  const Mask here = is_surface(z);
  if (!any(here)) return store(row.out + x0, 1.0F);
  const Float fx = row.grid.x_of(x, y), fy = row.grid.y_of(x, y);
  const Int px = to_int(fx), py = to_int(fy);
  const Point centre = unproject(row.lens, fx, fy, z);
  const Point normal = row.grid.normal(row.normals, x, y);
  // r_px = min(R f / z, half a screen): algorithms 5.2.
  const Float scale_depth = row.lens.orthographic ? Float(1.0F) : select(here, z, 1.0F);
  const Float x_px = row.radius_px_x / scale_depth, y_px = row.radius_px_y / scale_depth;
  const Float share = min(row.max_radius_px / max(x_px, y_px), 1.0F);
  constexpr float kFarOutside = 1e6F;  // keeps tap positions inside an Int
  const Float reach_x = min(x_px * share, kFarOutside), reach_y = min(y_px * share, kFarOutside);
  const Int cell = tile_cell(x.index + Int(row.texel_x), y + row.texel_y);
  const SinCos rotation = sincos_turns(gather(row.rotation_turns.data(), cell));
  Float sum = 0.0F, inside = 0.0F, all = 0.0F;
  for (const Tap& tap : row.taps) {
    const Float dir_x = tap.x * rotation.cos - tap.y * rotation.sin,
                dir_y = tap.x * rotation.sin + tap.y * rotation.cos;
    const Int tx = px + to_int(round_small(dir_x * (tap.radius * reach_x))),
              ty = py + to_int(round_small(dir_y * (tap.radius * reach_y)));
    const Mask in_frame = row.depth.contains(tx, ty);
    const Int sx = row.depth.clamp_x(tx), sy = row.depth.clamp_y(ty);
    const Point point = unproject(row.lens, to_float(sx), to_float(sy), row.depth(sx, sy));
    const Float occlusion = closeness_in_front(point - centre, normal, row.radius_m, row.bias);
    sum += select(in_frame & is_surface(point.z), occlusion, 0.0F);
    // Outside the image each tap stands for its closeness on a surface that faces the camera (ours, as in
    // scalable_ao_row).
    const Float weight = 1.0F - tap.radius * share;
    all += weight;
    inside += select(in_frame, weight, 0.0F);
  }
  const Float mean = sum / static_cast<float>(row.taps.size()) * select(inside > 0.0F, all / inside, 0.0F);
  store(row.out + x0, select(here, 1.0F - sat(row.strength * mean), 1.0F));
}

inline void growing_circle_row(const GrowingCircleRow& row, int y) {
  for_each_vector(row.grid.depth.width, 0, 0,
                  [&](int x0, auto inside) { growing_circle_vector<decltype(inside)::value>(row, x0, y); });
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
