#include "core/motionblur/motion_rows.h"

#include <limits>

namespace aftershade::motionblur {

namespace {

const float* row_of(ConstPlaneView plane, int y) { return plane.data != nullptr ? plane.row(y) : nullptr; }

std::optional<filter::StaticMotion> camera_row(const MotionSources& sources,
                                               const std::optional<CameraReprojection>& camera, int y) {
  if (!camera || sources.depth.data == nullptr) return std::nullopt;
  return filter::static_motion(*camera, sources.window.min_y + y + 0.5);
}

MotionKernel kernel_of(const MotionParams& params, const MotionSources& sources) {
  MotionKernel kernel{};
  kernel.camera_share = params.camera_motion;
  kernel.object_share = params.object_motion;
  kernel.split = params.splits_motion();
  kernel.min_speed = params.min_speed_px;
  kernel.max_speed = params.max_speed_px > 0 ? params.max_speed_px : std::numeric_limits<float>::infinity();
  kernel.added_x = params.added_x_px;
  kernel.added_y = params.added_y_px;
  kernel.added_zoom = params.added_zoom;
  const Window& display = sources.display;
  kernel.centre_x = static_cast<float>(0.5 * (display.min_x + display.max_x + 1) - sources.window.min_x);
  return kernel;
}

}  // namespace

MotionRows::MotionRows(const MotionParams& params, const MotionSources& sources)
    : sources_(sources),
      kernel_(kernel_of(params, sources)),
      centre_y_(0.5 * (sources.display.min_y + sources.display.max_y + 1) - sources.window.min_y) {}

MotionRow MotionRows::row(int y) const {
  return {{row_of(sources_.prev_x, y), row_of(sources_.prev_y, y)},
          {row_of(sources_.next_x, y), row_of(sources_.next_y, y)},
          camera_row(sources_, sources_.before, y),
          camera_row(sources_, sources_.after, y),
          row_of(sources_.depth, y),
          {row_of(sources_.added_x, y), row_of(sources_.added_y, y)},
          row_of(sources_.added_mask, y),
          sources_.window.min_x,
          sources_.window.width(),
          static_cast<float>(y + 0.5 - centre_y_)};
}

}  // namespace aftershade::motionblur
