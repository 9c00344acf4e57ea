#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/io/normals.cpp"  // this file, compiled once a SIMD target
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>
#include <limits>

#include "core/io/conversions.h"
#include "core/parallel/rows.h"

namespace aftershade::io {

#ifndef AFTERSHADE_NORMAL_ROW
#define AFTERSHADE_NORMAL_ROW
/// One row of normals, and what it needs.
struct NormalRow {
  std::array<float*, 3> pixels;
  int count;
  const Encoding& encoding;
  Mat4 turn;
  /// View ray of pixel i: ((first_x + i - cx) / fx, ray_y, 1); without rays (0, 0, 1).
  bool has_rays;
  double first_x, cx, fx, ray_y;
};
#endif

}  // namespace aftershade::io

HWY_BEFORE_NAMESPACE();
namespace aftershade::io::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::ScalableTag<double>;
using Floats = hn::Rebind<float, Doubles>;
using Values = hn::Vec<Doubles>;

HWY_INLINE Values constant(double value) { return hn::Set(Doubles(), value); }
HWY_INLINE Values sum_of_products(Values ax, double bx, Values ay, double by, Values az, double bz) {
  return hn::Add(hn::Add(hn::Mul(ax, constant(bx)), hn::Mul(ay, constant(by))), hn::Mul(az, constant(bz)));
}

/// In double, whose rounding nobody sees; up to the lanes of one vector past the row's end, into its padding.
void convert_normal_row(const NormalRow& row) {
  const Doubles d;
  const Floats f;
  const auto stored = [&](size_t c, int x) {
    const Values value = hn::PromoteTo(d, hn::LoadU(f, row.pixels[c] + x));
    return hn::Mul(hn::Sub(value, constant(row.encoding.neutral)), constant(row.encoding.scale[c]));
  };
  for (int x = 0; x < row.count; x += static_cast<int>(hn::Lanes(d))) {
    const Values sx = stored(0, x), sy = stored(1, x), sz = stored(2, x);
    std::array<Values, 3> n;
    for (int c = 0; c < 3; ++c)
      n[static_cast<size_t>(c)] = sum_of_products(sx, row.turn[0][c], sy, row.turn[1][c], sz, row.turn[2][c]);
    const Values length = hn::Sqrt(hn::Add(hn::Add(hn::Mul(n[0], n[0]), hn::Mul(n[1], n[1])), hn::Mul(n[2], n[2])));
    // Averaged normals of a silhouette may be short; those shorter than this are background.
    const auto is_known =
        hn::And(hn::Ge(length, constant(0.1)), hn::Lt(length, constant(std::numeric_limits<double>::infinity())));
    for (Values& value : n) value = hn::IfThenElseZero(is_known, hn::Div(value, length));
    Values along = n[2];
    if (row.has_rays) {
      const Values at = hn::Add(constant(row.first_x + x), hn::Iota(d, 0.0));
      const Values ray_x = hn::Div(hn::Sub(at, constant(row.cx)), constant(row.fx));
      along = hn::Add(hn::Add(hn::Mul(n[0], ray_x), hn::Mul(n[1], constant(row.ray_y))), n[2]);
    }
    const auto faces_away = hn::Gt(along, constant(0));
    for (size_t c = 0; c < 3; ++c)
      hn::StoreU(hn::DemoteTo(f, hn::IfThenElse(faces_away, hn::Neg(n[c]), n[c])), f, row.pixels[c] + x);
  }
}

}  // namespace aftershade::io::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::io {

HWY_EXPORT(convert_normal_row);

void convert_normals(std::vector<Plane>& normals, const Encoding& encoding, const std::optional<Camera>& camera,
                     Window window) {
  const bool from_world = encoding.normal_space == NormalSpace::world && camera && camera->world_to_camera;
  const Camera lens = camera.value_or(Camera());
  for_rows(normals[0].height(), [&](int y) {
    HWY_DYNAMIC_DISPATCH(convert_normal_row)
    ({.pixels = {normals[0].row(y), normals[1].row(y), normals[2].row(y)},
      .count = normals[0].width(),
      .encoding = encoding,
      .turn = from_world ? *camera->world_to_camera : Mat4(),
      .has_rays = camera && !camera->orthographic,
      .first_x = window.min_x + 0.5,
      .cx = lens.cx,
      .fx = lens.fx,
      .ray_y = lens.unproject(0, window.min_y + y + 0.5, 1).y});
  });
}

}  // namespace aftershade::io
#endif
