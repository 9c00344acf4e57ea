#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/gather_plus.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/gather_plus.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <span>
#include <vector>

#include "core/motionblur/gather_plus_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

/// Copies, because the result replaces the channels.
struct Records {
  Plane paths;
  std::vector<Plane> colours;  ///< one for every four channels
};

Records records_of(const GatherPlusInput& input, Path path, std::span<Plane* const> channels) {
  const int width = input.window.width(), height = input.window.height(), padded = width + Plane::kPadding;
  Records out{Plane::for_overwrite(padded * kRecordFloats, height), {}};
  for (size_t first = 0; first < channels.size(); first += 4)
    out.colours.push_back(Plane::for_overwrite(padded * kColourFloats, height));
  for_rows(height, [&](int y) {
    std::vector<const float*> rows;
    for (const Plane* channel : channels) rows.push_back(channel->row(y));
    const Motion& m = *input.motion;
    path_row({path, m.prev_x.row(y), m.prev_y.row(y), m.next_x.row(y), m.next_y.row(y),
              input.depth.data != nullptr ? input.depth.row(y) : nullptr, rows, width, out.paths.row(y)});
    for (size_t group = 0; group < out.colours.size(); ++group)
      colour_row(rows, 4 * group, width, out.colours[group].row(y));
  });
  return out;
}

void blur_rows(const GatherPlusParams& params, const GatherPlusInput& input, const TileMotions& tiles,
               std::span<Plane* const> channels, Plane* guessed) {
  const Records records = records_of(input, params.path, channels);
  GatherPlusRow row{};
  row.width = input.window.width();
  row.height = input.window.height();
  row.origin_x = input.window.min_x;
  row.origin_y = input.window.min_y;
  row.record_stride = static_cast<int>(records.paths.view().stride);
  row.records = records.paths.row(0);
  row.tiles = &tiles;
  row.opens = input.shutter.opens;
  row.exposure = input.shutter.length();
  row.taps_per_px = params.taps_per_px;
  row.least_taps = params.least_taps;
  row.most_taps = std::max(params.most_taps, params.least_taps);
  for (size_t group = 0; group < records.colours.size(); ++group) {
    row.colours = records.colours[group].row(0);
    row.colour_stride = static_cast<int>(records.colours[group].view().stride);
    row.channels = static_cast<int>(std::min<size_t>(4, channels.size() - 4 * group));
    for_rows(row.height, [&](int y) {
      GatherPlusRow of_y = row;
      of_y.y = y;
      for (int c = 0; c < row.channels; ++c) of_y.target[c] = channels[4 * group + static_cast<size_t>(c)]->row(y);
      if (guessed != nullptr && group == 0) {
        of_y.guessed = guessed->row(y);
        gather_plus_row<true>(of_y);
      } else {
        gather_plus_row<false>(of_y);
      }
    });
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
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
HWY_EXPORT(blur_rows);
}

void gather_plus(const GatherPlusParams& params, const GatherPlusInput& input, std::span<Plane* const> channels,
                 Plane* guessed) {
  if (guessed != nullptr) *guessed = Plane(input.window.width(), input.window.height());
  if (channels.empty()) return;
  const TileMotions tiles = tile_motions(*input.motion, params.path, input.shutter, input.window, params.motions);
  HWY_DYNAMIC_DISPATCH(blur_rows)(params, input, tiles, channels, guessed);
}

}  // namespace aftershade::motionblur
#endif
