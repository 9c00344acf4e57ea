#include "core/filter/normals.h"

#include <gtest/gtest.h>

#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

Vec3 normal_at(const filter::Normals& n, int x, int y) { return {n[0](x, y), n[1](x, y), n[2](x, y)}; }

double worst_error(const filter::Normals& derived, const filter::Normals& exact) {
  double worst = 0;
  for (int y = 0; y < exact[0].height(); ++y)
    for (int x = 0; x < exact[0].width(); ++x)
      worst = std::max(worst, (normal_at(derived, x, y) - normal_at(exact, x, y)).length());
  return worst;
}

TEST(NormalsFromDepth, OfAPlaneAreItsNormalUpToTheBorders) {
  for (const bool orthographic : {false, true})
    for (const float fy : {100.0F, 60.0F}) {
      const Lens lens{100, fy, 20.25F, 14.5F, orthographic};
      const Picture p = picture(41, 29, lens, slanted_plane(lens));
      EXPECT_LT(worst_error(filter::normals_from_depth(p.depth, p.projection), p.normals), 2e-4) << orthographic << fy;
    }
}

TEST(NormalsFromDepth, StaySharpAtADepthEdge) {
  const Lens lens{100, 100, 20, 15};
  const Picture p = picture(40, 30, lens, [&](double x, double y) {
    return x < 20 ? meet_plane(lens, x, y, {0.5, 0, -1}, -3) : meet_plane(lens, x, y, {0, 0.7, -1}, -6);
  });
  EXPECT_LT(worst_error(filter::normals_from_depth(p.depth, p.projection), p.normals), 2e-4);
}

TEST(NormalsFromDepth, StaySharpAtACrease) {
  const Lens lens{100, 100, 20, 15};
  const Picture p = picture(40, 30, lens, [&](double x, double y) {
    const Hit left = meet_plane(lens, x, y, {0.5, 0, -1}, -3), right = meet_plane(lens, x, y, {-0.5, 0, -1}, -3);
    return left.z < right.z ? left : right;
  });
  EXPECT_LT(worst_error(filter::normals_from_depth(p.depth, p.projection), p.normals), 2e-4);
}

TEST(NormalsFromDepth, AreZeroOnBackgroundAndUnknownDepth) {
  const Lens lens{100, 100, 5, 5};
  Picture p = picture(10, 10, lens, slanted_plane(lens));
  const std::array<float, 5> background{kInf, kNan, 0.0F, -1.0F, -kInf};
  for (int i = 0; i < 5; ++i) p.depth(2 * i, 4) = background[static_cast<size_t>(i)];
  const filter::Normals n = filter::normals_from_depth(p.depth, p.projection);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 10; ++x) {
      const double expected = y == 4 && x % 2 == 0 ? 0 : 1;
      EXPECT_NEAR(normal_at(n, x, y).length(), expected, 1e-6) << x << ' ' << y;
      EXPECT_LE(normal_at(n, x, y).dot(lens.point(x + 0.5, y + 0.5, 1)), expected == 1 ? -1e-3 : 0)
          << "must face the camera";
    }
}

TEST(NormalsFromDepth, OfALonePixelFaceTheCamera) {
  const Plane one(1, 1, 4.0F);
  const filter::Normals n = filter::normals_from_depth(one, {100, 100, 0.5F, 0.5F, false});
  EXPECT_EQ(normal_at(n, 0, 0), Vec3(0, 0, -1));
}

TEST(NormalsFromDepth, WorkForEverySmallSize) {
  const Lens lens{100, 100, 1, 1};
  for (int height = 1; height <= 5; ++height)
    for (int width = 1; width <= 5; ++width) {
      const Picture p = picture(width, height, lens, slanted_plane(lens));
      const filter::Normals n = filter::normals_from_depth(p.depth, p.projection);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) EXPECT_NEAR(normal_at(n, x, y).length(), 1, 1e-6);
      EXPECT_LT(worst_error(n, p.normals), width >= 2 && height >= 2 ? 5e-4 : 2) << width << 'x' << height;
    }
}

TEST(NormalsFromDepth, DoNotDependOnTheUnitOfLengthOrTheThreads) {
  const Lens lens{100, 100, 20.3F, 15};
  const Picture p = picture(40, 30, lens, slanted_plane(lens));
  const Picture far = scaled(p, 1024);
  const filter::Normals a = filter::normals_from_depth(p.depth, p.projection);
  set_thread_count(3);
  const filter::Normals b = filter::normals_from_depth(far.depth, far.projection);
  set_thread_count(0);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(differing_pixels(a[i], b[i]), 0);
}

}  // namespace
}  // namespace aftershade::tests
