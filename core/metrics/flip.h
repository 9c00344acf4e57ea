#pragma once
#include "core/metrics/image_metrics.h"

/// FLIP: the difference that somebody sees who alternates between two images (Andersson et al. 2020, "FLIP: A
/// Difference Evaluator for Alternating Images"; 2021, "Visualizing Errors in Rendered High Dynamic Range Images").
/// Both give a plane of errors, 0 (no difference) to 1; the mean over the image is distribution(...).mean of
/// temporal_metrics.h. Images are linear Rec.709; below 0 counts as 0.
///
/// A pixel with a value that is not finite in either image does not count: its error is NaN, and to its neighbours both
/// images are black there. With planes of different sizes every error is NaN. Black images are images: two of them do
/// not differ. Of a file with more channels, who calls chooses the three.
namespace aftershade::metrics {

/// 0.7 m away from a screen that shows 3840 pixels on 0.7 m: the papers' viewer.
inline constexpr double kFlipPixelsPerDegree = 67;

/// LDR-FLIP of images as a display shows them: linear light, 0..1 (beyond is clipped). Symmetric.
Plane ldr_flip(const Rgb& image, const Rgb& reference, double pixels_per_degree = kFlipPixelsPerDegree);

/// Exposures in stops, `count` of them evenly from `start` to `stop`.
struct Exposures {
  double start, stop;
  int count;
  double at(int i) const { return count > 1 ? start + (stop - start) * i / (count - 1) : start; }
};
/// The 2021 paper's automatic choice (section 4.1): the exposures at which the tone mapper takes the reference's
/// greatest luminance, and then its median, to 0.85; one a stop, at least 2. Where the paper's logarithms have no
/// value: if more than half of the reference is black, its median is that of the rest; a reference without any light is
/// seen at exposure 0 alone. The range ends 32 stops from its start.
Exposures flip_exposures(const Rgb& reference);

/// HDR-FLIP of scene-linear images: the greatest LDR-FLIP over the reference's exposures, both images tone mapped with
/// the papers' ACES curve (Narkowicz 2016 without its pre-exposure). Not symmetric: `reference` chooses the exposures.
Plane hdr_flip(const Rgb& image, const Rgb& reference, double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace aftershade::metrics
