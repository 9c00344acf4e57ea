#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/plane.h"

/// What moving objects leave behind in a filtered sequence, and how fast a filter follows (algorithms 12.2). The rules
/// of temporal_metrics.h hold.
namespace aftershade::metrics {

/// Footprints: above 0.5 where a moving object darkens its surroundings, one plane a frame, the last is frame t.
/// 1, 2, ... : so many frames ago the pixel was inside for the last time (1: in frame t-1); 0: inside now or never
/// before.
Plane frames_since_left(std::span<const ConstPlaneView> footprints);
/// 1: inside now, but not in frame t-1; 2: for two frames, ...; 0: outside, or inside since the first frame.
Plane frames_since_entered(std::span<const ConstPlaneView> footprints);

/// Errors against the truth of pixels of one age.
struct AgeError {
  double mean = 0;      ///< mean (A - R): below 0 is a dark trail (or light lag where the footprint arrives)
  double absolute = 0;  ///< mean |A - R|
  double visible = 0;   ///< share with |A - R| > 0.03
  int64_t count = 0;
};
/// Element k is of age k + 1, over all frames; `ages` are those of frames_since_left (trail, ghost) or
/// frames_since_entered (leading lag).
std::vector<AgeError> error_by_age(std::span<const ConstPlaneView> images, std::span<const ConstPlaneView> truths,
                                   std::span<const ConstPlaneView> ages, int max_age);
/// Of all ages together: the trail over T_k, the pixels left within k frames.
AgeError total_error(std::span<const AgeError> by_age);
/// Frames until |error| has fallen to half of the first: where the line between the two nearest logarithms crosses;
/// +inf when it never does, NaN when the first is 0 or not finite. `errors[k]` is of age k + 1.
double half_life_frames(std::span<const double> errors);

/// How far each image has come on the way from `start` to `end`: sum_M (A - start)(end - start) / sum_M (end -
/// start)^2.
std::vector<double> step_response(std::span<const ConstPlaneView> images, ConstPlaneView start, ConstPlaneView end,
                                  ConstPlaneView mask = {});
/// The first of the frames, counted from 1, from which on the response is at least `share`; 0 when it never is.
int frames_to_reach(std::span<const double> response, double share = 0.9);

}  // namespace aftershade::metrics
