#pragma once
#include <span>
#include <string_view>

#include "core/image/window.h"
#include "core/motionblur/motion.h"
#include "core/params/table.h"

namespace aftershade::motionblur {

/// A layered gather normalised by the blur's own shape (algorithms 3.5, 3.6), made exact for any number of layers by
/// asking at each time of the exposure: which surface is in front of this pixel now?
///
/// For pixel x and time t, every motion m that reaches x's tile, and x's own, names a place y = x - path_m(t), from
/// which a surface of that motion comes. The pixel q there covers x at t if q + path_q(t) lies within half a pixel of
/// x; if q moves otherwise, its own path names the next place to look at. Of all q that cover x the nearest to the
/// camera is what the shutter sees; the mean over all times is the result. Each surface is thus spread evenly over its
/// path with ends antialiased by one pixel, weighs the inverse of its own speed, and hides what lies behind it exactly
/// as long as it is there, whatever the speeds of both. Depths are only compared, never subtracted: no length of the
/// scene's.
/// Times at which nothing in the frame covers x show background that a moving surface uncovers: there the farthest of
/// the places looked at stands in. Where a path comes from outside the image, the time is dropped with its share.
/// RGBA together, premultiplied, scene-linear.
struct GatherPlusParams : PathParams {
  static constexpr std::string_view method = "gather-plus";
  static constexpr std::string_view summary = "layered gather from one frame, exact coverage at any speeds";
  float taps_per_px = 1;  ///< of the longest path that reaches the pixel's tile
  int least_taps = 24, most_taps = 256;
  int motions = 4;  ///< distinct ones per tile
  static const params::Table& table();
  bool operator==(const GatherPlusParams&) const = default;
};

struct GatherPlusInput {
  const Motion* motion;
  ConstPlaneView depth;  ///< metres; +inf, NaN, <= 0: background. Empty (data == nullptr): everything at one depth
  Window window;         ///< where the planes lie
  Shutter shutter;
};

/// Blurs `channels` together, in place: every plane is as large as the window. Pixels in tiles that no surface reaches
/// which moves half a pixel or more keep their bits, and so does a pixel with a channel that is not finite (or beyond
/// 1e30), which is never spread. `guessed`, if not null, receives the share of each pixel's exposure for which the
/// farthest of the places looked at stands in, 0 to 1.
void gather_plus(const GatherPlusParams& params, const GatherPlusInput& input, std::span<Plane* const> channels,
                 Plane* guessed = nullptr);

}  // namespace aftershade::motionblur
