#pragma once
#include <vector>

#include "core/motionblur/surface_points.h"

namespace aftershade::motionblur {

/// Does one of the eight pixels around show something nearer, which the pixel's filter has mixed into its colour?
bool is_beside_nearer(const SequenceFrame& frame, int x, int y);

/// Sum of a pixel's channels but for alpha; negative ones count as 0.
float light_of(const SequenceFrame& frame, int x, int y);

/// How the light on a frame's surfaces is different at another time, known at some pixels and estimated at others.
class LightChange {
 public:
  /// `grid` holds a point for every pixel of `frame`, row by row, and outlives this object.
  LightChange(const SequenceFrame& frame, const std::vector<SurfacePoint>& grid);

  /// The light on pixel `i` at the other time, as light_of gives it. Does nothing where the pixel's own colour is mixed
  /// or cannot be used.
  void set(size_t i, float other_light);

  /// The factor that takes pixel `i` to the other time: that of the nearest known pixels of like depth and motion, by
  /// the inverse square of the distance; 1 where there are none within 32 px. It makes nothing brighter than the
  /// brightest of them at the other time, or darker than the darkest.
  float at(size_t i) const;

 private:
  const SequenceFrame& frame_;
  const std::vector<SurfacePoint>& grid_;
  std::vector<float> own_, other_;  ///< light; own 0: not known
};

/// The same surface's channels in a neighbour, at the pixels of `frame`: bilinear over pixels of like depth whose
/// vector leads back; the frame's own where there are none. `step` is -1 or 1, the neighbour's place.
std::vector<Plane> channels_in(const SequenceFrame& frame, const SequenceFrame& neighbour, int step);

}  // namespace aftershade::motionblur
