#include "core/pipeline/work.h"

#include <limits>

namespace aftershade::pipeline {

namespace {
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

float background_of(Role role) {
  if (is_depth(role)) return std::numeric_limits<float>::infinity();
  if (role == Role::velocity_prev || role == Role::velocity_next) return kUnknown;
  return 0;
}

void relay(Plane& plane, Window from, Window to, float background) {
  Plane moved(to.width(), to.height(), background);
  copy_at(plane, moved, from.min_x - to.min_x, from.min_y - to.min_y);
  plane = std::move(moved);
}
}  // namespace

void Work::choose_normals(ao::NormalSource source) {
  if (source != normals_) surface_.reset();
  normals_ = source;
}

const filter::Surface& Work::surface() {
  if (surface_) return *surface_;
  const Projection projection = local_projection(frame.camera.value(), frame.window.min_x, frame.window.min_y);
  const bool from_file = normals_ != ao::NormalSource::depth && frame.has(Role::normal);
  if (!from_file) derived_normals_ = filter::normals_from_depth(frame.depth(), projection);
  const auto normal = [&](size_t i) {
    return from_file ? ConstPlaneView(frame.planes(Role::normal)[i]) : ConstPlaneView((*derived_normals_)[i]);
  };
  surface_ = filter::Surface{frame.depth(), normal(0),          normal(1),          normal(2),
                             projection,    frame.window.min_x, frame.window.min_y, frame.display.height()};
  return *surface_;
}

const filter::DepthPyramid& Work::pyramid() {
  if (!pyramid_) pyramid_.emplace(frame.depth(), filter::kDepthLevels, frame.window.min_x, frame.window.min_y);
  return *pyramid_;
}

void Work::change_window(Window window) {
  const Window before = frame.window;
  if (before == window) return;
  for (const RoleInfo& role : kRoles)
    for (Plane& plane : frame.planes(role.role)) relay(plane, before, window, background_of(role.role));
  for (Layer& layer : frame.layers)
    for (Plane& plane : layer.planes) relay(plane, before, window, 0);
  for (auto& [name, plane] : frame.added) relay(plane, before, window, frame.named.contains(name) ? kUnknown : 0);
  for (auto& [name, plane] : frame.named) relay(plane, before, window, kUnknown);
  if (ao_at_pixels) relay(ao, before, window, 1);
  frame.window = window;
  grid.reset();
  surface_.reset();
  derived_normals_.reset();
  pyramid_.reset();
}

}  // namespace aftershade::pipeline
