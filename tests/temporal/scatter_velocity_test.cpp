#include "core/temporal/reprojection.h"
#include "tests/temporal/temporal_helpers.h"

namespace aftershade::tests {
namespace {

using temporal::scatter_velocity;
using temporal::VelocityPlanes;

TEST(ScatterVelocity, TranslationGivesTheExactVectorBackAndHolesAtTheBorder) {
  const Window window = window_of(20, 9, -3, 40);
  const Plane mv_x(20, 9, 4.7F), mv_y(20, 9, -2.2F), depth(20, 9, 5.0F);
  const VelocityPlanes got = scatter_velocity(mv_x, mv_y, depth, window, window);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 20; ++x) {
      const bool covered = x >= 5 && y < 7;  // centres: 0.5 + 4.7 lies in pixel 5
      ASSERT_EQ(std::isnan(got.x(x, y)), !covered) << x << " " << y;
      if (covered) {
        ASSERT_EQ(got.x(x, y), -4.7F);
        ASSERT_EQ(got.y(x, y), 2.2F);
      }
    }
}

TEST(ScatterVelocity, TheNearestInDepthWinsWhateverTheOrder) {
  for (const bool near_first : {true, false}) {
    Plane depth(5, 1, 9.0F), mv_x(5, 1, kNaN), mv_y(5, 1, 0.0F);
    mv_x(0, 0) = 2;  // both land on pixel 2
    mv_x(4, 0) = -2;
    depth(0, 0) = near_first ? 3.0F : 7.0F;
    depth(4, 0) = near_first ? 7.0F : 3.0F;
    const VelocityPlanes got = scatter_velocity(mv_x, mv_y, depth, window_of(5, 1), window_of(5, 1));
    EXPECT_EQ(got.x(2, 0), near_first ? -2.0F : 2.0F);
    for (const int x : {0, 1, 3, 4}) EXPECT_TRUE(std::isnan(got.x(x, 0)) && std::isnan(got.y(x, 0))) << x;
  }
}

TEST(ScatterVelocity, TiesGoToTheLowerRowThenColumn) {
  const Plane depth(3, 3, 2.0F);
  const Plane mv_x = plane_of(3, 3, [](int x, int) { return static_cast<float>(1 - x); });
  const Plane mv_y = plane_of(3, 3, [](int, int y) { return static_cast<float>(1 - y); });
  const VelocityPlanes got = scatter_velocity(mv_x, mv_y, depth, window_of(3, 3), window_of(3, 3));
  EXPECT_EQ(got.x(1, 1), -1.0F);  // all nine arrive; pixel (0, 0) keeps the place
  EXPECT_EQ(got.y(1, 1), -1.0F);
}

TEST(ScatterVelocity, BackgroundLosesAgainstAnySurfaceAndBadVectorsAreSkipped) {
  Plane depth(6, 1, kInf), mv_x(6, 1, 0.0F), mv_y(6, 1, 0.0F);
  depth(1, 0) = 50;
  mv_x(1, 0) = 1;  // covers the background's own pixel 2
  mv_x(3, 0) = kNaN;
  mv_y(4, 0) = kInf;
  mv_x(5, 0) = 1e30F;
  depth(0, 0) = kNaN;
  const VelocityPlanes got = scatter_velocity(mv_x, mv_y, depth, window_of(6, 1), window_of(6, 1));
  EXPECT_EQ(got.x(0, 0), 0.0F);
  EXPECT_EQ(got.x(2, 0), -1.0F);
  for (const int x : {1, 3, 4, 5}) EXPECT_TRUE(std::isnan(got.x(x, 0))) << x;
}

TEST(ScatterVelocity, DepthsThatAreNoneCountAsBackground) {
  for (const float none : {kNaN, 0.0F, -1.0F, kInf})
    for (const int from : {0, 2}) {  // the surface arrives on the bad pixel before and after it
      Plane depth(3, 1, none), mv_x(3, 1, 0.0F), mv_y(3, 1, 0.0F);
      depth(from, 0) = 50;
      mv_x(from, 0) = static_cast<float>(1 - from);
      const VelocityPlanes got = scatter_velocity(mv_x, mv_y, depth, window_of(3, 1), window_of(3, 1));
      EXPECT_EQ(got.x(1, 0), static_cast<float>(from - 1)) << none;
    }
}

TEST(ScatterVelocity, WindowsAreAlignedByAbsoluteCoordinates) {
  const Plane mv_x(4, 2, 1.0F), mv_y(4, 2, 0.0F), depth(4, 2, 2.0F);
  const VelocityPlanes got = scatter_velocity(mv_x, mv_y, depth, window_of(4, 2, 10, 5), window_of(6, 3, 12, 4));
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 6; ++x)
      EXPECT_EQ(std::isnan(got.x(x, y)), !(y >= 1 && x + 12 >= 11 && x + 12 <= 14)) << x << " " << y;
}

TEST(ScatterVelocity, CarriedVectorsFindTheSurfaceTheyCameFrom) {
  // A nearer square moves over a still wall: at every pixel that frame f-1 reaches, reprojection ends on its own
  // surface.
  const auto square = [](int x, int y, int left) { return x >= left && x < left + 6 && y >= 3 && y < 9; };
  const Window window = window_of(24, 12);
  const Plane before = plane_of(24, 12, [&](int x, int y) { return square(x, y, 4) ? 2.0F : 6.0F; });
  const Plane now = plane_of(24, 12, [&](int x, int y) { return square(x, y, 9) ? 2.0F : 6.0F; });
  const Plane mv_x = plane_of(24, 12, [&](int x, int y) { return square(x, y, 4) ? 5.0F : 0.0F; }), mv_y(24, 12);
  const VelocityPlanes mv = scatter_velocity(mv_x, mv_y, before, window, window);
  const temporal::Reprojected got =
      reproject({now, window, std::nullopt, mv.x, mv.y}, temporal::ReprojectionSource::automatic, 0.5F);
  int unknown = 0;
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 24; ++x) {
      if (std::isnan(got.x(x, y))) {
        EXPECT_TRUE(square(x, y, 4)) << "only what the square uncovered is unknown: " << x << " " << y;
        ++unknown;
        continue;
      }
      EXPECT_EQ(before(static_cast<int>(got.x(x, y)), static_cast<int>(got.y(x, y))), now(x, y)) << x << " " << y;
    }
  EXPECT_EQ(unknown, 5 * 6);
}

}  // namespace
}  // namespace aftershade::tests
