#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/metrics/image_metrics.h"

/// Scores of image sequences along the known motion (algorithms 12.2): flicker, noise on trajectories, and what a
/// filter does to sharpness, tiles and borders. Trails are in trail_metrics.h. Planes of one size, computed in double
/// in a fixed order. Masks count above 0.5; an empty mask counts everywhere. Values that are not finite
/// never count. With nothing to count, or planes of different sizes, a score is NaN and a plane is NaN everywhere.
namespace aftershade::metrics {

/// Where each pixel's surface was one frame before: index coordinates of the planes, centre of pixel (i, j) at
/// (i + 0.5, j + 0.5), so whoever has absolute coordinates subtracts the window's corner. `valid` is above 0.5 where
/// the same surface was visible there (see same_surface); empty: wherever the position is known (finite).
struct Motion {
  ConstPlaneView x, y, valid;
};

/// 1 where every pixel that warping reads has, in the frame before, a depth within `epsilon` (relative) of what is
/// expected; both in one unit. Background (not finite, or <= 0) has no history: 0.
Plane same_surface(const Motion& motion, ConstPlaneView expected_depth, ConstPlaneView depth_before, double epsilon);

/// W A: the frame before at the place where each pixel was, bilinear; NaN where that is not valid or a pixel that
/// counts lies outside or is not finite.
Plane warped(ConstPlaneView before, const Motion& motion);

/// A_t - W A_{t-1}.
Plane change_along(ConstPlaneView now, ConstPlaneView before, const Motion& motion);

/// E_warp = sqrt(mean_M (A_t - W A_{t-1})^2).
double warping_error(ConstPlaneView now, ConstPlaneView before, const Motion& motion, ConstPlaneView mask = {});
ErrorSums warping_error_sums(ConstPlaneView now, ConstPlaneView before, const Motion& motion, ConstPlaneView mask = {});

/// Flicker above the truth's own change: |(A_t - W A_{t-1}) - D_t| at every pixel, NaN where there is no history.
/// Change that the truth shows too does not count. `true_change` is D_t = R_t(p) - R_{t-1}(p) of the surface point p
/// that each pixel shows, both exact at that point (0 where nothing moves but the camera). Warping an image of the
/// truth would put its resampling error there instead, so that an image which never changes flickered.
Plane flicker_above_truth(ConstPlaneView now, ConstPlaneView before, ConstPlaneView true_change, const Motion& motion);

struct Distribution {
  double mean, p95, p99;  ///< percentiles by nearest rank: the smallest value that so many per cent do not exceed
  int64_t count;
};
/// Of all values of several planes, e.g. one of each frame; `masks` is empty or has one mask for each.
Distribution distribution(std::span<const ConstPlaneView> values, std::span<const ConstPlaneView> masks = {});

/// Along the trajectories that end at the pixels of the last frame. A pixel counts from `least_frames` frames on; NaN
/// elsewhere.
struct TrajectoryNoise {
  Plane deviation;  ///< standard deviation (of the population) of the values on the trajectory
  Plane high_pass;  ///< sqrt(mean (a_k - 2 a_{k-1} + a_{k-2})^2): ramps do not count
};
/// `motions[k]` leads from frame k to frame k-1; motions[0] is not read. To leave the truth's own change out, pass
/// errors. Positions between pixels follow the nearest pixel's motion; values are bilinear.
TrajectoryNoise trajectory_noise(std::span<const ConstPlaneView> frames, std::span<const Motion> motions,
                                 int least_frames = 8);

/// sqrt(sum_M |grad A|^2 / sum_M |grad R|^2), central differences inside the image: below 1 is blurred, above is noisy.
double gradient_ratio(ConstPlaneView image, ConstPlaneView truth, ConstPlaneView mask = {});

/// Mean |step of the error A - R| between neighbours on either side of a tile's border, over that between neighbours
/// inside tiles: 1 when seams cannot be told. `first_x`, `first_y`: index at which a tile starts.
struct SeamSums {
  MeanSum inside, across;
  SeamSums& operator+=(const SeamSums& other);
  double ratio() const;  ///< NaN where nothing differs inside tiles
};
SeamSums tile_seam_sums(ConstPlaneView image, ConstPlaneView truth, int tile_px, int first_x = 0, int first_y = 0,
                        ConstPlaneView mask = {});
double tile_seam_ratio(ConstPlaneView image, ConstPlaneView truth, int tile_px, int first_x = 0, int first_y = 0);

/// 1 within `border_px` of the image's border: a mask for the scores near the border.
Plane border_mask(int width, int height, int border_px);

}  // namespace aftershade::metrics
