#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/temporal/selective_temporal.cpp"  // this file, compiled once a SIMD target
#include "core/temporal/selective_temporal.h"

#include <hwy/foreach_target.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "core/temporal/continuity_kernel.h"
#include "core/temporal/filter_planes.h"
#include "core/temporal/mask_kernel.h"
#include "core/temporal/reprojection_kernel.h"
#include "core/temporal/temporal_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

Plane continuity(const SelectiveTemporalParams& params, const filter::SampleGrid& grid,
                 const filter::Surface& surface) {
  const ContinuityParams kernel{
      GridSamples(grid), Lens(surface.projection),
      EdgeTolerance(params.distance_m, params.distance_footprints, grid.step, surface.projection)};
  Plane mask = Plane::for_overwrite(grid.width(), grid.height());
  for_rows(mask.height(), [&](int y) { continuity_row(kernel, y, mask.row(y)); });
  return mask;
}

Plane least_around(ConstPlaneView mask, int n) {
  const int first = -(n / 2), last = first + n - 1;  // seed 000's 4x4: -2 to +1 (algorithms 14, item 6)
  Plane along = Plane::for_overwrite(mask.width, mask.height), out = Plane::for_overwrite(mask.width, mask.height);
  for_rows(mask.height, [&](int y) { least_along_row({mask.row(y), mask.width, first, last, along.row(y)}); });
  for_rows(mask.height, [&](int y) {
    least_across_rows({along, std::max(y + first, 0), std::min(y + last, mask.height - 1), out.row(y)});
  });
  return out;
}

StableRow stable_row(const StabilityMask& mask, int y) {
  return {mask.texels.row((y - mask.origin_y) / mask.step), mask.step == 2 ? 1 : 0, mask.origin_x};
}

/// `past_of(y)`: what temporal_row() takes as the past of row y.
template <class PastOf>
void filter_rows(const FilterInput& in, const FilterOutput& to, const PastOf& past_of) {
  const SelectiveTemporalParams& params = in.params;
  for_rows(in.ao.height, [&](int y) {
    const StableRow stable = params.selective ? stable_row(in.mask, y) : StableRow{};
    temporal_row({in.ao.row(y), in.depth.row(y), stable, in.before, in.ao.width, params.epsilon,
                  static_cast<float>(params.max_frames), params.literal, to.ao.row(y), to.history_ao.row(y),
                  to.depth.row(y), to.count.row(y)},
                 past_of(y));
  });
}

void filter_along_rows(const FilterInput& in, const FilterOutput& to, const Reprojection& reprojection) {
  filter_rows(in, to, [&](int y) { return [row = reprojection.row(y)](int x) { return past_at(row, x); }; });
}

void filter_along_planes(const FilterInput& in, const FilterOutput& to, const Reprojected& past) {
  filter_rows(in, to, [&](int y) {
    return [x_before = past.x.row(y), y_before = past.y.row(y), depth = past.depth.row(y)](int x) {
      return Point{load(x_before + x), load(y_before + x), load(depth + x)};
    };
  });
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::temporal {

namespace {

HWY_EXPORT(continuity);
HWY_EXPORT(least_around);
HWY_EXPORT(filter_along_rows);
HWY_EXPORT(filter_along_planes);

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
  return HWY_DYNAMIC_DISPATCH(continuity)(params, grid, surface);
}

Plane dilate_discontinuities(ConstPlaneView mask, int n) { return HWY_DYNAMIC_DISPATCH(least_around)(mask, n); }

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
  return fits ? std::move(spare) : Plane::for_overwrite(window.width(), window.height());
}

void check(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth, const StabilityMask& mask,
           const Window& window) {
  require_same_size(ao, window, "ao");
  require_same_size(depth, window, "depth");
  if (params.selective && mask.step == 1) require_same_size(mask.texels, window, "stability mask");
}

/// `along`: one of the exported functions, bound to the past.
template <class Along>
Plane filtered(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
               const StabilityMask& stable_mask, Window window, TemporalHistory& history, const Along& along) {
  check(params, ao, depth, stable_mask, window);
  if (history.ao.empty()) history = cleared_history();
  TemporalHistory now;
  now.window = window;
  now.ao = reused(history.spare_ao, window);
  now.depth = reused(history.spare_depth, window);
  now.count = reused(history.spare_count, window);
  Plane out = Plane::for_overwrite(window.width(), window.height());
  along({params,
         ao,
         depth,
         stable_mask,
         {history.ao, history.depth, history.count, history.window.min_x, history.window.min_y}},
        {out, now.ao, now.depth, now.count});
  keep(now, history);
  return out;
}

}  // namespace

Plane selective_temporal_filter(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
                                const StabilityMask& stable_mask, const Reprojection& reprojection, Window window,
                                TemporalHistory& history) {
  return filtered(params, ao, depth, stable_mask, window, history, [&](const FilterInput& in, const FilterOutput& to) {
    HWY_DYNAMIC_DISPATCH(filter_along_rows)(in, to, reprojection);
  });
}

Plane selective_temporal_filter(const SelectiveTemporalParams& params, ConstPlaneView ao, ConstPlaneView depth,
                                const StabilityMask& stable_mask, const Reprojected& reprojected, Window window,
                                TemporalHistory& history) {
  require_same_size(reprojected.x, window, "reprojection");
  return filtered(params, ao, depth, stable_mask, window, history, [&](const FilterInput& in, const FilterOutput& to) {
    HWY_DYNAMIC_DISPATCH(filter_along_planes)(in, to, reprojected);
  });
}

}  // namespace aftershade::temporal
#endif
