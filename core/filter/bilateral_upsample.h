#pragma once
#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/params/table.h"

namespace aftershade::filter {

/// How the weights of a texel's place and of its surface come together.
enum class UpsampleWeights { multiplicative, additive, additive_literal };

/// Joint bilateral upsampling (Kopf et al. 2007) from picked pixels: tent weight of the distance to each texel's real
/// pixel, times exp2(-(d / tolerance)^2) of its distance from the pixel's tangent plane, over the 3x3 nearest texels.
/// Where no texel lies on the pixel's surface (sum of weights < 1e-3) the nearest in depth is taken.
/// `additive` is SOMA's form, known from ports of its shader (algorithms 5.1), over 2x2 texels: bilinear weight plus
/// 3 max(1 - |z_s - z| / additive_range_m, 1e-4), a texel standing for the centre of its block; `additive_literal` is
/// what the ports print: mixed texels weigh less than nothing, and texels stand half a block up and left of where they
/// are, so the picture is shifted down and right by about a pixel. Its result is clamped to [0, 1], as 8 bits did.
struct BilateralUpsampleParams {
  static constexpr std::string_view method = "bilateral-upsample";
  static constexpr std::string_view summary = "depth-aware interpolation of a half-resolution AO to every pixel";
  float edge_distance_m = 0.05F;
  float edge_footprints = 2;
  UpsampleWeights weights = UpsampleWeights::multiplicative;
  float additive_range_m = 0.1F;
  static const params::Table& table();
  bool operator==(const BilateralUpsampleParams&) const = default;
};

/// `value` on the grid; returns a plane of the surface's size, 1 on background. A grid of step 1 is copied.
Plane bilateral_upsample(const BilateralUpsampleParams& params, ConstPlaneView value, const SampleGrid& grid,
                         const Surface& surface);

}  // namespace aftershade::filter
