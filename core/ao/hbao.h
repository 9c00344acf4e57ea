#pragma once
#include <array>

#include "core/ao/estimator.h"
#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/params/table.h"

namespace aftershade::ao {

enum class Tangents { shorter_difference, normals };
enum class HbaoBorder { clamp, open, renormalise };

/// Horizon-based ambient occlusion (Bavoil, Sainz, Dimitrov 2008; ShaderX7 2009), in the form of NVIDIA's SDK 11 that
/// seed 000 points at ("HBAO" slides; algorithms 1.1, 1.2). Around the view axis, in each of `directions`, taps raise a
/// horizon above the surface's tangent; each raise occludes by what it adds, weighted by its tap's distance r:
///   AO = 1 - strength / directions * sum (1 - r^2 / R^2) (sin h_new - sin h_old),  then AO^power_exponent
/// h starts at the tangent's elevation, lifted by the bias: tan h = tan t + tan bias. Taps lie on texels of the AO's
/// own resolution around the pixel: one near the pixel, the others a step apart, step = r_px / (n + 1),
/// n = min(steps, r_px); a projected radius below one texel leaves the pixel open. A 4x4 pattern that is the same every
/// frame turns the directions within their sector and shifts the taps. Background never occludes.
///
/// Known of Battlefield 3: half resolution, the pattern, the shorter difference. Assumed: SDK 11's numbers, the
/// defaults here. Unless `literal`: every tap is rounded to a texel by itself and measured from the tangent in its own
/// direction, so that a plane stays open; SDK 11 rounds the step, and measures all but the first tap from one tangent.
struct HbaoParams {
  static constexpr std::string_view method = "hbao";
  static constexpr std::string_view summary = "horizon-based ambient occlusion (NVIDIA SDK 11, Battlefield 3)";
  Resolution resolution = Resolution::half;
  int directions = 8;
  int steps = 6;
  float radius_m = 1.0F;
  float bias_deg = 10;
  float strength = 1;
  float power_exponent = 1;  ///< SDK 11 applies it after the blur
  /// SDK 11 has 0.1 of the image's smaller side in pixels, but measures it in texels of the AO: 0.2 at half resolution.
  /// Measured against the display window's height.
  float max_footprint = 0.2F;
  Tangents tangents = Tangents::shorter_difference;
  NormalSource normals = NormalSource::automatic;
  /// What taps outside the image see: the border's depth, as in the SDK; nothing; or nothing, and directions count by
  /// their taps' share inside. Clamping does best on every scene measured: whatever stands on the border goes on.
  HbaoBorder border = HbaoBorder::clamp;
  bool literal = false;
  bool per_frame_noise = false;
  float refine_below = 0.5F;      ///< ours, as the two below: dual resolution only
  float edge_distance_m = 0.05F;  ///< as in filter::BilateralUpsampleParams
  float edge_footprints = 2;
  static const params::Table& table();
  bool operator==(const HbaoParams&) const = default;
};

/// The pattern by the low two bits of absolute texel coordinates (row y, column x), 16 values in [0, 1): the rotation
/// as a share of a direction's sector (Bayer), and the shift of the taps as a share of a step. Every aligned 2x2 block
/// covers both evenly, and the 16 pairs are a (0, 4, 2)-net in base 2: every dyadic box of area 1/16 has one.
struct HbaoPattern {
  std::array<float, 16> rotation, shift;
};
HbaoPattern hbao_pattern();

/// Visibility (1 = open) at the grid's texels; 1 on background. `frame_number` only matters with per_frame_noise.
Plane hbao(const HbaoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid, int frame_number);

/// Visibility at every pixel, for Resolution::dual: `grid` is the half-resolution grid. The AO at half resolution,
/// upsampled; pixels of which less than `refine_below` of the texels around lie on their surface are evaluated again at
/// full resolution. Bavoil and Sainz's dual-resolution SSAO (SIGGRAPH 2009 talk), which seed 000 names as a considered
/// workaround, has no public details but its citation of Cantlay's mixed-resolution particles (GPU Gems 3), which are
/// drawn coarsely and again finely at edges: the reading here. What an edge is, is ours.
Plane dual_resolution_hbao(const HbaoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                           int frame_number);

}  // namespace aftershade::ao
