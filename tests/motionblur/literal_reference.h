#pragma once
#include <vector>

#include "tests/motionblur/literal_blur.h"

namespace aftershade::tests {

/// The methods written straight from algorithms 2.2 and 3.1, scalar and in double, pixel by pixel:
/// [channel][y * width + x]. `radius` is K or r. Tiles are searched pixel by pixel.
std::vector<std::vector<double>> reference_blur(const motionblur::Mcguire2012Params& params, int radius,
                                                const BlurScene& scene);
std::vector<std::vector<double>> reference_blur(const motionblur::Guertin2014Params& params, int radius,
                                                const BlurScene& scene);

}  // namespace aftershade::tests
