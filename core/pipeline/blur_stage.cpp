#include "core/pipeline/blur_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/text.h"
#include "core/parallel/rows.h"

namespace aftershade::pipeline {

namespace {

/// Share of the light below which nobody needs to hear of its loss.
constexpr double kWorthSaying = 1e-3;
/// Cameras kept behind the frame: its neighbour's and that one's neighbour's.
constexpr int kCamerasBehind = 2;

Window expanded(Window w, int reach) { return {w.min_x - reach, w.min_y - reach, w.max_x + reach, w.max_y + reach}; }

/// Sum of |value| over columns first to last - 1, in an order of its own; what is not finite counts for nothing.
double light_of_columns(const float* row, int first, int last) {
  constexpr int kSums = 8;  // beside each other, in the order of the columns
  constexpr float kMost = std::numeric_limits<float>::max();
  std::array<double, kSums> sums{};
  for (int x = first; x < last; x += kSums)
    for (int i = 0; i < std::min(kSums, last - x); ++i) {
      const float value = std::abs(row[x + i]);
      sums[static_cast<size_t>(i)] += value <= kMost ? static_cast<double>(value) : 0.0;
    }
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// Sum of |value| of the first three planes inside a window and outside it.
struct Light {
  double inside = 0, outside = 0;
};
Light light_of(const Layer& layer, Window window, Window inner) {
  const int width = window.width();
  const int first = std::clamp(inner.min_x - window.min_x, 0, width),
            last = std::clamp(inner.max_x + 1 - window.min_x, first, width);
  std::vector<Light> rows(static_cast<size_t>(window.height()));
  for_rows(window.height(), [&](int y) {
    Light& sum = rows[static_cast<size_t>(y)];
    const bool crosses = y + window.min_y >= inner.min_y && y + window.min_y <= inner.max_y;
    for (size_t c = 0; c < layer.planes.size() && c < 3; ++c) {
      const float* row = layer.planes[c].row(y);
      if (crosses) sum.inside += light_of_columns(row, first, last);
      sum.outside +=
          light_of_columns(row, 0, crosses ? first : width) + light_of_columns(row, crosses ? last : width, width);
    }
  });
  Light light;
  for (const Light& row : rows) light.inside += row.inside, light.outside += row.outside;
  return light;
}

void warn_of_lost_light(Work& work, const Layer& layer) {
  if (intersection(layer.data_window, work.frame.window) == work.frame.window) return;
  const Light light = light_of(layer, work.frame.window, layer.data_window);
  const double all = light.inside + light.outside, lost = all > 0 ? light.outside / all : 0;
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

BlurScene::BlurScene(const motionblur::MotionParams& params, const motionblur::MotionSources& sources,
                     float exposure_frames)
    : window(sources.window),
      display(sources.display),
      depth(sources.depth),
      shutter_frames(exposure_frames),
      params_(params),
      sources_(sources) {}

const motionblur::Motion& BlurScene::motion() const {
  if (!motion_) motion_ = motionblur::motion_of(params_, sources_, &without_);
  return *motion_;
}

motionblur::HalfVelocity BlurScene::half_velocity(float max_radius_px) const {
  if (motion_) return motionblur::half_velocity(*motion_, shutter_frames, max_radius_px);
  return motionblur::half_velocity(params_, sources_, shutter_frames, max_radius_px, &without_);
}

std::vector<Plane*> channels_of(Layer& layer) {
  std::vector<Plane*> channels;
  for (Plane& plane : layer.planes) channels.push_back(&plane);
  return channels;
}

void give_tiles(Work& work, const motionblur::VelocityTiles& tiles) {
  const motionblur::TileGrid grid(tiles.tile_px, work.frame.window);
  const auto at_pixels = [&](const Plane& of_tiles) {
    Plane out(work.frame.window.width(), work.frame.window.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) out(x, y) = of_tiles(grid.column_of(x), grid.row_of(y));
    });
    return out;
  };
  for (const auto& [aov, velocity] :
       {std::pair{Aov::tile_velocity, &tiles.own}, std::pair{Aov::neighbour_velocity, &tiles.neighbours}}) {
    if (!work.wants(aov)) continue;
    work.give(aov, at_pixels(velocity->x), 0);
    work.give(aov, at_pixels(velocity->y), 1);
  }
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
  const Window widest = united(frame.display, frame.window);  // blur may fill the picture, not leave it
  std::vector<Layer*> layers;
  bool may_grow = widest != frame.window;
  for (Layer& layer : frame.layers)
    if (layer.receives_blur) {
      layers.push_back(&layer);
      may_grow = may_grow || (work.options.grow_data_window && layer.data_window != widest);
    }
  std::optional<BlurScene> scene(std::in_place, motion_, sources_of(frame), shutter);
  std::optional<motionblur::WithoutVector> without;
  const int reach = may_grow ? reach_px(*scene) : 0;
  const Window window = intersection(expanded(frame.window, reach), widest);
  if (window != frame.window) {
    without = scene->without();  // what the wider window adds has no vectors
    work.change_window(window);
    scene.emplace(motion_, sources_of(frame), shutter);
  }
  blur(work, *scene, layers);
  report_motion(work, without.value_or(scene->without()));
  for (Layer* layer : layers) {
    layer->changed = true;
    if (work.options.grow_data_window)
      layer->data_window = intersection(expanded(layer->data_window, reach), widest);
    else
      warn_of_lost_light(work, *layer);
  }
  while (!cameras_.empty() && cameras_.begin()->first < frame.number - kCamerasBehind) cameras_.erase(cameras_.begin());
}

motionblur::Motion BlurStage::motion_of(const Frame& frame) const {
  return motionblur::motion_of(motion_, sources_of(frame));
}

motionblur::MotionSources BlurStage::sources_of(const Frame& frame) const {
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
  return sources;
}

std::optional<Camera> BlurStage::camera_of(int frame) const {
  const auto found = cameras_.find(frame);
  return found != cameras_.end() ? found->second : std::nullopt;
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
