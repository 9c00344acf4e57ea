#pragma once
#include "core/image/plane.h"
#include "core/motionblur/motion.h"

namespace aftershade::motionblur {

struct HalfVelocity {
  Plane x, y;  ///< pixels of half the exposure; |v| <= K; 0 where unknown
};

/// Half of shutter * displacement per frame, shortened to `max_radius` pixels where it is longer (slide "Render
/// Velocity"; algorithms 2.1, 14 no. 24). The displacement is the mean of next and -prev where both are known, else the
/// known one, else 0; a vector with a NaN, an infinity or a component of 1e15 and more is unknown. Either pair may be
/// empty (data == nullptr). The paper's least length of half a pixel is not stored: a gather raises |v| to it where it
/// needs a radius.
HalfVelocity half_velocity(ConstPlaneView prev_x, ConstPlaneView prev_y, ConstPlaneView next_x, ConstPlaneView next_y,
                           float shutter_frames, float max_radius);

/// The same of motion in which all vectors are known.
HalfVelocity half_velocity(const Motion& motion, float shutter_frames, float max_radius);
/// The same of what motion_of() gives, without keeping that.
HalfVelocity half_velocity(const MotionParams& params, const MotionSources& sources, float shutter_frames,
                           float max_radius, WithoutVector* without = nullptr);

/// As two channels of 8 bits give it back that hold -max_radius to max_radius as 0 to 1 (slide "Render Velocity").
HalfVelocity at_8_bits(const HalfVelocity& velocity, float max_radius);

/// Length of the longest vector, pixels.
float longest_px(const HalfVelocity& velocity);

}  // namespace aftershade::motionblur
