#pragma once
#include <vector>

#include "core/temporal/temporal_window.h"
#include "tests/temporal/temporal_helpers.h"

namespace aftershade::tests {

using temporal::Side;
using temporal::TemporalWindowParams;
using temporal::WindowedAo;
using temporal::WindowFrame;

/// A camera at `eye` that looks along +Z with the principal point at the middle of 64x48 pixels.
inline Camera camera_at(Vec3 eye, double focal_px = 60, bool orthographic = false) {
  Camera camera;
  camera.fx = camera.fy = focal_px;
  camera.cx = 32;
  camera.cy = 24;
  camera.orthographic = orthographic;
  camera.world_to_camera = Mat4().setTranslation(-eye);
  return camera;
}

inline WindowFrame window_frame(int number, Window window, const Camera& camera) {
  WindowFrame frame;
  frame.number = number;
  frame.window = window;
  frame.camera = camera;
  frame.ao = Plane(window.width(), window.height(), 1.0F);
  frame.depth = Plane(window.width(), window.height(), 5.0F);
  return frame;
}

/// Both vectors zero: the file says that nothing moves.
inline void add_still_vectors(WindowFrame& frame) {
  const int width = frame.window.width(), height = frame.window.height();
  frame.mv_prev = {Plane(width, height), Plane(width, height)};
  frame.mv_next = {Plane(width, height), Plane(width, height)};
}

/// Layers of depth, background, objects that move and cameras that do: nothing is the same from frame to frame.
inline std::vector<WindowFrame> busy_frames(int count, double unit = 1) {
  std::vector<WindowFrame> frames;
  for (int f = 0; f < count; ++f) {
    const Window window = window_of(64 - f, 48, f, -f);
    WindowFrame frame = window_frame(f, window, camera_at(Vec3(0.04 * f, 0.01 * f, 0.05 * f) * unit));
    const auto plane = [&](const std::function<float(int x, int y)>& value) {
      return plane_of(window.width(), window.height(),
                      [&](int i, int j) { return value(i + window.min_x, j + window.min_y); });
    };
    const auto box = [&](int x, int y) { return x >= 10 + 2 * f && x < 24 + 2 * f && y >= 12 && y < 26; };
    frame.ao = plane([&](int x, int y) { return noise(x, y, f, 1); });
    frame.depth = plane([&](int x, int y) {
      if (noise(x, y, f, 2) < 0.03F) return kInf;
      return static_cast<float>((box(x, y) ? 4.0 : 5.0 + 0.02 * x) * unit);
    });
    frame.nx = plane([&](int, int) { return 0.1F; });
    frame.ny = plane([&](int x, int y) { return noise(x, y, f, 3) < 0.1F ? 0.9F : 0.0F; });
    frame.nz = plane([&](int, int) { return -0.99F; });
    const auto vector = [&](float moving, int index) {
      return plane([&, moving, index](int x, int y) {
        if (noise(x, y, f, index) < 0.02F) return kNaN;
        return box(x, y) ? moving : moving / -8;
      });
    };
    frame.mv_prev = {vector(-2, 4), vector(0, 5)};
    frame.mv_next = {vector(2, 6), vector(0, 7)};
    frames.push_back(std::move(frame));
  }
  return frames;
}

inline std::vector<const WindowFrame*> pointers(const std::vector<WindowFrame>& frames) {
  std::vector<const WindowFrame*> out;
  for (const WindowFrame& frame : frames) out.push_back(&frame);
  return out;
}

inline WindowedAo windowed(const TemporalWindowParams& params, const std::vector<WindowFrame>& frames, size_t centre) {
  return temporal::temporal_window(params, pointers(frames), centre);
}

/// w_d of the documentation.
inline double window_weight(int d, int frames) { return 1 - std::pow(static_cast<double>(d) / (frames + 1), 2); }

}  // namespace aftershade::tests
