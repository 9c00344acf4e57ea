#pragma once
#include "core/ao/depth_geometry.h"
#include "core/filter/surface.h"
#include "core/image/plane.h"

namespace aftershade::ao {

/// How wide the thing seen at each pixel appears, in metres across the view: the shortest distance between two
/// silhouettes along the row, the column and both diagonals through the pixel. A silhouette is where the next pixel
/// lies farther away and does not continue the surface (or is background). A surface that goes on behind something
/// nearer, or leaves the image, has no silhouette there; +inf where no line has a silhouette on both sides. Ours: depth
/// buffers have no back sides, and most things are about as deep as they are wide.
/// 0 on background. Lengths scale with the scene; depth as in filter::Surface.
Plane object_widths(ConstPlaneView depth, const Projection& projection);

/// Metres along its ray for which what is seen at a pixel goes on behind its front.
Plane thickness_map(const DepthGeometry& geometry, ConstPlaneView depth, const Projection& projection);

/// The same, in metres of planar depth.
Plane planar_thickness(const DepthGeometry& geometry, ConstPlaneView depth, const Projection& projection);

}  // namespace aftershade::ao
