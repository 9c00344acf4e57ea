#include "core/pipeline/work.h"

#include <chrono>
#include <limits>

#include "core/image/placed.h"
#include "core/image/plane_memory.h"

namespace aftershade::pipeline {

namespace {
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

float background_of(Role role) {
  if (is_depth(role)) return std::numeric_limits<float>::infinity();
  if (role == Role::velocity_prev || role == Role::velocity_next) return kUnknown;
  return 0;
}

void relay(Plane& plane, Window from, Window to, float background) { plane = placed(plane, from, to, background); }
}  // namespace

void Work::choose_normals(ao::NormalSource source) {
  if (source != normals_) surface_.reset();
  normals_ = source;
}

Geometry& Work::geometry() {
  if (!geometry_) geometry_ = std::dynamic_pointer_cast<Geometry>(frame.geometry);
  if (!geometry_) geometry_ = std::make_shared<Geometry>();
  return *geometry_;
}

template <class T, class Make>
const T& Work::once(MadeOnce<T>& made, Make&& make) {
  const bool first_use = used_.insert(&made).second;
  if (!made.value) {
    const auto account = std::make_shared<MemoryAccount>();
    const OnAccount on_account(account);
    const auto start = std::chrono::steady_clock::now();
    made.value.emplace(make());
    made.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    made.bytes = account->used;
  } else if (first_use) {
    shared_.milliseconds += made.milliseconds;
  }
  if (first_use) shared_.bytes += made.bytes;
  return *made.value;
}

const filter::Surface& Work::surface() {
  if (surface_) return *surface_;
  const Projection projection = local_projection(frame.camera.value(), frame.window.min_x, frame.window.min_y);
  const bool from_file = normals_ != ao::NormalSource::depth && frame.has(Role::normal);
  const auto derived = [&] { return filter::normals_from_depth(frame.depth(), projection); };
  const filter::Normals* made = from_file ? nullptr : &once(geometry().normals, derived);
  const auto normal = [&](size_t i) -> ConstPlaneView {
    return made ? ConstPlaneView((*made)[i]) : ConstPlaneView(frame.planes(Role::normal)[i]);
  };
  surface_ = filter::Surface{frame.depth(), normal(0),          normal(1),          normal(2),
                             projection,    frame.window.min_x, frame.window.min_y, frame.display.height()};
  return *surface_;
}

const filter::DepthPyramid& Work::pyramid() {
  return once(geometry().pyramid, [&] {
    return filter::DepthPyramid(frame.depth(), filter::kDepthLevels, frame.window.min_x, frame.window.min_y);
  });
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
  frame.geometry.reset();
  geometry_.reset();
  used_.clear();
}

}  // namespace aftershade::pipeline
