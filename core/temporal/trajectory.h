#pragma once
#include <span>

#include "core/camera/camera.h"
#include "core/image/plane.h"
#include "core/image/window.h"
#include "core/temporal/reprojection.h"

/// Motion trajectories: where the surface of every pixel of one frame is seen in the frames before and after it
/// (algorithms 7.1 to 7.3 and 7.8).
namespace aftershade::temporal {

/// What a two-sided filter keeps of a frame. All planes cover `window`; index (0, 0) is absolute pixel
/// (window.min_x, window.min_y).
struct WindowFrame {
  int number = 0;
  Window window;
  Camera camera;                    ///< without a position, or with another lens, trajectories still follow vectors
  Plane ao;                         ///< 1 = open; not finite: unknown
  Plane depth;                      ///< metres; +inf, NaN and <= 0 are background
  Plane nx, ny, nz;                 ///< camera space, (0,0,0): none; may be empty
  VelocityPlanes mv_prev, mv_next;  ///< pixels, to where the surface was and will be; NaN: unknown; may be empty
};

/// When a pixel of another frame shows the surface that is looked for.
struct MatchTolerance {
  float distance_m;    ///< from the expected tangent plane: at most this, ...
  float footprints;    ///< ... or this many pixel footprints at the expected depth, whichever is more
  float moving_depth;  ///< moving surfaces may be off by this much of their depth besides: vectors have no z
  float normal_cos;    ///< least cosine between the normals; -1: any
  float agreement_px;  ///< a vector that differs by no more from the camera's motion is the camera's motion
};

/// The surfaces of the centre's pixels in one other frame. All planes have the centre's size.
struct Match {
  Plane x, y;        ///< absolute pixel position; NaN: lost, or background
  Plane depth;       ///< planar, expected there, metres
  Plane difference;  ///< mean AO of the pixels there that show the surface, minus the centre's AO; 0: none does
  Plane still;       ///< 1: the camera explains all of the way there, 0: the surface moves by itself
  Plane weight;      ///< their bilinear weight, 0.25 to 1; 0: it is not seen there
};

enum class Side { before, after };

/// Walks away from a centre frame, one frame at a time.
/// A surface that the camera's motion explains so far is found directly from the centre, by depth (exact, also behind
/// occlusions); any other is carried from frame to frame by the vectors at the place it has reached. Vectors that point
/// the wrong way are carried over from the next frame (scatter_velocity). Of the four pixels around a position, those
/// count that are inside, on the expected tangent plane, with a like normal, and whose own vector leads back.
class Trajectories {
 public:
  /// `chain`: the centre, then the frames on one side in the order in which they are met; the numbers must be
  /// consecutive and the frames must outlive this object. A centre AO that is not finite counts as 1.
  Trajectories(const MatchTolerance& tolerance, std::span<const WindowFrame* const> chain, Side side);
  /// The match in the next frame of the chain; there must be one.
  Match next();
  size_t left() const { return chain_.size() - 1 - reached_; }

 private:
  struct Vectors {
    ConstPlaneView x, y;
  };
  Vectors outward(size_t frame);
  void advance(Match& to, Plane& step_x, Plane& step_y);
  void match(Match& to, const Plane& step_x, const Plane& step_y);

  MatchTolerance tolerance_;
  std::span<const WindowFrame* const> chain_;
  Side side_;
  size_t reached_ = 0;
  Plane x_, y_, depth_;        ///< where the surfaces are in the frame reached
  Plane still_;                ///< 1: the camera explains all of the way
  Plane vector_x_, vector_y_;  ///< onward from there; NaN: unknown
  VelocityPlanes carried_;
};

}  // namespace aftershade::temporal
