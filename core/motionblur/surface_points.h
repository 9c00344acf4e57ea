#pragma once
#include <optional>
#include <vector>

#include "core/camera/camera.h"
#include "core/image/plane.h"
#include "core/image/window.h"
#include "core/motionblur/motion.h"

namespace aftershade::motionblur {

/// A frame as forward reconstruction reads it: the one that is blurred, or one of its neighbours. Planes cover
/// `window`.
struct SequenceFrame {
  int number = 0;
  Window window;
  std::optional<Camera> camera;
  ConstPlaneView depth;  ///< metres; +inf, NaN, <= 0: background. Empty (data == nullptr): everything at one depth
  const Motion* motion = nullptr;
  std::vector<ConstPlaneView> channels;  ///< blurred together
  int alpha = -1;                        ///< index of the alpha channel, or -1
};

/// A piece of surface that one pixel of a frame shows, on its way through the exposure of frame f. Coordinates are
/// pixels of f's window, pixel centres at integers; it covers the box x - left .. x + right, y - top .. y + bottom.
struct SurfacePoint {
  /// Distance from the centre to an edge: half a pixel, or half of the way to the neighbour on the same surface, so
  /// that a surface that grows or turns has no cracks. At time t it is `at_frame` + t * `per_frame`.
  struct Edge {
    float at_frame, per_frame;
  };
  float x, y;                            ///< in f
  float prev_x, prev_y, next_x, next_y;  ///< in f-1 and f+1, minus in f
  float depth;                           ///< metres; 1e30 for background
  Edge left, right, top, bottom;
  float light = 1;  ///< factor that turns the neighbour's light on the surface into that of f; not for alpha
  float trust = 1;  ///< weight of its colour beside others of the same surface
  int frame;        ///< f: 0; else the neighbour's index, counted from 1
  int pixel;        ///< y * width + x in its own frame
};

/// What pixels of frame f show: all that can be used (finite channels).
void add_points(const SequenceFrame& frame, Shutter shutter, std::vector<SurfacePoint>& points);

/// What a neighbour shows and f does not: pieces of surface that lie behind f's surfaces or outside its window. Those
/// that move as the camera says are placed by the cameras of `sequence` (index 0 is f), exactly; others by their own
/// vectors, of f-1 and f+1 alone. A neighbour of which f finds less than 40 % again is of another shot, and shows
/// nothing. Their light is changed as it has changed, from there to f, on the nearest part of the same surface that
/// both show: what is uncovered beside a moving object lies in that object's shadow in f. `index` (> 0) is the
/// neighbour's place in `sequence`.
void add_hidden_points(const std::vector<SequenceFrame>& sequence, size_t index, Shutter shutter,
                       std::vector<SurfacePoint>& points);

/// Depth as comparisons want it.
inline float finite_depth(ConstPlaneView depth, int x, int y) {
  constexpr float kBackground = 1e30F;
  if (depth.data == nullptr) return kBackground;
  const float z = depth(x, y);
  return z > 0 && z < kBackground ? z : kBackground;
}

/// Depths that differ by a smaller share may be of one surface.
inline constexpr float kOneSurface = 0.05F;
/// A surface nearer by this share hides what is behind it.
inline constexpr float kHides = 0.03F;

/// All channels of the pixel are finite and below 1e30.
bool is_usable(const SequenceFrame& frame, int x, int y);

/// What the pixel shows, in its own frame's coordinates, without edges.
SurfacePoint point_of(const SequenceFrame& frame, int x, int y);

/// Pixels per frame, of the mean of both vectors.
struct Rate {
  float x, y;
};
inline Rate rate_of(const SurfacePoint& p) { return {0.5F * (p.next_x - p.prev_x), 0.5F * (p.next_y - p.prev_y)}; }

}  // namespace aftershade::motionblur
