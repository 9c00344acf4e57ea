#pragma once
#include <span>
#include <string_view>

#include "core/motionblur/gather.h"
#include "core/motionblur/motion.h"
#include "core/motionblur/tile_max.h"

namespace aftershade::motionblur {

/// McGuire, Hennessy, Bukowski and Osman, "A Reconstruction Filter for Plausible Motion Blur", I3D 2012, as algorithms
/// 2.1 and 2.2 give it: the ancestor of most motion blurs in games.
///
/// Velocities are half-exposure vectors v in pixels, K at most; |v| counts as half a pixel at least. Tiles are K x K,
/// and v_N is the longest velocity in the 3x3 tiles around a pixel X: within K nothing else can reach it. S taps lie
/// along
/// +-v_N, shifted by a random share of their spacing; the middle one is X itself, with weight 1 / |v_X|. A tap Y at
/// distance d weighs
///   before cone(d, |v_Y|) + behind cone(d, |v_X|) + 2 cylinder(d, |v_Y|) cylinder(d, |v_X|)
///   cone(d, r) = sat(1 - d / r), cylinder(d, r) = 1 - smoothstep(0.95 r, 1.05 r, d)
///   before = sat(1 - (z_Y - z_X) / E), behind = sat(1 - (z_X - z_Y) / E), z positive
/// and the sum of colours is divided by the sum of weights.
///
/// Known: the formulas, S = 15, K = 20, and E of 1 mm to 10 cm. Ours: the height that K is for (720 lines), the hash
/// behind the random shift, distances of the tap rather than of the pixel it falls on (what algorithms 3.5 measured),
/// and that taps outside the image are dropped with their weight instead of repeating the border.
///
/// What to expect (algorithms 3.5, tests/motionblur/literal_coverage_test.cpp): a moving edge is too opaque inside and
/// too wide outside (mean error 0.10, largest 0.35 of coverage), and more taps make it worse, because the centre's
/// weight does not grow with S.
struct Mcguire2012Params : MotionParams {
  static constexpr std::string_view method = "mcguire2012";
  static constexpr std::string_view summary = "Motion blur of McGuire et al. (I3D 2012)";
  int taps = 15;                     ///< S, with the centre; odd
  float max_radius_px = 20;          ///< K at the reference height, rounded up; 0: the longest motion of the frame
  float reference_height_px = 720;   ///< ours
  float soft_depth_extent_m = 0.1F;  ///< E
  static const params::Table& table();
  bool operator==(const Mcguire2012Params&) const = default;
};

/// Blurs `channels` together, in place (RGBA premultiplied, scene-linear): every plane is as large as `window`. Pixels
/// whose 3x3 tiles move at most half a pixel keep their bits, and so does a pixel with a channel that is not finite.
void mcguire2012_blur(const Mcguire2012Params& params, const GatherInput& input, std::span<Plane* const> channels);

/// The tiles it gathers by, K x K.
VelocityTiles velocity_tiles(const Mcguire2012Params& params, const GatherInput& input);

}  // namespace aftershade::motionblur
