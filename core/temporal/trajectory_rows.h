#pragma once
#include "core/temporal/trajectory.h"

/// What Trajectories hands to its rows.
namespace aftershade::temporal {

/// Planes of one frame, read at pixel indices; all have one stride, and those that are missing are null.
struct FrameSamples {
  const float *ao, *depth;
  const float *nx, *ny, *nz;
  const float *inward_x, *inward_y;    ///< vectors towards the centre
  const float *outward_x, *outward_y;  ///< and away from it
  int width, height, stride, min_x, min_y;
};

struct MatchInput {
  FrameSamples frame;
  Projection projection;  ///< of the frame, in absolute pixels: results do not depend on where its window lies
  const MatchTolerance& tolerance;
  float consistency_px, consistency_share;
  float turn[3][3];           ///< row vectors: direction in the centre's camera space -> in the frame's
  const WindowFrame& centre;  ///< normals may be empty
  const Plane& still;
  const Plane &step_x, &step_y;  ///< from where surfaces are expected to where they were one frame nearer the centre
};

struct MatchOutput {
  Match& to;                   ///< where surfaces are expected is known
  Plane& depth;                ///< where not still, that which is there
  Plane &vector_x, &vector_y;  ///< outward vector there, NaN: unknown
};

}  // namespace aftershade::temporal
