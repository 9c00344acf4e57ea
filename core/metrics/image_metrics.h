#pragma once
#include <array>

#include "core/image/plane.h"

/// Scores that compare an image with its truth. All compare planes of the same size, in double, in a fixed order, so a
/// score is the same on every run and with every number of threads. Pixels count where `mask` is above 0.5 (an empty
/// mask: everywhere) and both values are finite. With no pixel to count, or planes of different sizes, a score is NaN.
namespace aftershade::metrics {

/// sqrt(mean((a - b)^2)), in the planes' unit.
double rmse(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
/// mean |a - b|.
double mae(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
/// mean(a - b): the bias of `a` when `b` is the truth.
double mean_error(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
/// Pearson's correlation coefficient, -1 to 1; NaN when either plane is constant.
double correlation(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});
/// 10 log10(1 / mean((a - b)^2)) dB for a peak of 1; +inf for equal planes.
double psnr(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});

using Rgb = std::array<ConstPlaneView, 3>;
/// PSNR over the three planes together, each clipped to 0..1 and raised to 1/2.2: of scene-linear images as displayed.
double display_psnr(const Rgb& a, const Rgb& b, ConstPlaneView mask = {});

/// Mean structural similarity of images in 0..1 (Wang et al. 2004, "Image Quality Assessment: From Error Visibility to
/// Structural Similarity"): gaussian window 11x11 of sigma 1.5, K1 0.01, K2 0.03, L 1. The mean is over pixels whose
/// whole window lies in the image (and, when given, whose own mask is set); values that are not finite count as 0.
double ssim(ConstPlaneView a, ConstPlaneView b, ConstPlaneView mask = {});

}  // namespace aftershade::metrics
