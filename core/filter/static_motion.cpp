#include "core/filter/static_motion.h"

namespace aftershade::filter {

namespace {

/// As RowPolynomial, in double.
struct Polynomial {
  double a = 0, b = 0, c = 0;
  Polynomial operator+(const Polynomial& o) const { return {a + o.a, b + o.b, c + o.c}; }
  Polynomial operator*(double k) const { return {a * k, b * k, c * k}; }
  RowPolynomial in_float() const { return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)}; }
};

/// Coordinate k of the point in the other camera, over z in perspective, along the row at `y` below the axis. A point
/// of this camera is z (x / fx, -y / fy, 1), or (x / fx, -y / fy, z).
Polynomial coordinate(const CameraReprojection& cameras, int k, double y) {
  const Camera& now = cameras.now();
  const Mat4& delta = cameras.delta();
  const double ahead = delta[2][k], fixed = delta[3][k];
  return {(now.orthographic ? fixed : ahead) - y * delta[1][k] / now.fy, delta[0][k] / now.fx,
          now.orthographic ? ahead : fixed};
}

}  // namespace

StaticMotion static_motion(const CameraReprojection& cameras, double row_y) {
  const Camera &now = cameras.now(), &before = cameras.before();
  const double y = row_y - now.cy;
  const Polynomial ahead = coordinate(cameras, 2, y);
  // Perspective divides by the depth there; an orthographic camera by what coordinate() left out.
  const Polynomial scale = !before.orthographic ? ahead : now.orthographic ? Polynomial{1} : Polynomial{0, 0, 1};
  const Polynomial x = coordinate(cameras, 0, y) * before.fx + scale * (before.cx - now.cx);
  const Polynomial move_y = coordinate(cameras, 1, y) * -before.fy + scale * (before.cy - now.cy - y);
  const Polynomial move_x{x.a, x.b - scale.a, x.c};  // minus the pixel's own x times the scale
  return {move_x.in_float(),
          move_y.in_float(),
          scale.in_float(),
          ahead.in_float(),
          static_cast<float>(-scale.b),
          static_cast<float>(-scale.c),
          now.orthographic,
          static_cast<float>(now.cx)};
}

}  // namespace aftershade::filter
