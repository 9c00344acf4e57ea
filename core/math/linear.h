#pragma once
#include <ImathMatrix.h>
#include <ImathVec.h>

#include <cmath>
#include <exception>
#include <optional>

/// Points and matrices of set-up code, in double: Imath's, whose row vectors (p' = p * M, translation in the last row)
/// are OpenEXR's convention. Kernels use core/simd lanes instead.
namespace aftershade {

using Vec3 = Imath::V3d;
using Mat4 = Imath::M44d;

/// Determinant of the upper left 3x3: negative for a frame of the other handedness.
inline double determinant3(const Mat4& m) {
  const auto row = [&](int r) { return Vec3(m[r][0], m[r][1], m[r][2]); };
  return row(0).dot(row(1).cross(row(2)));
}

/// nullopt when the matrix is not finite or singular, or so nearly that its first three rows span no volume: their
/// determinant is below 1e-9 of the product of their lengths (a camera far from the origin is not singular).
inline std::optional<Mat4> inverse(const Mat4& m) {
  double lengths = 1;
  for (int r = 0; r < 3; ++r) lengths *= Vec3(m[r][0], m[r][1], m[r][2]).length();
  if (!(std::abs(determinant3(m)) > 1e-9 * lengths) || !std::isfinite(lengths)) return std::nullopt;
  try {
    const Mat4 result = m.inverse(true);
    for (int i = 0; i < 16; ++i)
      if (!std::isfinite(result[i / 4][i % 4])) return std::nullopt;
    return result;
  } catch (const std::exception&) {  // "Cannot invert singular matrix."
    return std::nullopt;
  }
}

/// Affine use (the last column is ignored): a point is translated, a direction is not.
inline Vec3 transform_point(const Vec3& p, const Mat4& m) {
  const auto column = [&](int c) { return p.x * m[0][c] + p.y * m[1][c] + p.z * m[2][c] + m[3][c]; };
  return {column(0), column(1), column(2)};
}
inline Vec3 transform_direction(const Vec3& d, const Mat4& m) {
  const auto column = [&](int c) { return d.x * m[0][c] + d.y * m[1][c] + d.z * m[2][c]; };
  return {column(0), column(1), column(2)};
}

}  // namespace aftershade
