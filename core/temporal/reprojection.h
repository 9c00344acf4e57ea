#pragma once
#include <optional>

#include "core/camera/camera.h"
#include "core/filter/static_motion.h"
#include "core/image/plane.h"
#include "core/image/window.h"

namespace aftershade::temporal {

/// Where each pixel's surface was one frame before. x, y: absolute pixel coordinates (centre of pixel (i,j) is
/// (i+0.5, j+0.5)); depth: the planar depth in metres it is expected to have had there. NaN: unknown.
struct Reprojected {
  Plane x, y, depth;
};

enum class ReprojectionSource { automatic, camera };

struct ReprojectionInput {
  ConstPlaneView depth;                      ///< of the frame, metres
  Window window;                             ///< of the planes
  std::optional<CameraReprojection> camera;  ///< now -> before; without it only the vectors are known
  ConstPlaneView mv_prev_x, mv_prev_y;       ///< pixels, may be empty (data == nullptr) or NaN: unknown
  /// Scattered vectors have holes where nothing of the frame before came: what is seen there was hidden, so it has no
  /// past. Otherwise an unknown vector leaves the word to the camera.
  bool holes_are_invalid = false;
};

/// What the past of one row is made of; its formulas are in reprojection_kernel.h.
struct ReprojectionRow {
  const float* depth;
  const float *mv_x, *mv_y;                    ///< null: no vectors
  std::optional<filter::StaticMotion> camera;  ///< none: unknown
  bool holes_are_invalid;
  float agreement_px;
  int width, min_x;
  float centre_y;  ///< of the row, absolute
};

/// The past of a frame, one row at a time, for filters that need no planes of it.
class Reprojection {
 public:
  Reprojection(const ReprojectionInput& input, ReprojectionSource source, float agreement_px);
  ReprojectionRow row(int y) const;
  /// Row y of what reproject() gives, into rows with Plane's padding. Pixels where `not_needed` is 1 may be left as
  /// they are; it may be null.
  void row(int y, const float* not_needed, float* x, float* y_before, float* depth) const;

 private:
  ReprojectionInput input_;
  bool vectors_;
  float agreement_px_;
};

/// Camera where its motion agrees with the pixel's vector within `agreement_px` (static surfaces: exact depth), the
/// vector elsewhere (with the camera's expected depth, or the pixel's own depth without a camera). Background: NaN.
/// `source` camera ignores the vectors: seed 000 literally.
Reprojected reproject(const ReprojectionInput& input, ReprojectionSource source, float agreement_px);

/// The vectors mv_prev of frame f from the mv_next of frame f-1: every pixel of f-1 is carried to where it goes, the
/// nearest in depth wins a pixel (ties: the lower row, then column), holes are NaN. Never the negated vector of f
/// itself.
struct VelocityPlanes {
  Plane x, y;
};
VelocityPlanes scatter_velocity(ConstPlaneView mv_next_x, ConstPlaneView mv_next_y, ConstPlaneView depth_before,
                                Window window_before, Window window_now);

/// Share of the surface pixels, 0 to 1, whose past is not in the depth stored for frame i-1 (metres, 0 or +inf:
/// background): unknown, outside its window, or at a depth that differs by 10 % and more (at the nearest pixel,
/// whatever a filter's own epsilon is: on a slope it is never exact). Most of a picture without a past is a cut
/// (algorithms 13). 0 when there is nothing to compare.
double share_without_history(ConstPlaneView depth, const Reprojected& reprojected, ConstPlaneView stored_depth,
                             Window stored_window);
/// The same on one row of eight (by absolute coordinate; on all rows of a low window), which is share enough.
double share_without_history(ConstPlaneView depth, Window window, const Reprojection& reprojection,
                             ConstPlaneView stored_depth, Window stored_window);

}  // namespace aftershade::temporal
