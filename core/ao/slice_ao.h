#pragma once
#include "core/ao/depth_geometry.h"
#include "core/ao/slice_turns.h"
#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"

namespace aftershade::ao {

/// Ambient occlusion that converges to the ray-traced, cosine-weighted truth of the visible geometry: slices through
/// the view vector (GTAO: Jimenez, Wu, Pesce, Jarabo 2016; algorithms 9.1), in each the exact union of the elevation
/// intervals that the samples hide (after the visibility bitmask of Therrien, Levesque, Gilet 2023; algorithms 9.3)
/// with a hard radius. Each sample hides what lies between its front and its back, farther along its own ray, as far
/// as inside the sphere of the radius. How deep things are and what lies beyond the image: DepthGeometry.
struct SliceAoParams : DepthGeometry {
  static constexpr std::string_view method = "slice-ao";
  static constexpr std::string_view summary = "slices with exact visibility intervals and estimated thickness";
  Resolution resolution = Resolution::full;
  int slices = 4;  ///< each has two sides
  int steps = 32;  ///< samples a side; 0: every pixel
  float radius_m = 1.0F;
  bool depth_mips = false;
  NoiseTile noise_tile = NoiseTile::four;
  float pixel_filter_px = 0.5F;
  bool per_frame_noise = false;
  static const params::Table& table();
  bool operator==(const SliceAoParams&) const = default;
};

/// Visibility (1 = open) at the grid's texels; 1 on background. `frame_number` only matters with per_frame_noise.
/// `depth2` (may be empty) is the planar depth in metres of what the pixel's ray meets next behind the first surface:
/// the first is at most that deep, and the second hides too.
Plane slice_ao(const SliceAoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
               int frame_number, ConstPlaneView depth2 = {});

}  // namespace aftershade::ao
