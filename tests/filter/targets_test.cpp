// The filters with parameters that presets do not reach, on every SIMD target: the bits of the one-lane twin.
#include <gtest/gtest.h>

#include "core/filter/bilateral_blur.h"
#include "core/filter/bilateral_upsample.h"
#include "core/filter/convergence_blur.h"
#include "core/filter/cross_bilateral_blur.h"
#include "core/filter/pyramid.h"
#include "tests/filter/on_all_targets.h"

namespace aftershade::tests {
namespace {

/// Values of a grid's texels, some of them no numbers.
Plane rough_values(const filter::SampleGrid& grid) {
  Plane out = noise(grid.width(), grid.height(), 11);
  spoil(out, 12);
  return out;
}

std::vector<Plane> on_both_grids(const Picture& p,
                                 const std::function<Plane(const filter::SampleGrid&, const filter::Surface&)>& make) {
  const filter::Surface surface = p.surface();
  std::vector<Plane> out;
  out.push_back(make(filter::full_grid(surface), surface));
  out.push_back(make(filter::half_grid(surface), surface));
  return out;
}

TEST(FilterTargets, GridsAndPyramid) {
  expect_same_on_all_targets("grids", [](const Picture& p) {
    filter::SampleGrid half = filter::half_grid(p.surface());
    std::vector<Plane> out;
    out.push_back(filter::full_grid(p.surface()).depth);
    for (Plane* plane : {&half.depth, &half.pixel_x, &half.pixel_y}) out.push_back(std::move(*plane));
    const filter::DepthPyramid pyramid(p.depth, 6, p.origin_x, p.origin_y);
    for (int m = 1; m < 6; ++m) out.push_back(copy_of(pyramid.level(m)));
    return out;
  });
}

TEST(FilterTargets, NormalsFromDepth) {
  expect_same_on_all_targets("normals", [](const Picture& p) {
    filter::Normals normals = filter::normals_from_depth(p.depth, p.projection);
    std::vector<Plane> out;
    for (Plane& plane : normals) out.push_back(std::move(plane));
    return out;
  });
}

TEST(FilterTargets, BilateralBlur) {
  for (const float radius : {0.5F, 2.3F, 21.0F}) {
    filter::BilateralBlurParams params;
    params.radius_px = radius;
    expect_same_on_all_targets(cat("bilateral blur, radius ", radius), [&](const Picture& p) {
      return on_both_grids(p, [&](const filter::SampleGrid& grid, const filter::Surface& surface) {
        params.reference_height_px = static_cast<float>(surface.display_height);
        return filter::bilateral_blur(params, rough_values(grid), grid, surface);
      });
    });
  }
}

TEST(FilterTargets, ConvergenceBlur) {
  filter::BilateralBlurParams params;
  params.radius_px = 3.5F;
  expect_same_on_all_targets("convergence blur", [&](const Picture& p) {
    return on_both_grids(p, [&](const filter::SampleGrid& grid, const filter::Surface& surface) {
      params.reference_height_px = static_cast<float>(surface.display_height);
      return filter::convergence_blur(params, rough_values(grid), noise(grid.width(), grid.height(), 13), grid,
                                      surface);
    });
  });
}

TEST(FilterTargets, Upsampling) {
  for (const auto weights : {filter::UpsampleWeights::multiplicative, filter::UpsampleWeights::additive,
                             filter::UpsampleWeights::additive_literal}) {
    filter::BilateralUpsampleParams params;
    params.weights = weights;
    expect_same_on_all_targets(cat("upsampling ", static_cast<int>(weights)), [&](const Picture& p) {
      return on_both_grids(p, [&](const filter::SampleGrid& grid, const filter::Surface& surface) {
        return filter::bilateral_upsample(params, rough_values(grid), grid, surface);
      });
    });
  }
}

TEST(FilterTargets, CrossBilateralBlur) {
  for (const auto sampling : {filter::KernelSampling::adaptive, filter::KernelSampling::adaptive_exact_weights,
                              filter::KernelSampling::brute_force})
    for (const auto fetch : {filter::AoFetch::block, filter::AoFetch::bilinear})
      for (const bool slope : {false, true}) {
        filter::CrossBilateralBlurParams params;
        params.sampling = sampling;
        params.ao_fetch = fetch;
        params.depth_slope = slope;
        expect_same_on_all_targets("cross-bilateral blur", [&](const Picture& p) {
          return on_both_grids(p, [&](const filter::SampleGrid& grid, const filter::Surface& surface) {
            return filter::cross_bilateral_blur(params, rough_values(grid), grid, surface.depth, 1200);
          });
        });
      }
}

}  // namespace
}  // namespace aftershade::tests
