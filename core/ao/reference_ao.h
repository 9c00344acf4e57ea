#pragma once
#include "core/ao/depth_geometry.h"
#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"

namespace aftershade::ao {

enum class RayWeighting { cosine, uniform };  ///< of directions over the hemisphere about the normal
enum class RayFalloff { hard, squared };      ///< W(r) of a hit at r: 1, or 1 - (r/R)^2; 0 beyond R

/// Slow truth from the same buffers: rays over the hemisphere of every pixel, each followed pixel by pixel through the
/// picture until it meets something (algorithms 9.4, rung L3). A pixel's surface is a facet across its normal, as deep
/// as DepthGeometry says.
struct ReferenceAoParams : DepthGeometry {
  static constexpr std::string_view method = "reference-ao";
  static constexpr std::string_view summary =
      "rays through the depth buffer, pixel by pixel: slow, a measure for others";
  Resolution resolution = Resolution::full;
  int rays = 256;
  float radius_m = 1.0F;
  RayWeighting weighting = RayWeighting::cosine;
  RayFalloff falloff = RayFalloff::hard;
  float pixel_filter_px = 0.5F;
  static const params::Table& table();
  bool operator==(const ReferenceAoParams&) const = default;
};

/// Visibility (1 = open) at the grid's texels; 1 on background. Error by the number of rays: at most
/// about 0.5 / sqrt(rays) a pixel. `depth2` as in slice_ao.
Plane reference_ao(const ReferenceAoParams& params, const filter::Surface& surface, const filter::SampleGrid& grid,
                   ConstPlaneView depth2 = {});

}  // namespace aftershade::ao
