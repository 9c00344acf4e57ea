#pragma once
#include "core/ao/estimator.h"
#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/params/table.h"

namespace aftershade::ao {

enum class CircleGrowth { linear, sqrt };

/// SOMA's SSAO (P. Wester, "Generating smooth and cheap SSAO using Temporal Blur", 2014; seed 001): taps in a growing
/// circle around the pixel, out to 1.5 m or half a screen; each occludes by how close it is and whether it lies in
/// front of the surface. The article has no formula; algorithms 5.2 fills it in (ours):
///   tap i lies at i golden turns + rotation, min(R f / z, share of the screen) (i + 0.5) / taps px away,
///     or by the root of (i + 0.5) / taps
///   visibility = 1 - sat(strength mean_i(max(v_i / |v_i| . n - bias, 0) max(1 - |v_i| / R, 0)))
/// v goes from the pixel's point to the tap's. The screen's share limits where taps fall; R stays what it is. Taps on
/// background do not occlude; taps outside the image stand for as much occlusion as those inside.
struct GrowingCircleParams {
  static constexpr std::string_view method = "growing-circle";
  static constexpr std::string_view summary = "SOMA's ambient occlusion: taps in a growing circle";
  Resolution resolution = Resolution::half;
  int taps = 16;
  CircleGrowth growth = CircleGrowth::linear;  ///< ours: not stated by the seed
  float radius_m = 1.5F;
  float reach_screens = 0.5F;
  float bias = 0.05F;          ///< ours
  float strength = 6;          ///< ours: matches a uniform hemisphere integral in a corner at 0.2 R
  bool pixel_rotation = true;  ///< one of 16 rotations a pixel, in a 4x4 pattern
  bool per_frame_noise = false;
  NormalSource normals = NormalSource::automatic;
  static const params::Table& table();
  bool operator==(const GrowingCircleParams&) const = default;
};

/// Visibility (1 = open) at the grid's texels; 1 on background. `screen_px` is the longer side of the display window;
/// `frame_number` only matters with per_frame_noise.
Plane growing_circle(const GrowingCircleParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                     int screen_px, int frame_number);

}  // namespace aftershade::ao
