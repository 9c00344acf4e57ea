#pragma once
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "core/image/frame.h"

namespace aftershade::tests {

/// A sequence made by a function, and what a run loaded of it.
class MemorySource final : public FrameSource {
 public:
  MemorySource(std::set<int> frames, std::function<Frame(int)> make)
      : frames_(std::move(frames)), make_(std::move(make)) {}
  std::optional<Frame> load(int number, const std::string& view, RoleSet roles, bool with_layers) override {
    if (!frames_.contains(number)) return std::nullopt;
    loads.push_back({number, with_layers});
    Frame frame = make_(number);
    frame.view = view;
    for (const RoleInfo& role : kRoles)
      if (!roles.contains(role.role)) frame.planes(role.role).clear();
    if (!with_layers) frame.layers.clear();
    return frame;
  }
  std::vector<int> numbers() const { return {frames_.begin(), frames_.end()}; }
  struct Load {
    int number;
    bool with_layers;
    bool operator==(const Load&) const = default;
  };
  std::vector<Load> loads;

 private:
  std::set<int> frames_;
  std::function<Frame(int)> make_;
};

/// Keeps what is written: the beauty inside its data window, and the added channels, by frame and channel.
class MemorySink final : public FrameSink {
 public:
  void write(int number, const std::vector<Frame>& views) override {
    for (const Frame& view : views) {
      for (const auto& [name, plane] : view.added) planes[number][name] = copy_of(plane);
      for (const Layer& layer : view.layers) {
        windows[number] = layer.data_window;
        for (size_t i = 0; i < layer.planes.size(); ++i) {
          Plane written(layer.data_window.width(), layer.data_window.height());
          copy_at(layer.planes[i], written, view.window.min_x - layer.data_window.min_x,
                  view.window.min_y - layer.data_window.min_y);
          planes[number][layer.channels[i]] = std::move(written);
        }
      }
    }
  }
  std::map<int, std::map<std::string, Plane>> planes;
  std::map<int, Window> windows;
};

inline bool same_pixels(ConstPlaneView a, ConstPlaneView b) {
  if (a.width != b.width || a.height != b.height) return false;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      if (a(x, y) != b(x, y) && !(std::isnan(a(x, y)) && std::isnan(b(x, y)))) return false;
  return true;
}

/// Thin vertical blades (2 pixels of every 7) 0.5 m in front of a wall at 3 m, passed by a camera that trucks right by
/// 3 pixels a frame at the wall's depth; a beauty of 0.5 with alpha 1. 48x36 display window.
inline Frame blade_frame(int number) {
  Frame frame;
  frame.number = number;
  frame.window = frame.display = {0, 0, 47, 35};
  Camera camera = camera_from_fov(60, 1, 0, 0, 48, 36);
  const double step_m = 3 * 3 / camera.fx;
  Mat4 world_to_camera;
  world_to_camera[3][0] = -number * step_m;
  camera.world_to_camera = world_to_camera;
  frame.camera = camera;
  Plane depth(48, 36), zero(48, 36), mv(48, 36);
  for (int y = 0; y < 36; ++y)
    for (int x = 0; x < 48; ++x) {
      const double world_x = (x + 0.5 - camera.cx) / camera.fx * 2.5 + number * step_m;
      const bool blade = std::fmod(world_x / (7 * 2.5 / camera.fx) + 1000, 1.0) < 2.0 / 7;
      depth(x, y) = blade ? 2.5F : 3.0F;
      mv(x, y) =
          static_cast<float>(step_m * camera.fx / (blade ? 2.5 : 3.0));  // the scene moves left, so it was to the right
    }
  Layer beauty;
  beauty.channels = {"R", "G", "B", "A"};
  for (int c = 0; c < 4; ++c) beauty.planes.emplace_back(48, 36, c < 3 ? 0.5F : 1.0F);
  beauty.alpha = 3;
  beauty.data_window = frame.window;
  beauty.is_beauty = beauty.receives_ao = beauty.receives_blur = true;
  frame.layers.push_back(std::move(beauty));
  frame.planes(Role::velocity_prev).push_back(copy_of(mv));
  frame.planes(Role::velocity_prev).push_back(copy_of(zero));
  for (int y = 0; y < 36; ++y)
    for (int x = 0; x < 48; ++x) mv(x, y) = -mv(x, y);
  frame.planes(Role::velocity_next).push_back(std::move(mv));
  frame.planes(Role::velocity_next).push_back(std::move(zero));
  frame.planes(Role::depth).push_back(std::move(depth));
  return frame;
}

}  // namespace aftershade::tests
