#include "core/filter/cross_bilateral_blur.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
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

/// A tap at positive offsets: at pixel `first`, or half way to `second`.
struct KernelTap {
  int first, second;
  float log2_weight;
  float distance() const { return static_cast<float>(first + second) * 0.5F; }
};

/// Seed 000, "HLSL: Adaptive Sampling". The listing's last pair runs past a radius that is not a multiple of 4 or one
/// less; here that is the pixel alone.
std::vector<KernelTap> kernel_of(KernelSampling sampling, int radius) {
  const float sigma = static_cast<float>(radius + 1) / 2, falloff = 1 / (2 * sigma * sigma);
  const auto log2_weight = [&](float r) { return -r * r * falloff; };
  std::vector<KernelTap> taps;
  int r = 1;
  const int inner = sampling == KernelSampling::brute_force ? radius : radius / 2;
  for (; r <= inner; ++r) taps.push_back({r, r, log2_weight(static_cast<float>(r))});
  for (; r < radius; r += 2) {
    const float at = static_cast<float>(r);
    const bool exact = sampling == KernelSampling::adaptive_exact_weights;
    taps.push_back({r, r + 1, exact ? 1 + log2_weight(at + 0.5F) : log2_weight(at)});
  }
  if (r == radius) taps.push_back({r, r, log2_weight(static_cast<float>(r))});
  return taps;
}

/// The taps on one side; `rows(a, b)` gives (AO, depth) of the pixels at offset a, or of the means between a and b.
template <class Rows>
std::vector<CrossTap> side_of(const std::vector<KernelTap>& kernel, int sign, Rows&& rows) {
  std::vector<CrossTap> taps;
  for (const KernelTap& tap : kernel) {
    const auto [ao, depth] = rows(sign * tap.first, sign * tap.second);
    taps.push_back({ao, depth, tap.log2_weight, tap.distance()});
  }
  return taps;
}

/// One row with its border repeated on both sides; begin() is the first pixel.
class PaddedRow {
 public:
  PaddedRow(int width, int reach) : values_(static_cast<size_t>(width + 2 * reach + Plane::kPadding)), reach_(reach) {}
  float* begin() { return values_.data() + reach_; }
  /// Means of each value of `row` and the next.
  void hold_pairs_of(const PaddedRow& row, int width) {
    mean_row(row.values_.data(), row.values_.data() + 1, width + 2 * reach_ - 1, values_.data());
  }
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
  const auto kernel = kernel_of(params.sampling, radius);
  PackedAo out{Plane(width, depth.height), Plane(width, depth.height)};
  for_rows(depth.height, [&](int y) {
    PaddedRow value(width, radius), z(width, radius), value_pairs(width, radius), z_pairs(width, radius);
    PackRow pack = pack_row_at(params, ao, grid, depth, y);
    pack.ao = value.begin();
    pack.scaled_depth = z.begin();
    pack_row(pack);
    value.repeat_border(width);
    z.repeat_border(width);
    value_pairs.hold_pairs_of(value, width);
    z_pairs.hold_pairs_of(z, width);
    std::copy_n(z.begin(), width, out.depth.row(y));
    const auto rows = [&](int a, int b) {
      const int left = std::min(a, b);  // where a pair is held
      return a == b ? std::pair(value.begin() + a, z.begin() + a)
                    : std::pair(value_pairs.begin() + left, z_pairs.begin() + left);
    };
    const auto before = side_of(kernel, -1, rows), after = side_of(kernel, 1, rows);
    cross_bilateral_row(
        {value.begin(), z.begin(), before, after, params.depth_slope && radius > 0, width, out.ao.row(y)});
  });
  return out;
}

Plane cross_bilateral_blur_y(const CrossBilateralBlurParams& params, const PackedAo& blurred_x, int display_height) {
  const int radius = radius_in_pixels(params, display_height);
  const int width = blurred_x.ao.width(), height = blurred_x.ao.height();
  const auto kernel = kernel_of(params.sampling, radius);
  const auto padded = static_cast<size_t>(width + Plane::kPadding);
  Plane out(width, height);
  for_rows(height, [&](int y) {
    const auto pairs = std::make_unique_for_overwrite<float[]>(4 * kernel.size() * padded);  // at most
    float* free = pairs.get();
    const auto mean_of = [&](const Plane& plane, int a, int b) -> const float* {
      if (a == b) return plane.row(a);
      mean_row(plane.row(a), plane.row(b), width, free);
      return std::exchange(free, free + padded);
    };
    const auto rows = [&](int a, int b) {
      const int row_a = std::clamp(y + a, 0, height - 1), row_b = std::clamp(y + b, 0, height - 1);
      return std::pair(mean_of(blurred_x.ao, row_a, row_b), mean_of(blurred_x.depth, row_a, row_b));
    };
    const auto before = side_of(kernel, -1, rows), after = side_of(kernel, 1, rows);
    cross_bilateral_row({blurred_x.ao.row(y), blurred_x.depth.row(y), before, after, params.depth_slope && radius > 0,
                         width, out.row(y)});
  });
  return out;
}

Plane cross_bilateral_blur(const CrossBilateralBlurParams& params, ConstPlaneView ao, const SampleGrid& grid,
                           ConstPlaneView depth, int display_height) {
  return cross_bilateral_blur_y(params, cross_bilateral_blur_x(params, ao, grid, depth, display_height),
                                display_height);
}

}  // namespace aftershade::filter
