#include "core/filter/cross_bilateral_blur.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/filter/cross_bilateral_blur_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::filter {

namespace {

constexpr float kPatternReach = 4;  ///< pixels: half the 4x4 pattern of a half-resolution AO; the least radius

int radius_in_pixels(const CrossBilateralBlurParams& params, int display_height) {
  const float radius = std::max(scaled_px(params.radius_px, params.reference_height_px, display_height),
                                std::min(params.radius_px, kPatternReach));
  return static_cast<int>(std::lround(radius));
}

/// Taps at positive offsets (seed 000, "HLSL: Adaptive Sampling"). The listing's last pair runs past a radius that is
/// not a multiple of 4 or one less; here that is the pixel alone.
std::vector<CrossTap> taps_of(KernelSampling sampling, int radius) {
  const float sigma = static_cast<float>(radius + 1) / 2, falloff = 1 / (2 * sigma * sigma);
  const auto log2_weight = [&](float r) { return -r * r * falloff; };
  std::vector<CrossTap> taps;
  int r = 1;
  const int inner = sampling == KernelSampling::brute_force ? radius : radius / 2;
  for (; r <= inner; ++r) taps.push_back({r, r, log2_weight(static_cast<float>(r)), static_cast<float>(r)});
  for (; r < radius; r += 2) {
    const float at = static_cast<float>(r), middle = at + 0.5F;
    const bool exact = sampling == KernelSampling::adaptive_exact_weights;
    taps.push_back({r, r + 1, exact ? 1 + log2_weight(middle) : log2_weight(at), middle});
  }
  if (r == radius) taps.push_back({r, r, log2_weight(static_cast<float>(r)), static_cast<float>(r)});
  return taps;
}

/// One row with its border repeated on both sides; begin() is the first pixel.
class PaddedRow {
 public:
  PaddedRow(int width, int reach) : values_(static_cast<size_t>(width + 2 * reach + Plane::kPadding)), reach_(reach) {}
  float* begin() { return values_.data() + reach_; }
  void repeat_border(int width) {
    std::fill_n(values_.data(), reach_, begin()[0]);
    std::fill_n(begin() + width, reach_, begin()[width - 1]);
  }

 private:
  std::vector<float> values_;
  int reach_;
};

PackRow pack_row_at(const CrossBilateralBlurParams& params, ConstPlaneView ao, const SampleGrid& grid,
                    ConstPlaneView depth, int y) {
  const bool bilinear = params.ao_fetch == AoFetch::bilinear;
  const int block = (y - grid.origin_y) / grid.step;
  const float v = std::clamp((static_cast<float>(y - grid.origin_y) + 0.5F) / static_cast<float>(grid.step) - 0.5F,
                             0.0F, static_cast<float>(ao.height - 1));
  const int above = bilinear ? static_cast<int>(v) : block, below = std::min(above + 1, ao.height - 1);
  return {ao.row(above), ao.row(below), v - static_cast<float>(above), ao.width,    grid.step, grid.origin_x,
          bilinear,      depth.row(y),  params.sharpness_per_m,        depth.width, nullptr,   nullptr};
}

}  // namespace

const params::Table& CrossBilateralBlurParams::table() {
  using P = CrossBilateralBlurParams;
  static const params::Table records =
      params::TableBuilder<P>()
          .add("radius_px", &P::radius_px, {0, 64},
               "Reach of the blur to each side, in pixels of the image at the reference height; 0 switches it off.")
          .add("reference_height_px", &P::reference_height_px, {1, 65536},
               "Image height at which radius_px is meant; at other heights it scales with the height, though not below "
               "4.")
          .add("sharpness_per_m", &P::sharpness_per_m, {0, 1e6},
               "Difference in depth, as its reciprocal, at which another pixel's share has fallen to a half.")
          .add("sampling", &P::sampling, {"adaptive", "adaptive-exact-weights", "brute-force"},
               "The outer half of the kernel two pixels at a time with the weight of one, as the talk prints it; with "
               "the weight of both; or every pixel on its own.")
          .add("ao_fetch", &P::ao_fetch, {"block", "bilinear"},
               "AO of a pixel from a half-resolution grid: that of its 2x2 block, or interpolated between blocks.")
          .add("depth_slope", &P::depth_slope,
               "Compare depths with a line through the next pixel, so that slopes are blurred like walls that face the "
               "camera.")
          .build();
  return records;
}

PackedAo cross_bilateral_blur_x(const CrossBilateralBlurParams& params, ConstPlaneView ao, const SampleGrid& grid,
                                ConstPlaneView depth, int display_height) {
  const int radius = radius_in_pixels(params, display_height), width = depth.width;
  const auto taps = taps_of(params.sampling, radius);
  PackedAo out{Plane(width, depth.height), Plane(width, depth.height)};
  for_rows(depth.height, [&](int y) {
    PaddedRow value(width, radius), z(width, radius);
    PackRow pack = pack_row_at(params, ao, grid, depth, y);
    pack.ao = value.begin();
    pack.scaled_depth = z.begin();
    pack_row(pack);
    value.repeat_border(width);
    z.repeat_border(width);
    std::copy_n(z.begin(), width, out.depth.row(y));
    std::vector<const float*> ao_at, depth_at;
    for (int r = -radius; r <= radius; ++r) {
      ao_at.push_back(value.begin() + r);
      depth_at.push_back(z.begin() + r);
    }
    cross_bilateral_row({ao_at, depth_at, radius, taps, params.depth_slope && radius > 0, width, out.ao.row(y)});
  });
  return out;
}

Plane cross_bilateral_blur_y(const CrossBilateralBlurParams& params, const PackedAo& blurred_x, int display_height) {
  const int radius = radius_in_pixels(params, display_height), height = blurred_x.ao.height();
  const auto taps = taps_of(params.sampling, radius);
  Plane out(blurred_x.ao.width(), height);
  for_rows(height, [&](int y) {
    std::vector<const float*> ao_at, depth_at;
    for (int r = -radius; r <= radius; ++r) {
      const int row = std::clamp(y + r, 0, height - 1);
      ao_at.push_back(blurred_x.ao.row(row));
      depth_at.push_back(blurred_x.depth.row(row));
    }
    cross_bilateral_row({ao_at, depth_at, radius, taps, params.depth_slope && radius > 0, out.width(), out.row(y)});
  });
  return out;
}

Plane cross_bilateral_blur(const CrossBilateralBlurParams& params, ConstPlaneView ao, const SampleGrid& grid,
                           ConstPlaneView depth, int display_height) {
  return cross_bilateral_blur_y(params, cross_bilateral_blur_x(params, ao, grid, depth, display_height),
                                display_height);
}

}  // namespace aftershade::filter
