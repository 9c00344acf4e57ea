#pragma once
#include <vector>

#include "core/filter/cross_bilateral_blur.h"

namespace aftershade::filter {

/// A tap at positive offsets: at pixel `first`, or half way to the pixel after it.
struct KernelTap {
  int first;
  bool pair;
  float log2_weight;
  float distance() const { return static_cast<float>(first) + (pair ? 0.5F : 0.0F); }
};

/// Seed 000, "HLSL: Adaptive Sampling". The listing's last pair runs past a radius that is not a multiple of 4 or one
/// less; here that is the pixel alone.
std::vector<KernelTap> kernel_of(KernelSampling sampling, int radius);

}  // namespace aftershade::filter
