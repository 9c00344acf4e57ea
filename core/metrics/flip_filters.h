#pragma once
#include <vector>

#include "core/image/plane.h"

/// The spatial filters of FLIP (flip.h).
namespace aftershade::metrics {

using Kernel = std::vector<float>;  ///< 2 radius + 1 weights

/// Separable filters for a viewer who sees so many pixels per degree. Those of the contrast sensitivity sum to 1; the
/// detectors have a positive and a negative part that sum to 1 and -1, and 0 in the middle of an even surface.
struct FlipKernels {
  Kernel achromatic, red_green;
  Kernel blue_yellow_narrow, blue_yellow_wide;  ///< two Gaussians whose sum does not separate
  float wide_share;                             ///< weight of the wide one; the narrow one has the rest
  Kernel smooth, edge, point;                   ///< a Gaussian, its first and its second derivative
};
FlipKernels flip_kernels(double pixels_per_degree);

/// One pass; beyond the border the nearest pixel counts.
Plane filtered_along_x(ConstPlaneView image, const Kernel& kernel);
Plane filtered_along_y(ConstPlaneView image, const Kernel& kernel);

}  // namespace aftershade::metrics
