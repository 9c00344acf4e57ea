#include "core/math/linear.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace aftershade {
namespace {

/// A rotation about a random axis with a translation, built without core/math.
Mat4 random_rigid(std::mt19937& random) {
  std::normal_distribution<double> normal;
  double q[4];
  double length = 0;
  for (double& v : q) v = normal(random), length += v * v;
  for (double& v : q) v /= std::sqrt(length);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),     0,  //
          2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),     0,
          2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y), 0,
          100 * normal(random),    100 * normal(random),    100 * normal(random),    1};
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Transform, IsRowVectorTimesMatrix) {
  Mat4 m;  // identity
  m[3][0] = 10, m[3][1] = 20, m[3][2] = 30;
  EXPECT_EQ(transform_point({1, 2, 3}, m), Vec3(11, 22, 33));
  EXPECT_EQ(transform_direction({1, 2, 3}, m), Vec3(1, 2, 3));
  Mat4 swap(0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1);  // x axis goes to y, y to z, z to x
  EXPECT_EQ(transform_point({1, 2, 3}, swap), Vec3(3, 1, 2));
}

TEST(Inverse, UndoesTheMatrix) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Mat4 m = random_rigid(random);
    const auto back = inverse(m);
    ASSERT_TRUE(back);
    expect_near(transform_point(transform_point({1, -2, 3}, m), *back), {1, -2, 3}, 1e-11);
  }
}

TEST(Inverse, TakesSmallUnits) {
  Mat4 m;
  for (int i = 0; i < 3; ++i) m[i][i] = 1e-4;
  const auto back = inverse(m);
  ASSERT_TRUE(back);
  EXPECT_NEAR((*back)[0][0], 1e4, 1e-8);
}

TEST(Inverse, RefusesSingularAndNonFiniteMatrices) {
  Mat4 zero(0.0), flat, nearly, nan, infinite;
  flat[2][2] = 0;
  nearly[1][0] = 1, nearly[1][1] = 1e-12;  // two rows that are all but parallel
  nan[0][1] = std::numeric_limits<double>::quiet_NaN();
  infinite[3][0] = std::numeric_limits<double>::infinity();
  for (const Mat4& m : {zero, flat, nearly, infinite}) EXPECT_EQ(inverse(m), std::nullopt) << m;
  EXPECT_EQ(inverse(nan), std::nullopt);
  nan[0][1] = 0, nan[0][0] = std::numeric_limits<double>::quiet_NaN();  // the first element that is looked at
  EXPECT_EQ(inverse(nan), std::nullopt);
}

TEST(Inverse, TakesACameraFarFromTheOrigin) {
  Mat4 far;
  far[3][0] = 1e9, far[3][2] = -2e9;  // a thousand kilometres in millimetres
  const auto result = inverse(far);
  ASSERT_TRUE(result);
  EXPECT_EQ((*result)[3][0], -1e9);
}

TEST(Determinant3, TellsHandedness) {
  Mat4 m;
  EXPECT_EQ(determinant3(m), 1);
  m[2][2] = -1;
  EXPECT_EQ(determinant3(m), -1);
  std::mt19937 random(2);
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(determinant3(random_rigid(random)), 1, 1e-12);
}

}  // namespace
}  // namespace aftershade
