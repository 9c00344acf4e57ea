#pragma once
#include <array>
#include <cstdint>

#include "core/image/plane.h"

/// Scores that compare an image with its truth. All compare planes of the same size, in double, in a fixed order, so a
/// score is the same on every run and with every number of threads. Pixels count where `mask` is above 0.5 (an empty
/// mask: everywhere) and both values are finite. With no pixel to count, or planes of different sizes, a score is NaN.
namespace aftershade::metrics {

/// The errors a - b of some pixels, from which rmse, mae and bias follow: those of several frames add up.
struct ErrorSums {
  double errors = 0, absolute = 0, squares = 0;
  int64_t count = 0;
  ErrorSums& operator+=(const ErrorSums& other);
  double mean() const;
  double mean_absolute() const;
  double root_mean_square() const;
  double psnr() const;  ///< 10 log10(1 / mean square) dB for a peak of 1; +inf without error
};
ErrorSums error_sums(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});

/// sqrt(mean((a - b)^2)), in the planes' unit.
double rmse(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
/// mean |a - b|.
double mae(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
/// mean(a - b): the bias of `a` when `b` is the truth.
double mean_error(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
/// 10 log10(1 / mean((a - b)^2)) dB for a peak of 1; +inf for equal planes.
double psnr(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});

/// Means of two planes and sums of the squares and products of what differs from them; those of several frames add up
/// (Chan, Golub, LeVeque 1979).
struct Covariance {
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  int64_t count = 0;
  Covariance& operator+=(const Covariance& other);
  void add(double a, double b);
  double correlation() const;  ///< Pearson's coefficient, -1 to 1; NaN when either is constant
};
Covariance covariance(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
/// Pearson's correlation coefficient, -1 to 1; NaN when either plane is constant.
double correlation(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});

/// A mean of pixels; those of several frames add up.
struct MeanSum {
  double sum = 0;
  int64_t count = 0;
  void add(double value);
  MeanSum& operator+=(const MeanSum& other);
  double mean() const;  ///< NaN of nothing
};
/// The mean of a plane's finite values where the mask is set, such as a plane of FLIP's errors.
MeanSum mean_sum(ConstPlaneView values, ConstPlaneView mask = {});

using Rgb = std::array<ConstPlaneView, 3>;
/// PSNR over the three planes together, each clipped to 0..1 and raised to 1/2.2: of scene-linear images as displayed.
double display_psnr(const Rgb& a, const Rgb& b, ConstPlaneView mask = {});

/// What a display shows of two scene-linear images: every channel clipped to 0..1 and raised to 1/2.2.
struct Displayed {
  /// 0.2126 R' + 0.7152 G' + 0.0722 B' (Rec.709's luma) of both; NaN where a channel is.
  Plane luma_a, luma_b;
  ErrorSums errors;  ///< of the three channels together
};
/// `b` may be empty: then there is no luma_b and no error.
Displayed displayed(const Rgb& a, const Rgb& b, ConstPlaneView mask = {});

/// Mean structural similarity of images in 0..1 (Wang et al. 2004, "Image Quality Assessment: From Error Visibility to
/// Structural Similarity"): gaussian window 11x11 of sigma 1.5, K1 0.01, K2 0.03, L 1. The mean is over pixels whose
/// whole window lies in the image (and, when given, whose own mask is set); values that are not finite count as 0.
double ssim(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
MeanSum ssim_sum(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});

}  // namespace aftershade::metrics
