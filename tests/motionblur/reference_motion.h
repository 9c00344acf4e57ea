#pragma once
#include <optional>

#include "core/motionblur/motion.h"

namespace aftershade::tests {

struct MotionAt {
  Vec3 prev, next;  ///< z unused
};

/// The motion of pixel (x, y), counted from the window's corner, written straight from motion.h: scalar, in double,
/// through CameraReprojection.
MotionAt reference_motion(const motionblur::MotionParams& params, const motionblur::MotionSources& sources, int x,
                          int y);

}  // namespace aftershade::tests
