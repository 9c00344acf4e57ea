#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/error.h"
#include "core/io/conversions.h"
#include "core/parallel/rows.h"

namespace aftershade::io {

namespace {

constexpr double kBackground = std::numeric_limits<double>::infinity();

bool is_device(DepthKind kind) { return kind == DepthKind::device || kind == DepthKind::device_reversed; }

}  // namespace

void check_depth(const Encoding& encoding, const DepthContext& context) {
  if (encoding.depth_kind == DepthKind::ray && !context.camera)
    throw Error(ErrorCode::data,
                "the depth is the distance along the view ray, and without a camera it cannot become planar",
                "give --fov or --camera FILE");
  if (!is_device(encoding.depth_kind)) return;
  if (!context.near_plane || !context.far_plane)
    throw Error(ErrorCode::usage, "device depth needs the distances of the near and far plane",
                "give --near and --far, or a camera file");
  if (!(*context.near_plane > 0 && *context.far_plane > *context.near_plane))
    throw Error(ErrorCode::usage, "the far plane must lie beyond the near plane, and both before the camera",
                "check --near and --far");
}

namespace {

bool is_background(double stored, const Encoding& encoding) {
  return !(std::abs(stored) < encoding.background_above) || (encoding.zero_is_background && stored == 0);
}

/// Is the median of what is no background negative? At most some 100000 pixels are looked at, on a fixed grid.
bool is_negative(ConstPlaneView depth, const Encoding& encoding) {
  const int step = std::max(1, static_cast<int>(std::sqrt(double{1} * depth.width * depth.height / 1e5)));
  int64_t below = 0, above = 0;
  for (int y = 0; y < depth.height; y += step)
    for (int x = 0; x < depth.width; x += step) {
      const double stored = depth(x, y);
      if (is_background(stored, encoding)) continue;
      const double value = (stored - encoding.neutral) * encoding.scale[0];
      below += value < 0 ? 1 : 0;
      above += value > 0 ? 1 : 0;
    }
  return below > above;
}

/// Planar distance in stored units (conventions 2, rules 1 to 4).
double planar(double value, DepthKind kind, double ray_length, double near_plane, double far_plane) {
  switch (kind) {
    case DepthKind::planar:
      return value;
    case DepthKind::ray:
      return value / ray_length;
    case DepthKind::inverse:
      return 1 / value;  // 0 becomes infinity
    case DepthKind::device:
      return value < 1 ? near_plane * far_plane / (far_plane - value * (far_plane - near_plane)) : kBackground;
    case DepthKind::device_reversed:
      return value > 0 ? near_plane * far_plane / (near_plane + value * (far_plane - near_plane)) : kBackground;
  }
  return kBackground;
}

}  // namespace

void convert_depth(PlaneView depth, const Encoding& encoding, const DepthContext& context) {
  check_depth(encoding, context);
  const bool turn = !is_device(encoding.depth_kind) && is_negative(depth, encoding);
  const bool by_ray = encoding.depth_kind == DepthKind::ray && !context.camera->orthographic;
  const double near_plane = context.near_plane.value_or(0), far_plane = context.far_plane.value_or(0);
  for_rows(depth.height, [&](int y) {
    for (int x = 0; x < depth.width; ++x) {
      float& pixel = depth(x, y);
      double z = kBackground;
      if (!is_background(pixel, encoding)) {
        const double value = (pixel - encoding.neutral) * encoding.scale[0] * (turn ? -1 : 1);
        const double ray_length =
            by_ray
                ? context.camera->unproject(context.window.min_x + x + 0.5, context.window.min_y + y + 0.5, 1).length()
                : 1;
        z = planar(value, encoding.depth_kind, ray_length, near_plane, far_plane) * context.metres_per_unit;
      }
      pixel = z > 0 ? static_cast<float>(z) : std::numeric_limits<float>::infinity();
    }
  });
}

void drop_not_beyond(PlaneView depth2, ConstPlaneView depth) {
  for_rows(depth2.height, [&](int y) {
    for (int x = 0; x < depth2.width; ++x)
      if (!(depth2(x, y) > depth(x, y))) depth2(x, y) = std::numeric_limits<float>::infinity();
  });
}

}  // namespace aftershade::io
