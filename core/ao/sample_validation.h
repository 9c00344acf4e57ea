#pragma once
#include "core/ao/sphere_kernel.h"
#include "core/camera/camera.h"

namespace aftershade::ao {

/// The surface of the frame before, and where each pixel of this frame was in it.
struct PastSurface {
  ConstPlaneView depth;   ///< metres, 0 or not finite: background; index (0, 0) is absolute pixel (min_x, min_y)
  Projection projection;  ///< of these planes
  int min_x = 0, min_y = 0;
  ConstPlaneView x, y, expected;  ///< one a pixel of this frame: absolute position, planar depth; NaN: unknown
  float same_depth = 0.1F;        ///< relative: neighbours in `depth` that differ by less are one surface
};

enum class Validation { smooth, binary, off };

/// Neighbourhood validation (Mattausch, Scherzer, Wimmer, "High-Quality Screen-Space Ambient Occlusion using Temporal
/// Coherence", CGF 2010; algorithms 6): AO found earlier still holds where the surfaces that decide it keep their
/// distance. For each sample, s_i being the surface seen at its pixel and p the texel's point,
///   delta_i = | |s_i - p| - |s_i_old - p_old| |
/// with s_i_old and p_old read from the old depth where s_i and p were then; confidence = min_i 1 / (1 + S delta_i), or
/// 0 beyond a limit. Only what can occlude matters: s_i above the tangent plane of p now, or something in front of s_i
/// then (an occluder that has left). Distances are compared up to 2 R, beyond which hardly anything occludes; S is per
/// radius, so that scale does not matter.
struct ValidationParams {
  Validation validation = Validation::smooth;
  float validation_sharpness = 100;  ///< S, ours: 15 to 30 from memory of the paper, whose unit of length is unknown
  float validation_limit = 0.05F;    ///< ours; binary: share of the radius
  float validation_footprints = 1;   ///< ours: differences up to this many pixel widths at p's depth are rounding
  bool operator==(const ValidationParams&) const = default;
};

/// Confidence in the AO of the frame before at the grid's texels, 0 to 1, by the samples of `range`. A sample that
/// matters and was outside the old image makes it 0.
Plane sample_confidence(const SphereSamples& params, const ValidationParams& validation, const filter::Surface& surface,
                        const filter::SampleGrid& grid, const SampleRange& range, const PastSurface& past);

}  // namespace aftershade::ao
