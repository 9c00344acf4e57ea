#pragma once
#include <array>
#include <map>
#include <memory>
#include <vector>

#include "core/metrics/past.h"
#include "core/metrics/sequence_scores.h"
#include "core/metrics/trail_metrics.h"

/// One frame among its neighbours, with what several scores need of it made once; and the scores of structure and time,
/// which look at one plane of it.
namespace aftershade::metrics {

/// The plane that a score looks at: the display luma of the colour, or the AO.
enum class Signal { color, ao };

/// What is kept of a frame for the next one. Planes that nothing needs are empty.
struct History {
  int number = 0;
  std::array<Plane, 2> image, truth;  ///< of each Signal
  Plane depth;
  std::optional<Camera> camera;
  Plane since_disoccluded, since_footprint;  ///< frames_since()
};

/// Frames after an event that are told apart; beyond them everything is settled.
inline constexpr int kFadingFrames = 8;

class Instant {
 public:
  /// `before`: of frame number - 1, null when there is none.
  Instant(const ScoredFrame& frame, const History* before);

  const ScoredFrame& frame() const { return frame_; }
  bool has(const MetricInfo& metric) const;  ///< everything that the metric looks at

  const Displayed& shown();
  const ErrorSums& color_errors();  ///< scene-linear, the three channels together
  const ErrorSums& ao_errors();
  ConstPlaneView image(Signal signal);
  ConstPlaneView truth(Signal signal);  ///< empty without a reference
  ConstPlaneView mask(Signal signal);   ///< where it counts: the frame's mask; of AO the surfaces alone

  const Past& past();
  ConstPlaneView before(Signal signal) const;
  /// |change of the image - change of the truth| along the motion; without a reference the image's change.
  const Plane& flicker(Signal signal);
  ConstPlaneView stable();    ///< surfaces that are not unstable_pixels()
  ConstPlaneView unstable();  ///< both where the mask is set

  /// Errors by the frames since surfaces came into sight, and since they were in the footprint of a moving one:
  /// element k is of k + 1 frames, element kFadingFrames of all that is settled.
  const std::vector<AgeError>& since_disoccluded(Signal signal);
  const std::vector<AgeError>& since_left(Signal signal);

  /// What the next frame needs, of the signals that scores of time look at.
  std::unique_ptr<History> history(bool color, bool ao);

 private:
  void split_by_stability();
  std::vector<AgeError> errors_since(const Plane& since, int first_age, Signal signal);
  const ScoredFrame& frame_;
  const History* before_;
  std::optional<Displayed> shown_;
  std::optional<ErrorSums> color_errors_, ao_errors_;
  std::optional<Past> past_;
  Plane surfaces_, stable_, unstable_, since_disoccluded_, since_footprint_;
  std::map<Signal, Plane> flicker_;
  std::map<Signal, std::vector<AgeError>> disoccluded_errors_, left_errors_;
};

/// Tiles of motion blur and interleaved sampling, at which seams are looked for (all that divide one of them show too).
inline constexpr std::array kTiles_px = {8, 16, 20, 32, 40, 64};
struct TileSeams {
  std::array<SeamSums, kTiles_px.size()> of_size;
  TileSeams& operator+=(const TileSeams& other);
  double greatest() const;  ///< SeamSums::ratio() of the size with the clearest seams; 1 where nothing differs at all
};
TileSeams tile_seams(Instant& instant, Signal signal);

/// Height of the picture over the width of its border, and over the footprint's reach around moving surfaces.
inline constexpr int kBorderShare = 24;
inline int border_px(int height) { return height / kBorderShare > 1 ? height / kBorderShare : 1; }
struct BorderErrors {
  ErrorSums border, inside;
  BorderErrors& operator+=(const BorderErrors& other);
  double excess() const;  ///< mean |error| at the border - mean |error| inside
};
BorderErrors border_errors(Instant& instant, Signal signal);

/// AgeError of every age; those of frames pool.
struct Fading {
  std::vector<AgeError> by_age;
  Fading& operator+=(const Fading& other);
  AgeError fresh() const;  ///< of all ages but the settled
  /// half_life_frames() of what errors exceed the settled ones by: their means, or with `absolute` their amounts. 0
  /// when the first exceeds by less than 0.01, which nobody sees.
  double half_life(bool absolute) const;
};

}  // namespace aftershade::metrics
