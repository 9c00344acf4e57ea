#pragma once
#include <optional>

#include "core/camera/camera.h"
#include "core/image/plane.h"
#include "core/metrics/temporal_metrics.h"

/// What temporal scores know of a frame from its motion and depth alone, before they look at any result. Planes of one
/// size; index (0, 0) is at absolute pixel (origin_x, origin_y), to which cameras refer.
namespace aftershade::metrics {

struct PastInput {
  ConstPlaneView depth, depth_before;        ///< metres, +inf background
  ConstPlaneView velocity_x, velocity_y;     ///< velocity_prev in pixels, NaN unknown; may be empty with cameras
  std::optional<CameraReprojection> camera;  ///< now -> before; without it nothing is known to move
  int origin_x = 0, origin_y = 0;
};

/// Where each pixel's surface was one frame before, in index coordinates.
struct Past {
  Plane x, y;
  Plane valid;  ///< 1 where the same surface was visible there
  /// 1: a surface that moves by itself: its vector is not the camera's by more than 0.5 px; 0: it stands still, or no
  /// camera or vector tells.
  Plane moving;
  /// The nearest pixel of the four around that place that shows the surface (its index); -1: none does.
  Plane pixel_x, pixel_y;
  Motion motion() const { return {x, y, valid}; }
};
/// Along the camera's motion where the vector agrees with it within 0.5 px or is not known (static surfaces: the
/// expected depth is exact), along the vector elsewhere. `valid` is same_surface() within 5 %.
Past past_of(const PastInput& input);

/// 1 where depth is a line of neither three pixels in a row around or beside the pixel, along x or along y: surfaces of
/// a pixel or two, such as grass and railings, which are those that flicker and that Battlefield 3 filters over time
/// (seed 000, "temporal filtering: unstable pixels"), and all within `reach_px` of them. Lines are those of 1 / depth,
/// which is linear on any plane in perspective, within 1 %. Background: 0.
Plane unstable_pixels(ConstPlaneView depth, int reach_px = 4);

/// 1 where the mask is above 0.5 within `reach_px` along both axes.
Plane grown(ConstPlaneView mask, int reach_px);

/// Where moving surfaces may change what is around them: 1 within `reach_px` of pixels that move, if 4 of the 9 around
/// them do (a pixel that shows two surfaces at once has a vector of neither).
Plane moving_footprint(const Past& past, int reach_px);

/// 1 where a surface comes into sight that something hid in the frame before: its place there is known and lies in the
/// picture, but none of the pixels around shows it.
Plane disoccluded(const Past& past);
/// Frames since the surface of each pixel was last where `event` is above 0.5: 0 now, else one more than it had in
/// the frame before; NaN where it was not visible then. `since_before` is the frame before's; empty: nothing has
/// happened yet, +inf.
Plane frames_since(ConstPlaneView event, ConstPlaneView since_before, const Past& past);

}  // namespace aftershade::metrics
