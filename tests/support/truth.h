#pragma once
#include <string>
#include <vector>

#include "tests/support/render.h"

/// Exact results beside the scenes: what a perfect effect would give.
namespace aftershade::tests {

enum class Weighting { uniform, cosine };      ///< of directions over the hemisphere about the normal
enum class Falloff { hard, squared, linear };  ///< W(r): 1, 1 - r^2/R^2, 1 - r/R; each 0 beyond R

struct AoTruth {
  double radius_m = 1;
  Weighting weighting = Weighting::cosine;
  Falloff falloff = Falloff::hard;
  int rays = 256;  ///< a pixel; the error of a pixel is about 0.5 / sqrt(rays) at most
};

/// 1 - the weighted mean over directions of W(distance of the nearest surface): 1 is open. `position` lies on a surface
/// with unit normal `normal`; `seed` rotates the direction set.
double ambient_occlusion_at(const PlacedScene& placed, const Vec3& position, const Vec3& normal, const AoTruth& truth,
                            uint32_t seed);

/// At the surface points of the pixel centres; 1 on the background.
Plane ambient_occlusion_truth(const Scene& scene, double time, int width, int height, const AoTruth& truth);

/// What changes in one frame at each pixel's surface point: its AO at `time` less the AO that the same point of its
/// object had at time - 1. Both are traced at the point itself, with the same directions about the normal, so that the
/// noise of what stays cancels: exactly 0 where nothing moves but the camera, and on the background.
Plane ambient_occlusion_change(const Scene& scene, double time, int width, int height, const AoTruth& truth);

/// R, G, B, A: the mean of `samples` renders at the midpoints of equal parts of a shutter that is open for
/// shutter_frames, centred on `time`. Each is rendered with settings.colour_samples.
std::vector<Plane> motion_blur_truth(const Scene& scene, double time, double shutter_frames, int samples,
                                     const RenderSettings& settings);

}  // namespace aftershade::tests
