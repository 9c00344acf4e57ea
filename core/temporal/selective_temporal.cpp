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
TemporalHistory cleared_history() { return {{0, 0, 0, 0}, Plane(1, 1, 1.0F), Plane(1, 1), Plane(1, 1)}; }

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

Plane selective_temporal_filter(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
                                ConstPlaneView stable_mask, const Reprojected& reprojected, Window window,
                                TemporalHistory& history) {
  require_same_size(ao, window, "ao");
  require_same_size(depth, window, "depth");
  require_same_size(reprojected.x, window, "reprojection");
  if (params.selective) require_same_size(stable_mask, window, "stability mask");
  if (history.ao.empty()) history = cleared_history();
  const int width = window.width(), height = window.height();
  TemporalHistory now{window, Plane(width, height), Plane(width, height), Plane(width, height)};
  const HistoryView before{history.ao, history.depth, history.count, history.window.min_x, history.window.min_y};
  for_rows(height, [&](int y) {
    temporal_row({ao.row(y), depth.row(y), params.selective ? stable_mask.row(y) : nullptr, reprojected.x.row(y),
                  reprojected.y.row(y), reprojected.depth.row(y), before, width, params.epsilon,
                  static_cast<float>(params.max_frames), now.ao.row(y), now.depth.row(y), now.count.row(y)});
  });
  history = std::move(now);
  return copy_of(history.ao);
}

}  // namespace aftershade::temporal
