#include <gtest/gtest.h>

#include <set>

#include "core/ao/hbao.h"
#include "core/filter/bilateral_upsample.h"
#include "tests/filter/analytic_surface.h"

namespace aftershade::tests {
namespace {

using ao::HbaoParams;

TEST(HbaoPattern, CoversEveryBlockAndEveryBoxEvenly) {
  const ao::HbaoPattern pattern = ao::hbao_pattern();
  for (const auto& values : {pattern.rotation, pattern.shift})
    for (size_t block = 0; block < 4; ++block) {
      std::set<int> quarters;
      for (size_t i = 0; i < 4; ++i) {
        const size_t x = 2 * (block & 1) + (i & 1), y = 2 * (block >> 1) + (i >> 1);
        quarters.insert(static_cast<int>(values[4 * y + x] * 4));
      }
      EXPECT_EQ(quarters.size(), 4U);
    }
  for (int bits = 0; bits <= 4; ++bits) {
    std::set<std::pair<int, int>> boxes;
    for (size_t i = 0; i < 16; ++i)
      boxes.insert({static_cast<int>(std::ldexp(pattern.rotation[i], bits)),
                    static_cast<int>(std::ldexp(pattern.shift[i], 4 - bits))});
    EXPECT_EQ(boxes.size(), 16U) << bits;
  }
}

TEST(DualResolutionHbao, IsFullResolutionOnBladesAndUpsampledHalfElsewhere) {
  const Lens lens{100, 100, 80, 60};
  const View view = [&](double x, double y) {  // blades 1 px wide before a wall with a step
    if (x < 80 && std::fmod(x, 8) < 1) return Hit{4.6, Vec3(0, 0, -1)};
    return y < 60 ? Hit{5.0, Vec3(0, 0, -1)} : Hit{5.02, Vec3(0, 0, -1)};
  };
  const Picture p = picture(160, 120, lens, view);
  const filter::SampleGrid grid = filter::half_grid(p.surface());
  HbaoParams params;
  params.edge_footprints = 0.1F;
  const Plane half = filter::bilateral_upsample({params.edge_distance_m, params.edge_footprints},
                                                ao::hbao(params, p.surface(), grid, 1), grid, p.surface());
  const Plane every = ao::hbao(params, p.surface(), filter::full_grid(p.surface()), 1),
              dual = ao::dual_resolution_hbao(params, p.surface(), grid, 1);
  for (int y = 4; y < 116; ++y) {
    for (int x = 8; x < 80; x += 8) EXPECT_EQ(dual(x, y), every(x, y)) << x << ' ' << y;
    for (int x = 90; x < 156; ++x) EXPECT_EQ(dual(x, y), half(x, y)) << x << ' ' << y;
  }
  EXPECT_GT(differing_pixels(half, every), 1000);
  params.refine_below = 0;
  EXPECT_EQ(differing_pixels(ao::dual_resolution_hbao(params, p.surface(), grid, 1), half), 0);
}

}  // namespace
}  // namespace aftershade::tests
