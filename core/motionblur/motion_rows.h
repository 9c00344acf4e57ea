#pragma once
#include <optional>

#include "core/filter/static_motion.h"
#include "core/motionblur/motion.h"

/// What the kernels of motion read, row by row.
namespace aftershade::motionblur {

/// One row of vectors; null pointers: unknown everywhere.
struct VelocityRow {
  const float *x, *y;
};

struct MotionKernel {
  float camera_share, object_share;
  bool split;                  ///< do the shares differ from 1?
  float min_speed, max_speed;  ///< px per frame; max_speed may be infinite
  float added_x, added_y, added_zoom;
  float centre_x;  ///< of the display window, from the first pixel's left edge
};

struct MotionRow {
  VelocityRow prev, next;
  std::optional<filter::StaticMotion> before, after;  ///< none: unknown camera
  const float* depth;                                 ///< read if a camera is known
  VelocityRow added;
  const float* mask;  ///< null: 1 everywhere
  int min_x, width;
  float from_centre_y;  ///< of the row's pixel centres, from the display window's
};

/// What motion_of() makes of a row's pixels.
class MotionRows {
 public:
  MotionRows(const MotionParams& params, const MotionSources& sources);
  const MotionKernel& kernel() const { return kernel_; }
  MotionRow row(int y) const;

 private:
  const MotionSources& sources_;
  MotionKernel kernel_;
  double centre_y_;
};

}  // namespace aftershade::motionblur
