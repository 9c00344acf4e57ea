#include "core/motionblur/gather_source.h"

#include "core/motionblur/gather_source_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

GatherSource gather_source(const HalfVelocity& velocity, ConstPlaneView depth, std::span<Plane* const> channels) {
  const int width = velocity.x.width(), height = velocity.x.height();
  GatherSource source{Plane(width, height), Plane(width, height, kInfinite), {}};
  for (const Plane* channel : channels) source.colour.push_back(copy_of(*channel));
  for_rows(height, [&](int y) {
    speed_row(velocity.x.row(y), velocity.y.row(y), width, source.speed.row(y));
    for (const Plane& channel : source.colour) exclude_row(channel.row(y), width, source.speed.row(y));
    if (depth.data != nullptr) finite_depth_row(depth.row(y), width, source.depth.row(y));
  });
  return source;
}

}  // namespace aftershade::motionblur
