// The AO kernels with parameters that presets do not reach, on every SIMD target: the bits of the one-lane twin.
#include <gtest/gtest.h>

#include "core/ao/apply_ao.h"
#include "core/ao/growing_circle.h"
#include "core/ao/hbao.h"
#include "core/ao/sample_validation.h"
#include "core/ao/scalable_ao.h"
#include "tests/filter/on_all_targets.h"

namespace aftershade::tests {
namespace {

using filter::SampleGrid;
using filter::Surface;

std::vector<Plane> one(Plane plane) {
  std::vector<Plane> out;
  out.push_back(std::move(plane));
  return out;
}

std::vector<Plane> on_both_grids(const Picture& p,
                                 const std::function<Plane(const Surface&, const SampleGrid&)>& make) {
  const Surface surface = p.surface();
  std::vector<Plane> out = one(make(surface, filter::full_grid(surface)));
  out.push_back(make(surface, filter::half_grid(surface)));
  return out;
}

void expect_scalable_ao_same(const std::string& name, const ao::ScalableAoParams& params) {
  expect_same_on_all_targets("scalable-ao, " + name, [&](const Picture& p) {
    const filter::DepthPyramid pyramid(p.depth, 6, p.origin_x, p.origin_y);
    return on_both_grids(p, [&](const Surface& surface, const SampleGrid& grid) {
      return ao::scalable_ao(params, surface, pyramid, grid, 3);
    });
  });
}

TEST(AoTargets, ScalableAo) {
  ao::ScalableAoParams params;
  params.radius_m = 5;  // taps on all mips and far outside
  expect_scalable_ao_same("far taps", params);
  params.depth_mips = false;
  params.falloff = ao::DistanceFalloff::cubic;
  params.bias_m = 0.01F;
  expect_scalable_ao_same("without mips", params);
  params.pattern = ao::TapPattern::mirrored;
  params.passes = 3;
  params.per_frame_noise = true;
  params.radius_m = 0.3F;
  params.max_radius_px = 9;
  params.squared = false;
  params.falloff = ao::DistanceFalloff::none;
  expect_scalable_ao_same("passes", params);
}

TEST(AoTargets, Hbao) {
  ao::HbaoParams params;
  params.directions = 3;
  params.steps = 4;
  for (const auto border : {ao::HbaoBorder::clamp, ao::HbaoBorder::open, ao::HbaoBorder::renormalise})
    for (const auto tangents : {ao::Tangents::shorter_difference, ao::Tangents::normals})
      for (const bool literal : {false, true}) {
        params.border = border;
        params.tangents = tangents;
        params.literal = literal;
        params.power_exponent = literal ? 2.5F : 1.0F;
        expect_same_on_all_targets("hbao", [&](const Picture& p) {
          std::vector<Plane> out = on_both_grids(
              p, [&](const Surface& surface, const SampleGrid& grid) { return ao::hbao(params, surface, grid, 3); });
          out.push_back(ao::dual_resolution_hbao(params, p.surface(), filter::half_grid(p.surface()), 3));
          return out;
        });
      }
}

TEST(AoTargets, GrowingCircle) {
  for (const bool rotated : {false, true}) {
    ao::GrowingCircleParams params;
    params.pixel_rotation = params.per_frame_noise = rotated;
    params.growth = rotated ? ao::CircleGrowth::sqrt : ao::CircleGrowth::linear;
    expect_same_on_all_targets("growing circle", [&](const Picture& p) {
      return on_both_grids(p, [&](const Surface& surface, const SampleGrid& grid) {
        return ao::growing_circle(params, surface, grid, 131, 3);
      });
    });
  }
}

TEST(AoTargets, SphereKernelAndItsValidation) {
  for (const auto volume : {ao::SphereVolume::hemisphere, ao::SphereVolume::sphere})
    for (const auto validation : {ao::Validation::smooth, ao::Validation::binary}) {
      ao::SphereSamples params;
      params.volume = volume;
      ao::ValidationParams checks;
      checks.validation = validation;
      expect_same_on_all_targets("sphere kernel", [&](const Picture& p) {
        const Surface surface = p.surface();
        const SampleGrid grid = filter::full_grid(surface);
        Plane first = noise(grid.width(), grid.height(), 21), count = noise(grid.width(), grid.height(), 22);
        Plane x(grid.width(), grid.height()), y(grid.width(), grid.height());
        for (int j = 0; j < grid.height(); ++j)
          for (int i = 0; i < grid.width(); ++i) {
            x(i, j) = static_cast<float>(i) + 2 * first(i, j);
            y(i, j) = static_cast<float>(j) + 2 * count(i, j);
            first(i, j) = std::floor(first(i, j) * 5000);
            count(i, j) = std::floor(count(i, j) * 20);
          }
        Plane depth_before = copy_of(p.depth), expected = copy_of(p.depth);
        spoil(depth_before, 23);
        spoil(x, 24);
        const ao::SampleRange range{0, 0, first, count};
        std::vector<Plane> out = one(ao::sphere_kernel(params, surface, grid, range));
        out.push_back(ao::sphere_kernel(params, surface, filter::half_grid(surface), {5, 9, {}, {}}));
        out.push_back(ao::sample_confidence(params, checks, surface, grid, range,
                                            {depth_before, surface.projection, 0, 0, x, y, expected}));
        return out;
      });
    }
}

TEST(AoTargets, ApplyAo) {
  for (const auto baked : {ao::BakedAo::ignore, ao::BakedAo::multiply, ao::BakedAo::least})
    for (const auto target : {ao::ApplyTarget::everything, ao::ApplyTarget::ambient})
      expect_same_on_all_targets("apply-ao", [&](const Picture& p) {
        Frame frame;
        Layer layer;
        layer.receives_ao = true;
        layer.channels = {"R", "G", "B"};
        for (uint32_t i = 0; i < 3; ++i) {
          layer.planes.push_back(noise(p.depth.width(), p.depth.height(), 30 + i));
          frame.planes(Role::ambient).push_back(noise(p.depth.width(), p.depth.height(), 40 + i));
          spoil(layer.planes.back(), 50 + i);
          spoil(frame.planes(Role::ambient).back(), 60 + i);
        }
        frame.planes(Role::ao).push_back(noise(p.depth.width(), p.depth.height(), 70));
        frame.layers.push_back(std::move(layer));
        Plane ao = noise(p.depth.width(), p.depth.height(), 71);
        spoil(ao, 72);
        ao::apply_ao({target, 0.8F, 0.1F, baked}, ao, frame);
        return std::move(frame.layers[0].planes);
      });
}

}  // namespace
}  // namespace aftershade::tests
