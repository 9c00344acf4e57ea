#include "core/filter/cross_bilateral_taps.h"

namespace aftershade::filter {

std::vector<KernelTap> kernel_of(KernelSampling sampling, int radius) {
  const float sigma = static_cast<float>(radius + 1) / 2, falloff = 1 / (2 * sigma * sigma);
  const auto log2_weight = [&](float r) { return -r * r * falloff; };
  std::vector<KernelTap> taps;
  int r = 1;
  const int inner = sampling == KernelSampling::brute_force ? radius : radius / 2;
  for (; r <= inner; ++r) taps.push_back({r, false, log2_weight(static_cast<float>(r))});
  for (; r < radius; r += 2) {
    const float at = static_cast<float>(r);
    const bool exact = sampling == KernelSampling::adaptive_exact_weights;
    taps.push_back({r, true, exact ? 1 + log2_weight(at + 0.5F) : log2_weight(at)});
  }
  if (r == radius) taps.push_back({r, false, log2_weight(static_cast<float>(r))});
  return taps;
}

}  // namespace aftershade::filter
