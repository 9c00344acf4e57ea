#pragma once
#include <string>

#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/params/table.h"

namespace aftershade::filter {

/// Depth-aware separable blur (seed 004, "Depth aware bilateral blur; wide filter to hide pattern"). Gaussian over the
/// radius (sigma = (radius + 1) / 2, seed 000's CrossBilateralWeight), times exp2(-(d / tolerance)^2) where d is the
/// distance of the tap from the centre's tangent plane: a slope is blurred, an edge is not. Background neither gives
/// nor takes.
/// "You still have an extra channel so you should use it to soften some of your shadows": `channel` names a channel of
/// the file that is blurred instead of the AO.
struct BilateralBlurParams {
  static constexpr std::string_view method = "bilateral-blur";
  static constexpr std::string_view summary =
      "depth-aware Gaussian blur of the AO, at its resolution, or of any channel";
  float radius_px = 4;  ///< at the reference height, in texels of the AO's own grid
  float reference_height_px = 1080;
  float edge_distance_m = 0.05F;  ///< tolerance: at least this far from the tangent plane ...
  float edge_footprints = 2;      ///< ... or this many footprints of a grid texel at the pixel's depth
  std::string channel{};          ///< of the file, without view; "": the AO
  static const params::Table& table();
  bool operator==(const BilateralBlurParams&) const = default;
};

/// The radius at this image height, in texels: at least 2, unless radius_px is less.
float radius_texels(const BilateralBlurParams& params, int display_height);

/// `value` on the grid; returns the blurred value on the grid. X pass, then Y pass, both with the centre's surface.
Plane bilateral_blur(const BilateralBlurParams& params, ConstPlaneView value, const SampleGrid& grid,
                     const Surface& surface);

}  // namespace aftershade::filter
