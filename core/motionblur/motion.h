#pragma once
#include <optional>
#include <string>

#include "core/camera/camera.h"
#include "core/image/plane.h"
#include "core/image/window.h"
#include "core/params/table.h"

/// What every motion blur knows about motion: the shutter, and where each pixel's surface is at a time.
namespace aftershade::motionblur {

/// Displacements of each pixel's surface, in pixels of the full frame interval, y down, all finite: where it was in
/// frame f-1 and will be in frame f+1, minus where it is.
struct Motion {
  Plane prev_x, prev_y, next_x, next_y;
};

/// When the shutter is open, in frame intervals from the frame: -0.25 to 0.25 is half a frame, centred.
struct Shutter {
  float opens, closes;
  float length() const { return closes - opens; }
};

enum class ShutterPhase { centred, start, end, custom };

/// How a surface moves between the three positions that are known of it.
enum class Path {
  straight,  ///< evenly along the mean of both displacements
  separate,  ///< evenly to where it was, and evenly to where it will be
  curved,    ///< on the parabola through the three
};

/// What becomes of pixels without a vector, in files that have vectors.
enum class UnknownVectors { still, camera };

/// Parameters that all motion blurs have. Lengths are pixels of the image as it is.
struct MotionParams {
  float shutter_frames = 0.5F;       ///< exposure as a share of the frame interval
  bool shutter_from_header = false;  ///< use the header's shutterAngle / 360 where there is one
  UnknownVectors unknown_vectors = UnknownVectors::still;
  float camera_motion = 1, object_motion = 1;            ///< shares of the motion; 1 is physical
  float min_speed_px = 0;                                ///< per frame: slower surfaces stay sharp
  float max_speed_px = 0;                                ///< per frame: faster ones are shortened to it; 0: no limit
  std::string added_velocity_x, added_velocity_y;        ///< channels, pixels per frame, y down; "": none
  std::string added_mask;                                ///< channel: share of the added motion at each pixel; "": all
  float added_x_px = 0, added_y_px = 0, added_zoom = 0;  ///< per frame; zoom: growth about the picture's centre
  bool splits_motion() const { return camera_motion != 1 || object_motion != 1; }
  bool operator==(const MotionParams&) const = default;
};

/// What is known of a frame's motion. Planes may be empty (data == nullptr) but for one; they cover `window`.
struct MotionSources {
  ConstPlaneView prev_x, prev_y, next_x, next_y;    ///< NaN, inf and components of 1e15 and more: unknown
  ConstPlaneView depth;                             ///< metres; +inf, NaN, <= 0: background. Without: no camera
  std::optional<CameraReprojection> before, after;  ///< from the frame's camera to that of f-1, of f+1
  ConstPlaneView added_x, added_y, added_mask;      ///< what is not finite counts as 0
  Window window, display;
};

/// What became of pixels without a vector: is there one that follows the camera, one that stands still?
struct WithoutVector {
  bool by_camera = false, still = false;
};

/// The motion of every pixel's surface: where one vector is known, the other is its negative; where none is, the
/// camera's (depth and a camera beside the frame's own; the background follows its rotation), else it stands still. A
/// vector of 0 in the background counts as none where the camera is known: renderers write it for want of another.
/// Then, in this order: the shares of camera and object (of a pixel whose camera motion is unknown, all is the
/// object's), the added motion, the limits, by the longer of both vectors.
Motion motion_of(const MotionParams& params, const MotionSources& sources, WithoutVector* without = nullptr);

/// Parameters of those that follow a surface along its path.
struct PathParams : MotionParams {
  ShutterPhase shutter_phase = ShutterPhase::centred;
  float shutter_opens_frames = -0.25F;  ///< with ShutterPhase::custom: the time from the frame
  Path path = Path::curved;
  bool operator==(const PathParams&) const = default;
};

Shutter shutter_of(const PathParams& params, float shutter_frames);

/// How far, in pixels, any surface gets from its place while the shutter is open; with Path::curved an upper bound.
float longest_displacement_px(const Motion& motion, Shutter shutter, Path path);

/// One coordinate of the displacement at time t for a surface with displacements `prev` and `next`:
///   straight: t (n - p) / 2;  separate: -t p before the frame, t n after;  curved: t (n - p) / 2 + t^2 (n + p) / 2
/// `F` is float, double or a lane type.
template <class F>
F displacement(Path path, F prev, F next, float t) {
  if (path == Path::separate) return t < 0 ? prev * F(-t) : next * F(t);
  const F mean = (next - prev) * F(0.5F * t);
  return path == Path::straight ? mean : mean + (next + prev) * F(0.5F * t * t);
}

/// Adds the parameters to a method's table.
template <class P>
params::TableBuilder<P>& add_motion(params::TableBuilder<P>& builder) {
  return builder
      .add("shutter_frames", &P::shutter_frames, {0, 8},
           "Exposure as a share of the frame interval: 0.5 is a 180 degree shutter.")
      .add("shutter_from_header", &P::shutter_from_header,
           "Use the header's shutterAngle / 360 instead of shutter_frames, where the file has one.")
      .add("unknown_vectors", &P::unknown_vectors, {"still", "camera"},
           "Pixels without a vector stay sharp, or move as the camera says (needs its position and depth).")
      .add("camera_motion", &P::camera_motion, {0, 10},
           "Share of the camera's motion that blurs: 1 is physical, 0 blurs moving objects only (needs the camera's "
           "position and depth).")
      .add("object_motion", &P::object_motion, {0, 10},
           "Share of the objects' own motion that blurs: 1 is physical, 0 blurs the camera's motion only (needs the "
           "camera's position and depth).")
      .add("min_speed_px", &P::min_speed_px, {0, 10000},
           "Surfaces that move less in a frame stay sharp; pixels of the image as it is.")
      .add("max_speed_px", &P::max_speed_px, {0, 100000},
           "Surfaces that move farther in a frame are blurred as if they moved so far; 0 sets no limit.")
      .add("added_velocity_x", &P::added_velocity_x,
           "Channel with motion to add, pixels per frame to the right; empty adds none.")
      .add("added_velocity_y", &P::added_velocity_y,
           "Channel with motion to add, pixels per frame downwards; empty adds none.")
      .add("added_mask", &P::added_mask,
           "Channel with the share of all added motion at each pixel, 0 to 1; empty adds it everywhere.")
      .add("added_x_px", &P::added_x_px, {-10000, 10000}, "Motion to add, pixels per frame to the right.")
      .add("added_y_px", &P::added_y_px, {-10000, 10000}, "Motion to add, pixels per frame downwards.")
      .add("added_zoom", &P::added_zoom, {-10, 10},
           "Motion to add away from the picture's centre, as a share of the distance from it per frame.");
}
template <class P>
params::TableBuilder<P>& add_path(params::TableBuilder<P>& builder) {
  return add_motion(builder)
      .add("shutter_phase", &P::shutter_phase, {"centred", "start", "end", "custom"},
           "When the shutter is open: around the frame, from the frame on, until the frame, or from "
           "shutter_opens_frames on.")
      .add("shutter_opens_frames", &P::shutter_opens_frames, {-8, 8},
           "With shutter_phase custom: when the shutter opens, in frames from the frame.")
      .add("path", &P::path, {"straight", "separate", "curved"},
           "How surfaces move: evenly along the mean of both vectors, along the backward and then the forward "
           "vector, or on the parabola through the three positions.");
}

}  // namespace aftershade::motionblur
