#pragma once
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera/camera.h"
#include "core/metrics/image_metrics.h"

/// All scores of a sequence beside its reference, under the names that the command line and the reports use. Each is a
/// free function of image_metrics.h, flip.h, temporal_metrics.h, trail_metrics.h or instant.h.
///
/// Scores of colour look at red, green and blue, whatever else a file has; those of structure and time at the display
/// luma (Displayed). Names that start with "ao_" look at the AO, where there are surfaces if depth tells (its
/// background never counts). Scores of time follow the motion that depth, vectors and cameras tell, from the frame
/// before.
namespace aftershade::metrics {

/// Which way a score is good; `zero`: the nearer to 0 the better (a bias).
enum class Better { lower, higher, zero };

struct MetricInfo {
  std::string_view name;  ///< "psnr", "ao_rmse", "flicker_stable"
  std::string_view unit;  ///< "dB", "frames", "" for a plain number
  std::string_view doc;   ///< one sentence: what it measures, and where it is defined
  Better better;
  bool of_ao;      ///< looks at the AO; false: at the colour
  bool reference;  ///< needs a reference
  bool temporal;   ///< looks at several frames: needs depth, and velocity or cameras with a position
  bool moving;     ///< tells moving surfaces from still ones: needs depth, velocity and cameras with a position
};
/// Every metric there is, in the order of reports.
std::span<const MetricInfo> metric_infos();

/// One frame of a result and of its reference, all planes of one size (the display window, see placed()); planes that
/// are not there are empty. The planes must live until add() returns.
struct ScoredFrame {
  int number = 0;
  Rgb color{}, true_color{};              ///< scene-linear Rec.709
  ConstPlaneView ao, true_ao;             ///< 1 = open
  ConstPlaneView depth;                   ///< metres, +inf background
  ConstPlaneView velocity_x, velocity_y;  ///< velocity_prev (Role): pixels, NaN unknown
  ConstPlaneView mask;                    ///< scores count where it is above 0.5; empty: everywhere
  std::optional<Camera> camera;           ///< with its position it tells which surfaces move by themselves
  int origin_x = 0, origin_y = 0;         ///< absolute coordinates of index (0, 0): cameras and tiles refer to them
};

/// Name of a metric -> value; NaN: nothing to count. A metric whose inputs are not there is left out.
using Scores = std::map<std::string, double>;

/// Scores frame after frame, in their order; holds what temporal scores need of earlier frames.
class SequenceScorer {
 public:
  /// `names` of metric_infos(); throws Error(usage) for others, with "did you mean".
  explicit SequenceScorer(std::vector<std::string> names);
  ~SequenceScorer();
  SequenceScorer(SequenceScorer&&) noexcept;
  SequenceScorer& operator=(SequenceScorer&&) noexcept;

  /// The frame's own scores. Temporal ones need the frame before (number - 1): they are left out where it is missing.
  Scores add(const ScoredFrame& frame);
  /// Of all frames so far together (from all pixels where a score is a mean of pixels, not a mean of frames).
  Scores sequence() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace aftershade::metrics
