#pragma once
#include "core/ao/estimator.h"
#include "core/filter/pyramid.h"
#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/params/table.h"

namespace aftershade::ao {

enum class TapPattern { mirrored, spiral };
enum class DistanceFalloff { linear, quadratic, cubic, none };  ///< of d = |v| / r: 1-d, 1-d^2, (1-d^2)^3, 1 up to r
enum class RadiusClamp { radius, taps };                        ///< what max_radius_px shortens

/// Vicarious Visions' scalable ambient occlusion (Bukowski, Hennessy, McGuire, Osman, SIGGRAPH 2012; seed 004):
///   AO_s = max(1 - |v| / r, 0) * max((v / |v|) . n - bias, 0)          "Falloff Function" slide
///   AO_T = (2 scale / S * sum_s AO_s)^2, visibility = 1 - sat(AO_T)    "Total Occlusion" slide
/// v goes from the pixel's point to the tap's point. Current-gen: 4 taps in mirrored pairs at full resolution,
/// projected radius clamped to about 20 px; DX11: 9 taps on a procedural spiral, no clamp, taps far away read depth
/// mips (SAO's offset LOG_MAX_OFFSET = 3). Taps are linear in radius (SAO, algorithms 4.2). Taps outside the image and
/// on background do not occlude.
/// The slides leave room, and contradict themselves once (algorithms 14, item 22): the text beside the formula applies
/// the bias before it normalises, max(v . n - bias_m, 0) / |v|, which bias_m does (with bias 0). "Try some of your own
/// here": the distance falloff may also be quadratic (SAO's HQ variant), cubic (SAO's fast one) or none (algorithms
/// 4.3). "Change a random seed and re-run": passes.
struct ScalableAoParams {
  static constexpr std::string_view method = "scalable-ao";
  static constexpr std::string_view summary = "Vicarious Visions' scalable ambient occlusion (SIGGRAPH 2012)";
  Resolution resolution = Resolution::half;
  TapPattern pattern = TapPattern::spiral;
  int taps = 9;
  float radius_m = 1.0F;
  float max_radius_px = 0;  ///< clamp of the projected radius at the reference height; 0: none
  float reference_height_px = 720;
  RadiusClamp radius_clamp = RadiusClamp::radius;  ///< ours: the slide says no more than "Clamp Radius to ~20 pixels"
  DistanceFalloff falloff = DistanceFalloff::linear;
  float bias = 0.05F;   ///< ours: not stated by the seed
  float bias_m = 0;     ///< the bias of the slide's text
  float scale = 3.5F;   ///< ours: matches horizon-based AO in a corner at a tenth of the radius
  bool squared = true;  ///< the square of AO_T
  int passes = 1;       ///< runs with different rotations, averaged
  bool depth_mips = true;
  NormalSource normals = NormalSource::automatic;
  bool per_frame_noise = false;  ///< a new rotation pattern every frame
  static const params::Table& table();
  bool operator==(const ScalableAoParams&) const = default;
};

/// Visibility (1 = open) at the grid's texels; 1 on background. `frame_number` only matters with per_frame_noise.
Plane scalable_ao(const ScalableAoParams& params, const filter::Surface& surface, const filter::DepthPyramid& pyramid,
                  const filter::SampleGrid& grid, int frame_number);

}  // namespace aftershade::ao
