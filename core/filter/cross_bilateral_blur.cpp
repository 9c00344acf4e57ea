#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/filter/cross_bilateral_blur.cpp"  // this file, compiled once a SIMD target
#include "core/filter/cross_bilateral_blur.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/filter/cross_bilateral_blur_kernel.h"
#include "core/filter/cross_bilateral_taps.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::filter::HWY_NAMESPACE {

/// A pixel's value in a row of AO and its depth in the row beside it.
struct RowPair {
  const float *ao, *depth;
};

/// The taps on one side; `row_at(r)` gives the rows in which the pixels at offset r lie at the pixels' own x.
template <class RowAt>
std::vector<CrossTap> side_of(std::span<const KernelTap> kernel, int sign, RowAt&& row_at) {
  std::vector<CrossTap> taps;
  taps.reserve(kernel.size());
  for (const KernelTap& tap : kernel) {
    const RowPair one = row_at(sign * tap.first);
    const RowPair next = tap.pair ? row_at(sign * (tap.first + 1)) : RowPair{};
    taps.push_back({one.ao, one.depth, next.ao, next.depth, tap.log2_weight, tap.distance()});
  }
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

void blur_x(const CrossBilateralBlurParams& params, std::span<const KernelTap> kernel, int radius, ConstPlaneView ao,
            const SampleGrid& grid, ConstPlaneView depth, PackedAo& out) {
  const int width = depth.width;
  for_rows(depth.height, [&](int y) {
    PaddedRow value(width, radius), z(width, radius);
    PackRow pack = pack_row_at(params, ao, grid, depth, y);
    pack.ao = value.begin();
    pack.scaled_depth = z.begin();
    pack_row(pack);
    value.repeat_border(width);
    z.repeat_border(width);
    std::copy_n(z.begin(), width, out.depth.row(y));
    const auto row_at = [&](int r) { return RowPair{value.begin() + r, z.begin() + r}; };
    const auto before = side_of(kernel, -1, row_at), after = side_of(kernel, 1, row_at);
    cross_bilateral_row(
        {value.begin(), z.begin(), before, after, params.depth_slope && radius > 0, width, out.ao.row(y)});
  });
}

void blur_y(const CrossBilateralBlurParams& params, std::span<const KernelTap> kernel, int radius,
            const PackedAo& blurred_x, Plane& out) {
  const int width = out.width(), height = out.height();
  for_rows(height, [&](int y) {
    const auto row_at = [&](int r) {
      const int at = std::clamp(y + r, 0, height - 1);
      return RowPair{blurred_x.ao.row(at), blurred_x.depth.row(at)};
    };
    const auto before = side_of(kernel, -1, row_at), after = side_of(kernel, 1, row_at);
    cross_bilateral_row({blurred_x.ao.row(y), blurred_x.depth.row(y), before, after, params.depth_slope && radius > 0,
                         width, out.row(y)});
  });
}

}  // namespace aftershade::filter::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::filter {

namespace {

HWY_EXPORT(blur_x);
HWY_EXPORT(blur_y);

constexpr float kPatternReach = 4;  ///< pixels: half the 4x4 pattern of a half-resolution AO; the least radius

int radius_in_pixels(const CrossBilateralBlurParams& params, int display_height) {
  const float radius = std::max(scaled_px(params.radius_px, params.reference_height_px, display_height),
                                std::min(params.radius_px, kPatternReach));
  return static_cast<int>(std::lround(radius));
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
  const int radius = radius_in_pixels(params, display_height);
  PackedAo out{Plane::for_overwrite(depth.width, depth.height), Plane::for_overwrite(depth.width, depth.height)};
  HWY_DYNAMIC_DISPATCH(blur_x)(params, kernel_of(params.sampling, radius), radius, ao, grid, depth, out);
  return out;
}

Plane cross_bilateral_blur_y(const CrossBilateralBlurParams& params, const PackedAo& blurred_x, int display_height) {
  const int radius = radius_in_pixels(params, display_height);
  Plane out = Plane::for_overwrite(blurred_x.ao.width(), blurred_x.ao.height());
  HWY_DYNAMIC_DISPATCH(blur_y)(params, kernel_of(params.sampling, radius), radius, blurred_x, out);
  return out;
}

Plane cross_bilateral_blur(const CrossBilateralBlurParams& params, ConstPlaneView ao, const SampleGrid& grid,
                           ConstPlaneView depth, int display_height) {
  return cross_bilateral_blur_y(params, cross_bilateral_blur_x(params, ao, grid, depth, display_height),
                                display_height);
}

}  // namespace aftershade::filter
#endif
