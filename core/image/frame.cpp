#include "core/image/frame.h"

namespace aftershade {

namespace {

std::vector<Plane> shared(const std::vector<Plane>& planes) {
  std::vector<Plane> out;
  for (const Plane& plane : planes) out.push_back(plane.shared());
  return out;
}

std::map<std::string, Plane> shared(const std::map<std::string, Plane>& planes) {
  std::map<std::string, Plane> out;
  for (const auto& [name, plane] : planes) out.emplace(name, plane.shared());
  return out;
}

Layer shared(const Layer& layer) {
  return {layer.name,        layer.channels,    shared(layer.planes), layer.alpha,     layer.part,
          layer.data_window, layer.receives_ao, layer.receives_blur,  layer.is_beauty, layer.changed};
}

}  // namespace

Frame shared(const Frame& frame) {
  Frame out{frame.number,
            frame.view,
            frame.part,
            frame.window,
            frame.display,
            frame.pixel_aspect,
            frame.camera,
            frame.shutter_angle_deg,
            {},
            {},
            shared(frame.named),
            shared(frame.added),
            frame.file,
            frame.geometry};
  for (size_t i = 0; i < frame.roles.size(); ++i) out.roles[i] = shared(frame.roles[i]);
  for (const Layer& layer : frame.layers) out.layers.push_back(shared(layer));
  return out;
}

}  // namespace aftershade
