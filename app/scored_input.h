#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "app/job.h"
#include "core/metrics/sequence_scores.h"

/// Sequences that are scored: results, references, and where depth and motion come from.
namespace aftershade::app {

/// A sequence with colour, AO or both to compare.
struct ScoredSide {
  Input input;
  std::string view;  ///< the one that is scored: --view, else the first
  bool color = false, ao = false;
};
/// Opens it. Its AO is what --channel ao= says, else what `render --ao` and `--ao-only` write, else what its producer's
/// profile calls AO.
ScoredSide open_scored_side(InputArgs args);

/// Planes of one frame that cover its display window; those that are not there, or were not asked for, are empty.
struct SidePlanes {
  std::string path;
  Window display;
  std::array<Plane, 3> color;  ///< 0 where the file has no pixel
  Plane ao;                    ///< 1 there
  metrics::Rgb rgb() const { return {color[0], color[1], color[2]}; }
};
/// The beauty of a frame, and this AO in its window (may be empty). Planes are shared with the frame where they can be.
SidePlanes side_planes(const Frame& frame, const Plane& ao, const std::string& path);
SidePlanes load_side(const ScoredSide& side, int frame, bool color, bool ao);

/// What moves, and how: depth, velocity_prev and camera of one frame in its display window.
struct GeometryPlanes {
  Window display;
  Plane depth, velocity_x, velocity_y;
  std::optional<Camera> camera;
};
/// What there is to score.
struct Scorable {
  bool color = false, ao = false;  ///< of both sides, or of a result without reference
  bool reference = false;
  bool motion = false;  ///< depth, and vectors or cameras with a position: scores of time can follow surfaces
  bool moving = false;  ///< depth, vectors and such cameras: what moves by itself can be told
};
/// Scorable::motion and moving, as the first frame of the view shows.
void add_geometry(const Input& input, const std::string& view, Scorable& scorable);
/// The metrics to compute: those asked for, each once, in the order of metric_infos(); all that are possible when none
/// is. Throws Error(usage) for unknown names, Error(no_input) for one that lacks an input, saying which.
std::vector<std::string> metrics_to_score(const std::vector<std::string>& asked, const Scorable& scorable);

/// Of a frame with depth. Vectors to the next frame alone are carried forward from the frame before, as render does.
GeometryPlanes geometry_of(const Frame& frame, const Frame* before);
GeometryPlanes load_geometry(const Input& input, const std::string& view, int frame);

/// Frame `number` of a result beside its reference (may be null) on geometry and mask (may be null, empty). Throws
/// Error(data) naming the frame and both files when their display windows differ in size. What it refers to must live
/// while it is scored.
metrics::ScoredFrame scored_frame(int number, const SidePlanes& result, const SidePlanes* reference,
                                  const GeometryPlanes* geometry, const Plane& mask);

}  // namespace aftershade::app
