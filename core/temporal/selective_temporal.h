#pragma once
#include <optional>

#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/image/window.h"
#include "core/params/table.h"
#include "core/temporal/reprojection.h"

namespace aftershade::temporal {

/// Selective Temporal Filtering (Bavoil and Andersson, "Stable SSAO in Battlefield 3", GDC 2012; seed 000). A pixel
/// near a depth discontinuity is unstable (may flicker, cannot trail) and is averaged with its history; all others keep
/// this frame's AO, so moving objects leave no trail on them:
///   if unstable and |1 - w_i / z_{i-1}| < epsilon:
///     AO = (N_{i-1} AO_{i-1} + AO_i) / (N_{i-1} + 1), N = min(N_{i-1} + 1, max_frames)
///   else: AO = AO_i, N = 1
/// w_i: depth of P_i seen from camera i-1. Stored with AO and N is z_i, the depth in view i (the seed's listing returns
/// w_i, which is the same thing only for a still camera). AO and N are fetched with four validated bilinear taps; N is
/// their weighted mean, not rounded, and exact where the camera stands still. With `literal`, w_i is stored, as listed,
/// z_{i-1} is that of the nearest pixel, and AO is fetched bilinearly from whatever is there.
struct SelectiveTemporalParams {
  static constexpr std::string_view method = "selective-temporal-filter";
  static constexpr std::string_view summary = "Battlefield 3's Selective Temporal Filtering of the AO";
  float epsilon = 0.10F;          ///< relative depth difference up to which the surface counts as the same
  float distance_m = 0.1F;        ///< L: neighbours farther apart than this are discontinuous ...
  float distance_footprints = 3;  ///< ... or than this many footprints of a grid texel (0: the seed literally)
  int dilation_texels = 4;        ///< side of the square that spreads discontinuities, in texels of the AO's grid
  int max_frames = 8;             ///< N_max: 8 gives a new frame at least 1/9 of the weight
  bool selective = true;          ///< false: every pixel is filtered (the plain temporal filter of the slides)
  ReprojectionSource reprojection = ReprojectionSource::automatic;
  float agreement_px = 0.5F;
  int afr_lanes = 1;     ///< graphics cards that take turns: frame i has the history of frame i - afr_lanes
  bool literal = false;  ///< the listing as printed, slips and all (algorithms 14, items 1 and 4)
  static const params::Table& table();
  bool operator==(const SelectiveTemporalParams&) const = default;
};

/// What the filter keeps from one frame to the next. Background has depth 0. Cleared: ao 1, depth 0, count 0 (seed 000,
/// "History Buffers").
struct TemporalHistory {
  Window window;  ///< absolute coordinates of the planes
  Plane ao, depth, count;
  Plane spare_ao, spare_depth, spare_count;  ///< memory of the frame before, to be written again
};

/// The dilated mask where it was made: on the AO's grid, of which only step and origin matter here.
struct StabilityMask {
  StabilityMask(ConstPlaneView at_pixels) : texels(at_pixels) {}
  StabilityMask(const Plane& at_pixels) : texels(at_pixels) {}
  StabilityMask(ConstPlaneView on_grid, const filter::SampleGrid& grid)
      : texels(on_grid), step(grid.step), origin_x(grid.origin_x), origin_y(grid.origin_y) {}
  ConstPlaneView texels;
  int step = 1, origin_x = 0, origin_y = 0;
};

/// 1 where the grid texel is piecewise continuous ("Piecewise Continuity Test"): along x and along y the nearer
/// neighbour is closer than L = max(distance_m, distance_footprints * footprint at the texel's depth). Background is
/// continuous with nothing: 0.
Plane continuity_mask(const SelectiveTemporalParams& params, const filter::SampleGrid& grid,
                      const filter::Surface& surface);

/// all_{n x n}: 1 where the whole n x n neighbourhood is 1; for even n offsets run from -n/2 to n/2 - 1. Texels outside
/// the image do not count.
Plane dilate_discontinuities(ConstPlaneView mask, int n);

/// One step of the filter at full resolution. `history` is that of the frame before (empty planes: cleared; its window
/// may differ in place and size) and becomes that of this one: history.count is N. Returns the filtered AO. All planes
/// cover `window`; `stable_mask` may be empty when params.selective is false. AO that is not finite counts as 1.
Plane selective_temporal_filter(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
                                const StabilityMask& stable_mask, const Reprojection& reprojection, Window window,
                                TemporalHistory& history);
/// The same with the past in planes.
Plane selective_temporal_filter(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
                                const StabilityMask& stable_mask, const Reprojected& reprojected, Window window,
                                TemporalHistory& history);

}  // namespace aftershade::temporal
