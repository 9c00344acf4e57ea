#pragma once
#include <span>
#include <string_view>

#include "core/motionblur/dilation.h"
#include "core/motionblur/gather.h"
#include "core/motionblur/motion.h"
#include "core/params/table.h"

namespace aftershade::motionblur {

enum class Jitter { checkerboard, random4x4 };
enum class Directions {
  neighbourhood,      ///< v_N alone
  alternate,          ///< v_N and v_C in turn
  alternate_literal,  ///< the same with v_C as it is, which kills the blur beyond a moving edge (algorithms 2.4)
  three,  ///< v_N, v_C and the tile's own maximum in turn (slide "Scale for Quality"), outwards from the centre
};
enum class DepthComparison {
  soft_extent,  ///< differences over soft_depth_extent_m, as in the slides
  relative,     ///< differences over the nearer depth (Guertin et al. 2014, algorithms 3.1): no length of the scene's
};
enum class VelocityBits {
  exact,
  eight,  ///< literally as on slide "Render Velocity": -K to K scaled to 0 to 1 in 8 bits, in which 0 is K / 255
};

/// Vicarious Visions' scalable motion blur (seed 004), the gather of McGuire et al. 2012 with alternating directions.
/// Velocities are half-exposure vectors in pixels, clamped to K; tiles are K x K; neighbour max is 3x3 tiles.
/// The shutter is centred on the frame. Per tap at distance d, with f and b the soft depth comparison over
/// `soft_depth_extent_m`:
///   weight = b (1 - d/|v_C|) + f (1 - d/|v_S|) + [|v_S| >= d and |v_C| >= d]     slides "Background / Foreground /
///   Mutually Blurry"
/// each term with its tunable weight; the sum of colours is divided by the sum of weights. Alternation keeps the length
/// of v_N and takes v_C only as a direction, and only if |v_C| >= 1.5 px (algorithms 2.4). Taps outside the image are
/// dropped with their weight. RGBA together, premultiplied, scene-linear.
struct ScalableBlurParams : MotionParams {
  static constexpr std::string_view method = "scalable-motion-blur";
  static constexpr std::string_view summary = "Vicarious Visions' scalable motion blur (SIGGRAPH 2012)";
  int taps = 9;              ///< with the centre; odd
  float max_radius_px = 18;  ///< K at the reference height, rounded up; 0: the longest motion of the frame
  float reference_height_px = 1080;
  Jitter jitter = Jitter::random4x4;
  int passes = 1;  ///< over the same picture, each with other jitter; their mean counts
  Directions directions = Directions::alternate;
  Dilation dilation = Dilation::square;
  DepthComparison comparison = DepthComparison::soft_extent;
  float soft_depth_extent_m = 0.1F;  ///< ours: not stated by the seed
  float background_weight = 1, foreground_weight = 1, both_moving_weight = 1;
  float centre_weight = 1;  ///< factor of McGuire's 1 / |v_C|: higher is subtler, lower is thicker
  VelocityBits velocity_bits = VelocityBits::exact;
  static const params::Table& table();
  bool operator==(const ScalableBlurParams&) const = default;
};

/// K in pixels for an image of this height, if max_radius_px is not 0.
int max_radius_px(const ScalableBlurParams& params, int display_height);
/// K in pixels; with max_radius_px 0 the longest velocity, rounded up, or the planes' longer side if that is less.
int radius_px(const ScalableBlurParams& params, const HalfVelocity& velocity, int display_height);

/// Blurs `channels` together, in place: every plane is as large as `window`. Pixels whose 3x3 tiles move at most half a
/// pixel keep their bits, and so does a pixel with a channel that is not finite.
void scalable_motion_blur(const ScalableBlurParams& params, const GatherInput& input, std::span<Plane* const> channels);

/// The tiles it gathers by; they are radius_px() large.
VelocityTiles velocity_tiles(const ScalableBlurParams& params, const GatherInput& input);

}  // namespace aftershade::motionblur
