#pragma once
#include <span>
#include <string_view>

#include "core/motionblur/motion.h"
#include "core/motionblur/surface_points.h"
#include "core/params/table.h"

namespace aftershade::motionblur {

/// Forward reconstruction in time slices (algorithms 3.6, mode 3): what a camera would have accumulated.
///
/// At each of many times of the exposure every pixel of frame f is moved along its path as a box that overlaps the
/// pixels of the picture; overlaps are composited front to back by depth, and the slices are averaged. What f does not
/// show - background that something moving uncovers, what comes in at the border - is taken from the neighbouring
/// frames: those of their pixels that lie behind f's surfaces or outside f (surface_points.h). Light changes too while
/// the shutter is open: where a neighbour sees the same surface, its colour changes evenly towards the one it has
/// there, so that moving shadows blur. Where no frame saw what was uncovered, the farthest surface that the pixel shows
/// at other times stands in, or else the nearest surface that lies behind; the share of the exposure is `guessed`.
///
/// A pure function of the frames f - neighbours to f + neighbours; pixels are computed one by one, ties go to depth,
/// then to the frame and the pixel they come from, so threads change nothing. RGBA together, premultiplied,
/// scene-linear.
struct ReconstructParams : PathParams {
  static constexpr std::string_view method = "reconstruct";
  static constexpr std::string_view summary =
      "forward reconstruction in time slices, background from the neighbour frames";
  float slices_per_px = 2;  ///< of the longest way in a tile of the picture
  int least_slices = 16, most_slices = 128;
  int neighbours = 2;  ///< frames to each side
  bool changing_light = true;
  static const params::Table& table();
  bool operator==(const ReconstructParams&) const = default;
};

struct Reconstruction {
  std::vector<Plane> channels;
  Plane guessed;  ///< share of the exposure that no frame saw, 0 to 1
};

/// The channels of sequence[0] as the exposure shows them; the others are its neighbours in any order. Pixels that
/// nothing crosses which moves keep their bits, and so do pixels with a channel that is not finite (or beyond 1e30),
/// which are never spread.
Reconstruction reconstruct(const ReconstructParams& params, const std::vector<SequenceFrame>& sequence,
                           Shutter shutter);

}  // namespace aftershade::motionblur
