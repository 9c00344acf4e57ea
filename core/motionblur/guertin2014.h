#pragma once
#include <span>
#include <string_view>

#include "core/motionblur/gather.h"
#include "core/motionblur/motion.h"
#include "core/motionblur/tile_max.h"

namespace aftershade::motionblur {

enum class TapSplit { even, variance };

/// Guertin, McGuire and Nowrouzezahrai, "A Fast and Stable Feature-Aware Motion Blur Filter", HPG 2014, as algorithms
/// 3.1 gives it: McGuire et al. 2012 with two directions of taps, weights that ask whether motion points along the tap,
/// fewer seams between tiles and no scale of depth.
///
/// Velocities are half-exposure vectors v in pixels, r at most; |v| counts as half a pixel at least; norm(v) is
/// v / (|v| + 1e-5). Tiles are r x r; v_max is the longest velocity in the 3x3 tiles, of those that move toward
/// or away from the tile (Dilation::directional); near borders of tiles a pixel p takes the tile beyond at random, up
/// to tau / 4 tiles away. With
///   w_n = norm(v_max), w_p across it, on the side of v_p
///   w_c = norm(lerp(w_p, norm(v_p), sat((|v_p| - 0.5) / gamma)))        slow pixels look across the motion
/// N taps lie at S = p + t |v_max| d, t evenly in -1 to 1, shifted by j eta spacings, j in -1 to 1; d is w_n for taps
/// 0, 2, 4 and w_c for taps 1, 3, 5 and so on. p itself weighs N / (kappa |v_p|), a tap at T = |t| |v_max|
///   before cone(T, |v_S|) |norm(v_S) . d| + behind cone(T, |v_p|) |w_c . d|
///     + 2 cylinder(T, min(|v_S|, |v_p|)) max(|norm(v_S) . d|, |w_c . d|)
/// with cone and cylinder as in mcguire2012.h, before = sat(1 - z), behind = sat(1 + z), z = (z_S - z_p) / min(z_S,
/// z_p).
///
/// Known: the formulas and N = 35, r = 40 at 720 lines, kappa = 40, eta = 0.95, gamma = 1.5, tau = 1. Not established:
/// what tau and phi = 27 scale exactly (here tau scales the reach of the tile choice, phi is left out), and how tile
/// variance splits taps. `split` even is the published listing, and what reproduces algorithms 3.5; `variance` takes
/// the share of taps along w_c from 1 - mean |norm(v_max(t)) . norm(v_max(n))| over adjacent tiles n, spread evenly,
/// and all others along w_n. Ours: magnitudes of the dot products (the blur is symmetric in v, algorithms 2.1), half a
/// pixel as the least |v_p| of the centre's weight, an R2 lattice for j where the paper has Halton's sequence, and that
/// taps outside the image are dropped with their weight.
///
/// What to expect (algorithms 3.5, tests/motionblur/literal_coverage_test.cpp): errors of coverage at a moving edge as
/// large as McGuire's (mean 0.09, with split by variance 0.15; largest 0.35); what it gains is where motions meet.
struct Guertin2014Params : MotionParams {
  static constexpr std::string_view method = "guertin2014";
  static constexpr std::string_view summary = "Motion blur of Guertin, McGuire and Nowrouzezahrai (HPG 2014)";
  int taps = 35;                    ///< N
  float max_radius_px = 40;         ///< r at the reference height, rounded up; 0: the longest motion of the frame
  float reference_height_px = 720;  ///< the paper's images
  float tap_jitter = 0.95F;         ///< eta
  float tile_jitter = 1;            ///< tau
  float centre_divisor = 40;        ///< kappa
  float slow_px = 1.5F;             ///< gamma
  TapSplit split = TapSplit::even;
  static const params::Table& table();
  bool operator==(const Guertin2014Params&) const = default;
};

/// Blurs `channels` together, in place (RGBA premultiplied, scene-linear): every plane is as large as `window`. Pixels
/// whose 3x3 tiles move at most half a pixel keep their bits, and so does a pixel with a channel that is not finite.
void guertin2014_blur(const Guertin2014Params& params, const GatherInput& input, std::span<Plane* const> channels);

/// The tiles it gathers by, r x r.
VelocityTiles velocity_tiles(const Guertin2014Params& params, const GatherInput& input);

}  // namespace aftershade::motionblur
