#pragma once
#include <optional>
#include <vector>

#include "core/camera/camera.h"
#include "core/image/plane.h"
#include "core/image/window.h"
#include "core/io/profile.h"

/// From what a producer stores to the canonical units of core/image/role.h, in place.
namespace aftershade::io {

/// What a depth needs beside its encoding. Stored units.
struct DepthContext {
  std::optional<Camera> camera;                 ///< for ray distance
  std::optional<double> near_plane, far_plane;  ///< for device depth
  double metres_per_unit = 1;
  Window window;  ///< absolute pixels of the plane
};
/// Throws Error(data) for ray distance without a lens, Error(usage) for device depth without near and far.
void check_depth(const Encoding& encoding, const DepthContext& context);
/// Stored depth to planar metres; +inf where there is background, no number or nothing in front of the camera. Depth
/// whose median is negative is turned round first (producers that write camera-space z looking along -Z). Throws what
/// check_depth throws.
void convert_depth(PlaneView depth, const Encoding& encoding, const DepthContext& context);
/// Second depths that are not beyond the first (both converted) become +inf: nothing lies behind there.
void drop_not_beyond(PlaneView depth2, ConstPlaneView depth);

/// Stored normals to unit vectors in camera space that face the camera; (0, 0, 0) where there is none (shorter than
/// 0.1). World-space normals need the camera's position; without a lens every view ray is taken to be the axis.
void convert_normals(std::vector<Plane>& normals, const Encoding& encoding, const std::optional<Camera>& camera,
                     Window window);

/// Stored vectors to pixels of a whole frame, y down; NaN where there is none (no number, sentinel, 10000 px and more).
void convert_velocity(std::vector<Plane>& velocity, const Encoding& encoding, Window display);

/// (stored - neutral) * scale, `missing` where that is no finite number; with `multiply` the second half of the planes
/// is multiplied into the first and dropped.
void convert_values(std::vector<Plane>& planes, const Encoding& encoding, float missing);

}  // namespace aftershade::io
