#pragma once
#include <vector>

#include "tests/motionblur/blur_scene.h"

namespace aftershade::tests {

/// The blur written straight from the slides of seed 004 and algorithms 2.1 to 3.1, scalar and in double, pixel by pixel:
/// [channel][y * width + x]. `radius` is K. It looks for the neighbourhood's velocity among the pixels themselves.
std::vector<std::vector<double>> reference_blur(const motionblur::ScalableBlurParams& params, int radius,
                                                const BlurScene& scene);

}  // namespace aftershade::tests
