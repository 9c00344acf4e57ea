#include "core/pipeline/blur_stage.h"

#include <cmath>

#include "core/base/text.h"

namespace aftershade::pipeline {

namespace {

/// Share of the light below which nobody needs to hear of its loss.
constexpr double kWorthSaying = 1e-3;
/// Cameras kept behind the frame: its neighbour's and that one's neighbour's.
constexpr int kCamerasBehind = 2;

Window expanded(Window w, int reach) { return {w.min_x - reach, w.min_y - reach, w.max_x + reach, w.max_y + reach}; }

/// Sum of |value| of the first three planes inside `inner` and everywhere.
struct Light {
  double inside = 0, all = 0;
};
Light light_of(const Layer& layer, Window window, Window inner) {
  Light light;
  for (size_t c = 0; c < layer.planes.size() && c < 3; ++c)
    for (int y = 0; y < window.height(); ++y)
      for (int x = 0; x < window.width(); ++x) {
        const double value = std::abs(layer.planes[c](x, y));
        if (!std::isfinite(value)) continue;
        light.all += value;
        if (inner.contains(x + window.min_x, y + window.min_y)) light.inside += value;
      }
  return light;
}

void warn_of_lost_light(Work& work, const Layer& layer) {
  const Light light = light_of(layer, work.frame.window, layer.data_window);
  const double lost = light.all > 0 ? 1 - light.inside / light.all : 0;
  if (lost > kWorthSaying)
    work.warn(
        cat("the data window cuts off ", fixed(100 * lost, 2), " % of the blurred light; --data-window grow keeps it"));
}

bool has_vectors(const RoleSet& roles) {
  return roles.contains(Role::velocity_prev) || roles.contains(Role::velocity_next);
}
bool has_vectors(const Frame& frame) { return frame.has(Role::velocity_prev) || frame.has(Role::velocity_next); }

ConstPlaneView plane_of(const Frame& frame, Role role, size_t i = 0) {
  return frame.has(role) ? ConstPlaneView(frame.planes(role)[i]) : ConstPlaneView();
}

/// As the stages before have left it.
ConstPlaneView named_plane(const Frame& frame, const std::string& name) {
  if (name.empty()) return {};
  const auto changed = frame.added.find(name);
  return changed != frame.added.end() ? changed->second : frame.named.at(name);
}

}  // namespace

std::vector<Plane*> channels_of(Layer& layer) {
  std::vector<Plane*> channels;
  for (Plane& plane : layer.planes) channels.push_back(&plane);
  return channels;
}

Needs BlurStage::needs(const Offer& offer) const {
  Needs needs;
  needs.optional = {Role::depth};
  needs.layers = needs.window = true;
  for (const std::string* name : {&motion_.added_velocity_x, &motion_.added_velocity_y, &motion_.added_mask})
    if (!name->empty()) needs.channels.push_back(*name);
  const bool vectors = has_vectors(offer.roles), depth = offer.roles.contains(Role::depth);
  const bool by_camera = !vectors && offer.position && depth;
  if (by_camera || motion_.splits_motion()) {
    needs.required = {Role::depth};
    needs.position = true;
  }
  needs.any_of = by_camera ? RoleSet() : RoleSet{Role::velocity_next, Role::velocity_prev};
  needs.or_else = ", or depth and camera matrices (--camera FILE.json)";
  const bool completed = motion_.unknown_vectors == motionblur::UnknownVectors::camera && offer.position && depth;
  if (needs.position || completed) needs.frames_before = needs.frames_after = 1;
  return needs;
}

void BlurStage::observe(const Work& work) { cameras_[work.frame.number] = work.frame.camera; }

void BlurStage::run(Work& work) {
  Frame& frame = work.frame;
  const float shutter = shutter_frames(work);
  motionblur::WithoutVector without;
  BlurScene scene = scene_of(frame, shutter, motion_of(frame, &without));
  report_motion(work, without);
  const int reach = reach_px(scene);
  const Window widest = united(frame.display, frame.window);  // blur may fill the picture, not leave it
  const Window window = intersection(expanded(frame.window, reach), widest);
  if (window != frame.window) {
    work.change_window(window);
    scene = scene_of(frame, shutter, motion_of(frame));
  }
  std::vector<Layer*> layers;
  for (Layer& layer : frame.layers)
    if (layer.receives_blur) layers.push_back(&layer);
  blur(work, scene, layers);
  for (Layer* layer : layers) {
    layer->changed = true;
    if (work.options.grow_data_window)
      layer->data_window = intersection(expanded(layer->data_window, reach), widest);
    else
      warn_of_lost_light(work, *layer);
  }
  while (!cameras_.empty() && cameras_.begin()->first < frame.number - kCamerasBehind) cameras_.erase(cameras_.begin());
}

motionblur::Motion BlurStage::motion_of(const Frame& frame, motionblur::WithoutVector* without) const {
  motionblur::MotionSources sources;
  sources.prev_x = plane_of(frame, Role::velocity_prev, 0);
  sources.prev_y = plane_of(frame, Role::velocity_prev, 1);
  sources.next_x = plane_of(frame, Role::velocity_next, 0);
  sources.next_y = plane_of(frame, Role::velocity_next, 1);
  sources.depth = plane_of(frame, Role::depth);
  const auto reprojection = [&](int neighbour) -> std::optional<CameraReprojection> {
    const std::optional<Camera> camera = camera_of(neighbour);
    if (!camera || !frame.camera) return std::nullopt;
    return CameraReprojection::create(*frame.camera, *camera);
  };
  sources.before = reprojection(frame.number - 1);
  sources.after = reprojection(frame.number + 1);
  sources.added_x = named_plane(frame, motion_.added_velocity_x);
  sources.added_y = named_plane(frame, motion_.added_velocity_y);
  sources.added_mask = named_plane(frame, motion_.added_mask);
  sources.window = frame.window;
  sources.display = frame.display;
  return motionblur::motion_of(motion_, sources, without);
}

std::optional<Camera> BlurStage::camera_of(int frame) const {
  const auto found = cameras_.find(frame);
  return found != cameras_.end() ? found->second : std::nullopt;
}

BlurScene BlurStage::scene_of(const Frame& frame, float shutter_frames, motionblur::Motion motion) const {
  return {std::move(motion), shutter_frames, plane_of(frame, Role::depth), frame.window, frame.display};
}

void BlurStage::report_motion(Work& work, motionblur::WithoutVector without) const {
  const bool vectors = has_vectors(work.frame);
  if ((!vectors || motion_.splits_motion()) && !camera_of(work.frame.number - 1) && !camera_of(work.frame.number + 1))
    work.warn("no frame beside this one: the camera's motion is not known, and counts as none");
  else if (!vectors)
    work.note("the file has no velocity: motion is the camera's alone");
  else if (without.by_camera)
    work.note("pixels without a vector move as the camera does");
  else if (without.still && motion_.unknown_vectors == motionblur::UnknownVectors::camera)
    work.note("pixels without a vector stay sharp: the camera's motion there is not known");
}

float BlurStage::shutter_frames(Work& work) const {
  if (!motion_.shutter_from_header) return motion_.shutter_frames;
  if (work.frame.shutter_angle_deg) return *work.frame.shutter_angle_deg / 360.0F;
  work.note(cat("no shutterAngle in the header: the shutter is ", motion_.shutter_frames, " frames"));
  return motion_.shutter_frames;
}

}  // namespace aftershade::pipeline
