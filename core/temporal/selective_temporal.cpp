#include "core/temporal/selective_temporal.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "core/temporal/continuity_kernel.h"
#include "core/temporal/mask_kernel.h"
#include "core/temporal/temporal_kernel.h"

namespace aftershade::temporal {

namespace {

/// Seed 000, "History Buffers": (AO, Z) = (1, 0), N = 0.
TemporalHistory cleared_history() { return {{0, 0, 0, 0}, Plane(1, 1, 1.0F), Plane(1, 1), Plane(1, 1), {}, {}, {}}; }

void require_same_size(ConstPlaneView plane, const Window& window, const char* name) {
  if (plane.width == window.width() && plane.height == window.height()) return;
  throw Error(ErrorCode::internal, std::string("temporal filter: ") + name + " does not cover the frame's window");
}

}  // namespace

const params::Table& SelectiveTemporalParams::table() {
  using S = SelectiveTemporalParams;
  static const params::Table table =
      params::TableBuilder<S>()
          .add("epsilon", &S::epsilon, {0, 1e9},
               "Largest relative difference between expected and stored depth at which history is used; the slides' "
               "infinity is 1e9.")
          .add("distance_m", &S::distance_m, {0, 1e6},
               "Neighbours at least this far apart are discontinuous: their AO may flicker and is filtered.")
          .add("distance_footprints", &S::distance_footprints, {0, 1000},
               "Raises distance_m to this many pixel widths at the pixel's depth, so that far surfaces are not all "
               "discontinuous; 0 is the original.")
          .add("dilation_texels", &S::dilation_texels, {1, 64},
               "Side of the square, in texels of the AO's grid, in which one discontinuity makes all filtered.")
          .add("max_frames", &S::max_frames, {1, 10000},
               "Largest count of accumulated frames: with 8 a new frame weighs at least 1/9.")
          .add("selective", &S::selective,
               "Filter only near depth discontinuities; off, every pixel is filtered and moving objects leave trails.")
          .add("reprojection", &S::reprojection, {"auto", "camera"},
               "Where history is found: by the camera and, where the vectors disagree with it, by the vectors; or by "
               "the "
               "camera alone, as the talk has it.")
          .add("agreement_px", &S::agreement_px, {0, 1000},
               "Largest difference between vector and camera motion at which a pixel counts as static.")
          .add("afr_lanes", &S::afr_lanes, {1, 8},
               "Histories that frames take in turn, as graphics cards in alternate-frame rendering do; above 1, "
               "reprojection over several frames is by the camera alone.")
          .add("literal", &S::literal,
               "Do as the talk's listing is printed: store the depth in the view before, test the nearest pixel only, "
               "interpolate AO across depth edges.")
          .build();
  return table;
}

Plane continuity_mask(const SelectiveTemporalParams& params, const filter::SampleGrid& grid,
                      const filter::Surface& surface) {
  const ContinuityParams kernel{
      filter::GridSamples(grid), filter::Lens(surface.projection),
      filter::EdgeTolerance(params.distance_m, params.distance_footprints, grid.step, surface.projection)};
  Plane mask(grid.width(), grid.height());
  for_rows(mask.height(), [&](int y) { continuity_row(kernel, y, mask.row(y)); });
  return mask;
}

Plane dilate_discontinuities(ConstPlaneView mask, int n) {
  const int first = -(n / 2), last = first + n - 1;  // seed 000's 4x4: -2 to +1 (algorithms 14, item 6)
  Plane along(mask.width, mask.height), out(mask.width, mask.height);
  for_rows(mask.height, [&](int y) { least_along_row({mask.row(y), mask.width, first, last, along.row(y)}); });
  for_rows(mask.height, [&](int y) {
    least_across_rows({along, std::max(y + first, 0), std::min(y + last, mask.height - 1), out.row(y)});
  });
  return out;
}

namespace {

/// Leaves the planes of frame i in place of those of frame i-1, whose memory is kept for frame i+1.
void keep(TemporalHistory& now, TemporalHistory& history) {
  now.spare_ao = std::move(history.ao);
  now.spare_depth = std::move(history.depth);
  now.spare_count = std::move(history.count);
  history = std::move(now);
}

Plane reused(Plane& spare, const Window& window) {
  const bool fits = spare.width() == window.width() && spare.height() == window.height();
  return fits ? std::move(spare) : Plane(window.width(), window.height());
}

/// A row of the mask at every pixel.
void spread(const StabilityMask& mask, int y, int width, float* row) {
  const float* texels = mask.texels.row((y - mask.origin_y) / mask.step);
  const int shift = mask.step == 2 ? 1 : 0;
  for (int x = 0; x < width; ++x) row[x] = texels[(x - mask.origin_x) >> shift];
}

/// Where the pixels of row y were: `past(y, stable, x, y, depth)` leaves them in the three rows.
template <class Past>
Plane filtered(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
               const StabilityMask& stable_mask, Past&& past, Window window, TemporalHistory& history) {
  if (history.ao.empty()) history = cleared_history();
  const int width = window.width(), height = window.height();
  TemporalHistory now;
  now.window = window;
  now.ao = reused(history.spare_ao, window);
  now.depth = reused(history.spare_depth, window);
  now.count = reused(history.spare_count, window);
  Plane out(width, height);
  const HistoryView before{history.ao, history.depth, history.count, history.window.min_x, history.window.min_y};
  for_rows(height, [&](int y) {
    Plane row(width, 4);
    if (params.selective) spread(stable_mask, y, width, row.row(3));
    past(y, params.literal ? nullptr : row.row(3), row.row(0), row.row(1), row.row(2));
    temporal_row({ao.row(y), depth.row(y), params.selective ? row.row(3) : nullptr, row.row(0), row.row(1), row.row(2),
                  before, width, params.epsilon, static_cast<float>(params.max_frames), params.literal, out.row(y),
                  now.ao.row(y), now.depth.row(y), now.count.row(y)});
  });
  keep(now, history);
  return out;
}

void check(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth, const StabilityMask& mask,
           const Window& window) {
  require_same_size(ao, window, "ao");
  require_same_size(depth, window, "depth");
  if (params.selective && mask.step == 1) require_same_size(mask.texels, window, "stability mask");
}

}  // namespace

Plane selective_temporal_filter(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
                                const StabilityMask& stable_mask, const Reprojection& reprojection, Window window,
                                TemporalHistory& history) {
  check(params, ao, depth, stable_mask, window);
  const auto past = [&](int y, const float* stable, float* x, float* y_before, float* z) {
    reprojection.row(y, stable, x, y_before, z);
  };
  return filtered(params, ao, depth, stable_mask, past, window, history);
}

Plane selective_temporal_filter(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
                                const StabilityMask& stable_mask, const Reprojected& reprojected, Window window,
                                TemporalHistory& history) {
  check(params, ao, depth, stable_mask, window);
  require_same_size(reprojected.x, window, "reprojection");
  const auto past = [&](int y, const float*, float* x, float* y_before, float* z) {
    std::copy_n(reprojected.x.row(y), window.width(), x);
    std::copy_n(reprojected.y.row(y), window.width(), y_before);
    std::copy_n(reprojected.depth.row(y), window.width(), z);
  };
  return filtered(params, ao, depth, stable_mask, past, window, history);
}

}  // namespace aftershade::temporal
