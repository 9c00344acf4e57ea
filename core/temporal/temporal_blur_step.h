#pragma once
#include "core/temporal/temporal_blur.h"

namespace aftershade::temporal {

/// What the parts of one step of the temporal blur share.
struct TemporalBlurStep {
  const TemporalBlurParams& params;
  const filter::SampleGrid& grid;
  const filter::Surface& surface;
  const TexelSurface& texels;
  /// Of the five taps, in texels: (4 + 1 + 0 + 1 + 4) / 5, or (4 + 4 + 0 + 4 + 4) / 16.
  float tap_variance() const { return params.weights == BlurTaps::box ? 2.0F : 1.0F; }
};

}  // namespace aftershade::temporal
