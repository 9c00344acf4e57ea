#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/ao/reference_ao.h"
#include "core/ao/slice_ao.h"
#include "tests/support/scenes.h"
#include "tests/support/truth_cache.h"

/// Slice AO against rays through the same depth buffer, and against the ray-traced truth of scenes.
namespace aftershade::tests {
namespace {

using ao::ReferenceAoParams;
using ao::SliceAoParams;

struct Difference {
  double rmse = 0, bias = 0;
};
Difference difference(ConstPlaneView a, ConstPlaneView b, ConstPlaneView depth) {
  double squares = 0, sum = 0, count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      if (!std::isfinite(depth(x, y))) continue;
      squares += std::pow(a(x, y) - b(x, y), 2);
      sum += a(x, y) - b(x, y);
      ++count;
    }
  return {std::sqrt(squares / count), sum / count};
}

TEST(SliceAoReference, AgreesWithRaysAndWithTheTracedTruthOfScenes) {
  constexpr int kWidth = 160, kHeight = 90;
  // Limits: what was measured and a little more. A ray sees a thing cover whole pixels, a slice the line through their
  // centres, so they part where things are as thin as a pixel (grass, garden).
  const struct {
    const char* scene;
    double to_truth, to_rays, bias;
  } expected[] = {{"corner", 0.01, 0.02, 0.01},
                  {"columns", 0.065, 0.04, 0.02},
                  {"grass", 0.10, 0.12, 0.09},
                  {"garden", 0.09, 0.085, 0.05},
                  {"crossing", 0.006, 0.01, 0.003}};
  for (const auto& [name, to_truth, to_rays, bias] : expected) {
    const Frame frame = render(find_scene(name), 3, {kWidth, kHeight, 1});
    const auto& normals = frame.planes(Role::normal);
    const Plane& depth = frame.planes(Role::depth)[0];
    const filter::Surface surface{depth, normals[0], normals[1], normals[2], local_projection(*frame.camera, 0, 0),
                                  0,     0,          kHeight};
    SliceAoParams slices;
    slices.slices = 8;
    slices.steps = 0;
    slices.pixel_filter_px = 0;
    ReferenceAoParams rays;
    rays.pixel_filter_px = 0;
    rays.rays = 64;
    const filter::SampleGrid grid = filter::full_grid(surface);
    const Plane sliced = ao::slice_ao(slices, surface, grid, 0), traced = ao::reference_ao(rays, surface, grid);
    const Plane truth = cached_ao_truth(name, 3, kWidth, kHeight, AoTruth{});
    const Difference twins = difference(sliced, traced, depth), real = difference(sliced, truth, depth);
    std::printf("%-9s slices - rays: RMSE %.4f bias %+.4f; slices - truth: RMSE %.4f bias %+.4f\n", name, twins.rmse,
                twins.bias, real.rmse, real.bias);
    EXPECT_LT(real.rmse, to_truth) << name;
    EXPECT_LT(twins.rmse, to_rays) << name;
    EXPECT_LT(std::abs(twins.bias), bias) << name;
  }
}

}  // namespace
}  // namespace aftershade::tests
