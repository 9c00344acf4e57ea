#pragma once
#include <string>

#include "core/image/plane.h"
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

/// Parameters that all motion blurs have.
struct MotionParams {
  float shutter_frames = 0.5F;       ///< exposure as a share of the frame interval
  bool shutter_from_header = false;  ///< use the header's shutterAngle / 360 where there is one
  bool operator==(const MotionParams&) const = default;
};

/// Parameters of those that follow a surface along its path.
struct PathParams : MotionParams {
  ShutterPhase shutter_phase = ShutterPhase::centred;
  float shutter_opens_frames = -0.25F;  ///< with ShutterPhase::custom: the time from the frame
  Path path = Path::curved;
  bool operator==(const PathParams&) const = default;
};

Shutter shutter_of(const PathParams& params, float shutter_frames);

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
           "Use the header's shutterAngle / 360 instead of shutter_frames, where the file has one.");
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
