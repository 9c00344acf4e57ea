#include "core/ao/estimator.h"
#include "core/ao/scalable_ao.h"
#include "tests/bench/kernels/kernels.h"
#include "tests/support/scenes.h"

namespace aftershade::tests::kernels {

namespace {

constexpr int kDisplayHeight = 1080;
constexpr float kLimit_px = 18;
constexpr float kAlmostOpen = 0.99999994F;  // colours that it darkens again and again stay normal numbers

Plane cut(ConstPlaneView plane, int x, int y) {
  Plane out(kWidth, kHeight);
  copy_at(plane, out, -x, -y);
  return out;
}

/// Blades, a sphere and the ground between them.
Frame piece_of_grass() {
  constexpr int kLeft = 128, kTop = 128;
  const RoleSet roles{Role::depth, Role::normal, Role::velocity_prev, Role::velocity_next};
  Frame frame = render(find_scene("grass"), 5, {512, 288, 1}, roles);
  for (auto& planes : frame.roles)
    for (Plane& plane : planes) plane = cut(plane, kLeft, kTop);
  for (Plane& plane : frame.layers.at(0).planes) plane = cut(plane, kLeft, kTop);
  frame.window = {kLeft, kTop, kLeft + kWidth - 1, kTop + kHeight - 1};
  frame.layers[0].data_window = frame.window;
  return frame;
}

filter::Surface surface_of(const Frame& frame) {
  const auto& normal = frame.planes(Role::normal);
  return {frame.depth(),
          normal[0],
          normal[1],
          normal[2],
          local_projection(*frame.camera, frame.window.min_x, frame.window.min_y),
          frame.window.min_x,
          frame.window.min_y,
          kDisplayHeight};
}

temporal::ReprojectionInput reprojection_of(const Frame& frame, const Camera& before) {
  const auto& velocity = frame.planes(Role::velocity_prev);
  return {frame.depth(), frame.window, CameraReprojection::create(*frame.camera, before),
          velocity[0],   velocity[1],  false};
}

motionblur::Motion motion_of(const Frame& frame) {
  motionblur::MotionSources sources;
  sources.prev_x = frame.planes(Role::velocity_prev)[0], sources.prev_y = frame.planes(Role::velocity_prev)[1];
  sources.next_x = frame.planes(Role::velocity_next)[0], sources.next_y = frame.planes(Role::velocity_next)[1];
  sources.window = frame.window, sources.display = frame.display;
  return motionblur::motion_of({}, sources);
}

}  // namespace

Inputs::Inputs()
    : frame(piece_of_grass()),
      camera_before(camera_at(find_scene("grass"), 4, 512, 288)),
      surface(surface_of(frame)),
      grid(filter::half_grid(surface)),
      pyramid(frame.depth(), filter::kDepthLevels, surface.origin_x, surface.origin_y),
      ao(kWidth, kHeight, kAlmostOpen),
      half_ao(ao::scalable_ao({}, surface, pyramid, grid, 0)),
      before(reprojection_of(frame, *camera_before)),
      motion(motion_of(frame)),
      velocity(motionblur::half_velocity(motion, 0.5F, kLimit_px)) {}

}  // namespace aftershade::tests::kernels
