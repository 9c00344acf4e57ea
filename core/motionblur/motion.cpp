#include "core/motionblur/motion.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "core/motionblur/motion_kernel.h"
#include "core/parallel/rows.h"

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

Motion motion_of(const MotionParams& params, const MotionSources& sources, WithoutVector* without) {
  const int width = sources.window.width(), height = sources.window.height();
  Motion out{Plane(width, height), Plane(width, height), Plane(width, height), Plane(width, height)};
  const MotionKernel kernel = kernel_of(params, sources);
  const double centre_y = 0.5 * (sources.display.min_y + sources.display.max_y + 1) - sources.window.min_y;
  std::atomic<bool> by_camera = false, still = false;
  for_rows(height, [&](int y) {
    const auto before = camera_row(sources, sources.before, y), after = camera_row(sources, sources.after, y);
    const MotionRow row{{row_of(sources.prev_x, y), row_of(sources.prev_y, y)},
                        {row_of(sources.next_x, y), row_of(sources.next_y, y)},
                        before ? &*before : nullptr,
                        after ? &*after : nullptr,
                        row_of(sources.depth, y),
                        {row_of(sources.added_x, y), row_of(sources.added_y, y)},
                        row_of(sources.added_mask, y),
                        sources.window.min_x,
                        width,
                        static_cast<float>(y + 0.5 - centre_y),
                        out.prev_x.row(y),
                        out.prev_y.row(y),
                        out.next_x.row(y),
                        out.next_y.row(y)};
    const WithoutVector of_row = motion_row(kernel, row);
    if (of_row.by_camera) by_camera = true;
    if (of_row.still) still = true;
  });
  if (without != nullptr) *without = {by_camera, still};
  return out;
}

float longest_displacement_px(const Motion& motion, Shutter shutter, Path path) {
  const double back = std::max(-shutter.opens, 0.0F), ahead = std::max(shutter.closes, 0.0F);
  const double longest_time = std::max(back, ahead);
  const auto length = [&](double px, double py, double nx, double ny) {
    if (path == Path::separate) return std::max(back * std::hypot(px, py), ahead * std::hypot(nx, ny));
    const double mean = 0.5 * longest_time * std::hypot(nx - px, ny - py);
    const double bend = 0.5 * longest_time * longest_time * std::hypot(nx + px, ny + py);
    return path == Path::straight ? mean : mean + bend;
  };
  std::vector<double> rows(static_cast<size_t>(motion.prev_x.height()));
  for_rows(motion.prev_x.height(), [&](int y) {
    for (int x = 0; x < motion.prev_x.width(); ++x)
      rows[static_cast<size_t>(y)] =
          std::max(rows[static_cast<size_t>(y)],
                   length(motion.prev_x(x, y), motion.prev_y(x, y), motion.next_x(x, y), motion.next_y(x, y)));
  });
  return rows.empty() ? 0 : static_cast<float>(*std::ranges::max_element(rows));
}

Shutter shutter_of(const PathParams& params, float shutter_frames) {
  switch (params.shutter_phase) {
    case ShutterPhase::centred:
      return {-0.5F * shutter_frames, 0.5F * shutter_frames};
    case ShutterPhase::start:
      return {0, shutter_frames};
    case ShutterPhase::end:
      return {-shutter_frames, 0};
    case ShutterPhase::custom:
      break;
  }
  return {params.shutter_opens_frames, params.shutter_opens_frames + shutter_frames};
}

}  // namespace aftershade::motionblur
