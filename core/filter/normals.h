#pragma once
#include <array>

#include "core/camera/camera.h"
#include "core/image/plane.h"

namespace aftershade::filter {

/// x, y, z of a unit normal in camera space, facing the camera; (0,0,0) on background.
using Normals = std::array<Plane, 3>;

/// Normals from depth alone. Per axis the side is taken whose line, extended from two pixels away, meets the centre
/// best (in 1/z, where planes are linear; after atyuwen, "Improved normal reconstruction"), which keeps edges sharp.
/// `depth` as in Surface; any size >= 1x1; border pixels use the side that exists.
Normals normals_from_depth(ConstPlaneView depth, const Projection& projection);

}  // namespace aftershade::filter
