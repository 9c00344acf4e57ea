#pragma once
#include "core/image/plane.h"
#include "core/image/window.h"

namespace aftershade {

/// `source`, whose index (0, 0) is at the corner of `from`, in a plane for the window `to` (both in absolute
/// coordinates): pixels that it does not cover are `background`, pixels outside `to` are dropped.
inline Plane placed(ConstPlaneView source, Window from, Window to, float background) {
  Plane out(to.width(), to.height(), background);
  copy_at(source, out, from.min_x - to.min_x, from.min_y - to.min_y);
  return out;
}

}  // namespace aftershade
