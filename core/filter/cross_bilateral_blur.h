#pragma once
#include "core/filter/sample_grid.h"
#include "core/params/table.h"

namespace aftershade::filter {

/// How one pass samples its kernel.
enum class KernelSampling {
  adaptive,                ///< seed 000's listing: outer pairs of pixels share the weight of one
  adaptive_exact_weights,  ///< the same taps, each pair weighted 2 w(r + 1/2)
  brute_force,             ///< every pixel
};
/// What a pixel takes for its AO from a half-resolution grid.
enum class AoFetch { block, bilinear };

/// Battlefield 3's cross-bilateral blur (Bavoil and Andersson, "Stable SSAO in Battlefield 3", GDC 2012; seed 000): two
/// 1-D passes at full resolution, BlurX and BlurY, with "CrossBilateralWeight"
///   w(r, d) = exp2(-r^2 / (2 sigma^2) - (s (d - d0))^2), sigma = (R + 1) / 2, s = sharpness_per_m
/// BlurX reads half-resolution AO beside full-resolution depth; the result is AO at every pixel. Adaptive sampling
/// takes the inner half of the kernel pixel by pixel and the outer half by the mean of two pixels, AO and depth alike,
/// at steps of two: at R = 8, 13 fetches instead of 17. The listing gives such a pair the weight of its inner pixel, so
/// the outer half counts half (algorithms 10). As with the listing's clamping samplers, what lies outside the image
/// repeats the border. Background neither gives nor takes and becomes 1; so does a pixel whose AO is unknown.
struct CrossBilateralBlurParams {
  static constexpr std::string_view method = "cross-bilateral-blur";
  static constexpr std::string_view summary =
      "Battlefield 3's cross-bilateral blur of half-resolution AO at every pixel";
  float radius_px = 8;  ///< R, pixels of the image at the reference height, rounded
  float reference_height_px = 1200;
  float sharpness_per_m = 16;  ///< the listing's "pre-scaled": what depth is multiplied with. Ours (HBAO+ has 16)
  KernelSampling sampling = KernelSampling::adaptive;
  AoFetch ao_fetch = AoFetch::block;  ///< the seed does not say
  bool depth_slope = false;           ///< HBAO+ 2013: depths are compared with a line through the first neighbour
  static const params::Table& table();
  bool operator==(const CrossBilateralBlurParams&) const = default;
};

/// The talk's packed (AO, Z): AO at every pixel and its depth times sharpness_per_m, +inf on background.
struct PackedAo {
  Plane ao, depth;
};

/// `ao` lies on `grid`, of which only step and origin are read (step 1: a texel is a pixel); `depth` in metres at every
/// pixel of the image (background: +inf, NaN or <= 0).
PackedAo cross_bilateral_blur_x(const CrossBilateralBlurParams& params, ConstPlaneView ao, const SampleGrid& grid,
                                ConstPlaneView depth, int display_height);
Plane cross_bilateral_blur_y(const CrossBilateralBlurParams& params, const PackedAo& blurred_x, int display_height);

/// Both passes. Radius 0 only brings the AO to every pixel.
Plane cross_bilateral_blur(const CrossBilateralBlurParams& params, ConstPlaneView ao, const SampleGrid& grid,
                           ConstPlaneView depth, int display_height);

}  // namespace aftershade::filter
