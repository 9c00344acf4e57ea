#include "core/motionblur/gather_plus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/motionblur/gather_plus_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

const params::Table& GatherPlusParams::table() {
  using P = GatherPlusParams;
  static const params::Table table = [] {
    params::TableBuilder<P> builder;
    return add_path(builder)
        .add("taps_per_px", &P::taps_per_px, {0.25, 16},
             "Times of the exposure looked at, per pixel of the longest motion nearby: more give a smoother blur.")
        .add("least_taps", &P::least_taps, {1, 4096}, "Times looked at where the motion is short.")
        .add("most_taps", &P::most_taps, {1, 4096}, "Times looked at where the motion is long; not below least_taps.")
        .add("motions", &P::motions, {1, 16},
             "Different motions that are searched along at each pixel, beside its own, where so many meet.")
        .build();
  }();
  return table;
}

namespace {

/// Values from here on stand for "infinite": sums of differences of smaller ones fit a float.
constexpr float kInfinite = 1e30F;

Plane records_of(const GatherPlusInput& input, Path path, std::span<const Plane> colours) {
  const int width = input.window.width(), height = input.window.height();
  Plane records(width * kRecordFloats, height);
  for_rows(height, [&](int y) {
    float* record = records.row(y);
    for (int x = 0; x < width; ++x, record += kRecordFloats) {
      const PathCoefficients p = path_coefficients(*input.motion, path, x, y);
      const float depth = input.depth.data != nullptr ? input.depth(x, y) : kInfinite;
      const bool usable =
          std::ranges::all_of(colours, [&](const Plane& colour) { return std::abs(colour(x, y)) < kInfinite; });
      const float values[kRecordFloats] = {p.before_x,
                                           p.before_y,
                                           p.after_x,
                                           p.after_y,
                                           p.bend_x,
                                           p.bend_y,
                                           depth > 0 && depth < kInfinite ? depth : kInfinite,
                                           usable ? 1.0F : 0.0F};
      std::copy(values, values + kRecordFloats, record);
    }
  });
  return records;
}

}  // namespace

void gather_plus(const GatherPlusParams& params, const GatherPlusInput& input, std::span<Plane* const> channels) {
  if (channels.empty()) return;
  const TileMotions tiles = tile_motions(*input.motion, params.path, input.shutter, input.window, params.motions);
  std::vector<Plane> source;
  for (const Plane* channel : channels) source.push_back(copy_of(*channel));
  const Plane records = records_of(input, params.path, source);
  GatherPlusKernel kernel{};
  kernel.width = input.window.width();
  kernel.height = input.window.height();
  kernel.origin_x = input.window.min_x;
  kernel.origin_y = input.window.min_y;
  kernel.record_stride = static_cast<int>(records.view().stride);
  kernel.records = records.row(0);
  kernel.channel_stride = static_cast<int>(source[0].view().stride);
  kernel.tiles = &tiles;
  kernel.opens = input.shutter.opens;
  kernel.exposure = input.shutter.length();
  kernel.taps_per_px = params.taps_per_px;
  kernel.least_taps = params.least_taps;
  kernel.most_taps = std::max(params.most_taps, params.least_taps);
  constexpr auto kGroup = static_cast<size_t>(GatherPlusKernel::kChannels);
  for (size_t first = 0; first < channels.size(); first += kGroup) {
    const size_t count = std::min(kGroup, channels.size() - first);
    kernel.channels = static_cast<int>(count);
    for (size_t c = 0; c < count; ++c) kernel.source[c] = source[first + c].row(0);
    for_rows(kernel.height, [&](int y) {
      std::array<float*, kGroup> target{};
      for (size_t c = 0; c < count; ++c) target[c] = channels[first + c]->row(y);
      gather_plus_row(kernel, y, target.data());
    });
  }
}

}  // namespace aftershade::motionblur
