#pragma once
#include <array>
#include <string>

#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/image/window.h"
#include "core/params/table.h"
#include "core/temporal/reprojection.h"

namespace aftershade::temporal {

enum class BlurTaps { box, binomial };

/// Temporal Blur (P. Wester, "Generating smooth and cheap SSAO using Temporal Blur", 2014; seed 001), at the value's
/// own resolution:
///   out_i = B((1 - h) B(x_i) + h out_{i-1}),  h = history_weight w_geometry w_difference
/// B: 5x5 bilateral blur in two passes of five taps, which skip whatever lies beyond the cut of 2 cm. out_{i-1} is what
/// left the second blur, fetched where the surface was. So the picture grows smoother from frame to frame, up to a
/// kernel of variance 2 s^2 + s^2 h / (1 - h) (algorithms 5.3). The article states the cut and the order; the formulas
/// of the weights are algorithms 5.2's (ours):
///   w_geometry = 1 - smoothstep(near_m, far_m, distance in space to what was seen there)
///   w_difference = (1 - sat(difference_scale |x - x'| / max(|x|, |x'|, 0.1)))^2,  x = B(x_i), x' = out_{i-1}: moving
///   objects leave no trail
/// Both distances are taken from the tangent plane, since on a slope the depth itself exceeds 2 cm from texel to texel
/// (algorithms 5.4); `literal` compares depths, as the article's words have it.
/// "Temporal Blur could be used to improve many other post effects": `channel` names a channel of the file instead.
struct TemporalBlurParams {
  static constexpr std::string_view method = "temporal-blur";
  static constexpr std::string_view summary = "SOMA's temporal blur: blur, blend with the frame before, blur again";
  float cut_m = 0.02F;
  float cut_footprints = 1;             ///< ours; 0: the original
  BlurTaps weights = BlurTaps::box;     ///< ours: not stated by the seed
  float history_weight = 0.9F;          ///< ours; box and 0.95 give the article's 64x64 (algorithms 14, item 11)
  float near_m = 0.05F, far_m = 0.07F;  ///< ours
  float difference_scale = 3;           ///< ours; 0: only the distance counts, and moving objects trail
  bool literal = false;
  bool warm_start = false;  ///< ours: new pixels look as smooth as those that have a history
  ReprojectionSource reprojection = ReprojectionSource::automatic;
  float agreement_px = 0.5F;
  std::string channel{};  ///< of the file, without view; "": the AO
  static const params::Table& table();
  bool operator==(const TemporalBlurParams&) const = default;
};

/// The surface at a grid's texels, in camera space: points (z +inf on background) and unit normals (0 where unknown).
struct TexelSurface {
  std::array<Plane, 3> point, normal;
};
TexelSurface texel_surface(const filter::SampleGrid& grid, const filter::Surface& surface);

/// What the filter keeps from one frame to the next.
struct TemporalBlurHistory {
  int step = 0;                  ///< of the grid; 0: nothing is known
  int texel_x = 0, texel_y = 0;  ///< absolute texel coordinates of index (0, 0)
  Projection projection;         ///< of that frame, in absolute pixel coordinates
  TexelSurface texels;
  Plane value;     ///< after the second blur
  Plane variance;  ///< along each axis, in texels, of the kernel that made `value` of that frame's and older ones
  Plane weight;    ///< h: how much of `value` came from the frame before, 0 to history_weight
};

/// One step of the filter; `value`, of any range, lies on the grid, `reprojected` has all pixels of the surface.
/// `history` is that of frame i-1 (empty, of another grid step: none; its window may differ) and becomes that of frame
/// i. Background neither gives nor takes; a value that is not finite counts as 1. `blurred_once`, if not null, receives
/// B(x_i).
Plane temporal_blur(const TemporalBlurParams& params, ConstPlaneView value, const filter::SampleGrid& grid,
                    const filter::Surface& surface, const Reprojected& reprojected, TemporalBlurHistory& history,
                    Plane* blurred_once = nullptr);

}  // namespace aftershade::temporal
