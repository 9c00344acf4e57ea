#pragma once
#include <cstddef>
#include <vector>

#include "core/color/display.h"
#include "core/image/plane.h"
#include "core/image/window.h"
#include "core/report/comparison.h"

/// Which frames and regions a report shows: those where the candidates are farthest from the reference.
namespace aftershade::report {

/// A picture's planes, all as large as the display window: three (scene-linear red, green, blue), one (AO, shown as
/// grey) or none (there is no such picture).
using Pixels = std::vector<ConstPlaneView>;

struct ShowOptions {
  color::DisplayOptions display{};
  int max_frames = 12;
  size_t max_bytes = size_t{512} << 20;  ///< of pictures held; fewer frames are kept, but at least one
  int whole_width_px = 960;              ///< wider frames are scaled down to it
  int region_px = 640;                   ///< greatest width and height of a region
  bool has_reference = false;            ///< its place is kept where a frame has no picture of it
  float pixel_aspect = 1;                ///< whole frames are shown with square pixels, regions pixel by pixel
};

/// How wrong one frame is, and where. Errors are squared differences of values brought near the eye's scale: of the
/// square roots of colours clipped to 0..1, of AO as it is; the mean of the planes counts. They are whole numbers of
/// 1/65536, so that sums are exact.
struct FrameError {
  double worst = 0;  ///< root mean square over the frame's pixels; the greatest of the candidates'
  Window region;     ///< index coordinates: where the errors of all candidates sum to most; in doubt the middle
};
/// Against the reference; without one the candidates' spread (greatest minus smallest value) is the error; of a single
/// candidate without reference what it changed of the input. What cannot be compared is no error.
FrameError frame_error(const std::vector<Pixels>& candidates, const Pixels& reference, const Pixels& input,
                       int region_px);

/// Is given frame after frame and keeps the worst, as small pictures; what it holds does not grow with the sequence.
/// Of equally bad frames it keeps the earlier offered.
class WorstFrames {
 public:
  WorstFrames(Window display, ShowOptions options);

  /// The planes are looked at only during the call. Every call has the same candidates in the same order. Throws
  /// Error(internal) for planes of another size than the display window, and as preview::display_picture.
  void offer(int number, const std::vector<Pixels>& candidates, const Pixels& reference, const Pixels& input);

  /// What Comparison::shown wants, by number; leaves nothing.
  std::vector<ShownFrame> take();

 private:
  bool is_wanted(double error, size_t bytes) const;
  ShownFrame shown(int number, const FrameError& error, const std::vector<const Pixels*>& pictures) const;

  Window display_;
  ShowOptions options_;
  std::vector<ShownFrame> kept_;  ///< worst first
};

}  // namespace aftershade::report
