#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/temporal/temporal_blur.cpp"  // this file, compiled once a SIMD target
#include "core/temporal/temporal_blur.h"

#include <hwy/foreach_target.h>

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "core/temporal/temporal_blur_kernel.h"
#include "core/temporal/temporal_blur_step.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::temporal::HWY_NAMESPACE {

using namespace blur_kernel;

void texel_rows(const filter::SampleGrid& grid, const filter::Surface& surface, TexelSurface& out) {
  for_rows(grid.height(), [&](int y) {
    texel_surface_row({GridSamples(grid),
                       NormalSamples(surface),
                       Lens(surface.projection),
                       {out.point[0].row(y), out.point[1].row(y), out.point[2].row(y)},
                       {out.normal[0].row(y), out.normal[1].row(y), out.normal[2].row(y)}},
                      y);
  });
}

/// One pass of a blur, along x or along y; `spacing`: from tap to tap, of each texel; null: 1.
void blur_pass(const TemporalBlurStep& step, ConstPlaneView in, int dx, int dy, const Plane* spacing, Plane& out) {
  const TemporalBlurParams& params = step.params;
  const EdgeTolerance cut(params.cut_m, params.cut_footprints, step.grid.step, step.surface.projection);
  const auto weights = params.weights == BlurTaps::box ? std::array{1.0F, 1.0F, 1.0F} : std::array{6.0F, 4.0F, 1.0F};
  for_rows(in.height, [&](int y) {
    const FiveTapRow row{PointSamples(step.texels.point),
                         PointSamples(step.texels.normal),
                         Samples(in),
                         dx,
                         dy,
                         weights,
                         cut,
                         params.literal,
                         out.row(y)};
    if (spacing != nullptr)
      spaced_five_tap_row(row, spacing->row(y), y);
    else
      five_tap_row(row, y);
  });
}

void blend_rows(const TemporalBlurStep& step, ConstPlaneView value, const Reprojected& where,
                const TemporalBlurHistory& before, TemporalBlurHistory& now) {
  const TemporalBlurParams& params = step.params;
  const blur_kernel::HistoryView view{PointSamples(before.texels.point),
                                      PointSamples(before.texels.normal),
                                      Samples(before.value),
                                      Samples(before.variance),
                                      before.texel_x,
                                      before.texel_y,
                                      Lens(before.projection)};
  const EdgeTolerance cut(params.cut_m, params.cut_footprints, step.grid.step, step.surface.projection);
  for_rows(step.grid.height(), [&](int y) {
    blend_row({GridSamples(step.grid),
               step.grid.step,
               step.grid.origin_x,
               step.grid.origin_y,
               Samples(where.x),
               Samples(where.y),
               Samples(where.depth),
               view,
               value.row(y),
               cut,
               params.cut_m,
               params.near_m,
               std::max(params.near_m, params.far_m),
               params.history_weight,
               params.difference_scale,
               params.literal,
               step.tap_variance(),
               now.value.row(y),
               now.variance.row(y),
               now.weight.row(y)},
              y);
  });
}

void spacing_rows(const Plane& variance, float wanted, float blur_variance, Plane& spacing) {
  for_rows(spacing.height(),
           [&](int y) { spacing_row(variance.row(y), spacing.width(), wanted, blur_variance, spacing.row(y)); });
}

}  // namespace aftershade::temporal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::temporal {

const params::Table& TemporalBlurParams::table() {
  using P = TemporalBlurParams;
  static const params::Table table =
      params::TableBuilder<P>()
          .add("channel", &P::channel,
               "Name of a channel of the file, without its view, that is filtered at full resolution and written back; "
               "empty for the AO.")
          .add("cut_m", &P::cut_m, {1e-6, 1000},
               "Neighbours farther than this from a pixel's tangent plane are skipped by the blurs.")
          .add("cut_footprints", &P::cut_footprints, {0, 100},
               "Raises cut_m to this many texel widths at the pixel's depth, and near_m and far_m in proportion, so "
               "that "
               "far surfaces are filtered too; 0 is the original.")
          .add("weights", &P::weights, {"box", "binomial"}, "Weights of a blur's five taps: all alike, or 1 4 6 4 1.")
          .add("history_weight", &P::history_weight, {0, 0.999},
               "Weight of the frame before where it is the same surface and no different.")
          .add("near_m", &P::near_m, {0, 1000},
               "Up to this distance from what was seen there before, the surface counts as the same.")
          .add("far_m", &P::far_m, {0, 1000}, "From this distance on it is another, and its history is not used.")
          .add("difference_scale", &P::difference_scale, {0, 100},
               "How strongly a difference from the frame before lowers its weight; 0 lets moving objects leave trails.")
          .add("literal", &P::literal,
               "Compare depths instead of distances from the tangent plane; slopes are then filtered less, or not at "
               "all.")
          .add("warm_start", &P::warm_start,
               "Blur pixels with little history more, until the history has made them as smooth.")
          .add("reprojection", &P::reprojection, {"auto", "camera"},
               "Where history is found: by the camera and, where the vectors disagree with it, by the vectors; or by "
               "the camera alone.")
          .add("agreement_px", &P::agreement_px, {0, 1000},
               "Largest difference between vector and camera motion at which a pixel counts as static.")
          .build();
  return table;
}

namespace {

HWY_EXPORT(texel_rows);
HWY_EXPORT(blur_pass);
HWY_EXPORT(blend_rows);
HWY_EXPORT(spacing_rows);

Projection absolute_projection(const filter::Surface& surface) {
  Projection p = surface.projection;
  p.cx += static_cast<float>(surface.origin_x);
  p.cy += static_cast<float>(surface.origin_y);
  return p;
}

/// B, or with `spacing` the same with taps that far apart.
Plane blurred(const TemporalBlurStep& step, ConstPlaneView value, const Plane* spacing = nullptr) {
  Plane along(value.width, value.height), out(value.width, value.height);
  HWY_DYNAMIC_DISPATCH(blur_pass)(step, value, 1, 0, spacing, along);
  HWY_DYNAMIC_DISPATCH(blur_pass)(step, along, 0, 1, spacing, out);
  return out;
}

/// What this frame keeps, but for `value`, which is not blurred again yet, and the texels.
TemporalBlurHistory blended(const TemporalBlurStep& step, ConstPlaneView value, const Reprojected& where,
                            const TemporalBlurHistory& before) {
  const filter::SampleGrid& grid = step.grid;
  const int width = grid.width(), height = grid.height();
  TemporalBlurHistory now{grid.step,
                          (step.surface.origin_x + grid.origin_x) / grid.step,
                          (step.surface.origin_y + grid.origin_y) / grid.step,
                          absolute_projection(step.surface),
                          {},
                          Plane(width, height),
                          Plane(width, height, 2 * step.tap_variance()),
                          Plane(width, height)};
  if (before.step != grid.step || before.value.empty())
    now.value = copy_of(value);
  else
    HWY_DYNAMIC_DISPATCH(blend_rows)(step, value, where, before, now);
  return now;
}

/// The value with the variance that it still lacks.
Plane warmed(const TemporalBlurStep& step, const TemporalBlurHistory& now) {
  const float variance = step.tap_variance(), a = step.params.history_weight;
  const float wanted = 2 * variance + variance * a / (1 - a);  // algorithms 5.3
  Plane spacing(now.value.width(), now.value.height());
  HWY_DYNAMIC_DISPATCH(spacing_rows)(now.variance, wanted, variance, spacing);
  return blurred(step, now.value, &spacing);
}

void require_same_size(ConstPlaneView plane, int width, int height, const char* name) {
  if (plane.width == width && plane.height == height) return;
  throw Error(ErrorCode::internal, std::string("temporal blur: ") + name + " does not cover its pixels");
}

}  // namespace

TexelSurface texel_surface(const filter::SampleGrid& grid, const filter::Surface& surface) {
  TexelSurface out;
  for (Plane& plane : out.point) plane = Plane(grid.width(), grid.height());
  for (Plane& plane : out.normal) plane = Plane(grid.width(), grid.height());
  HWY_DYNAMIC_DISPATCH(texel_rows)(grid, surface, out);
  return out;
}

Plane temporal_blur(const TemporalBlurParams& params, ConstPlaneView value, const filter::SampleGrid& grid,
                    const filter::Surface& surface, const Reprojected& reprojected, TemporalBlurHistory& history,
                    Plane* blurred_once) {
  require_same_size(value, grid.width(), grid.height(), "the value");
  require_same_size(reprojected.x, surface.depth.width, surface.depth.height, "the reprojection");
  TexelSurface texels = texel_surface(grid, surface);
  const TemporalBlurStep step{params, grid, surface, texels};
  Plane first = blurred(step, value);
  TemporalBlurHistory now = blended(step, first, reprojected, history);
  if (blurred_once != nullptr) *blurred_once = std::move(first);
  now.value = blurred(step, now.value);
  Plane out = params.warm_start ? warmed(step, now) : copy_of(now.value);
  now.texels = std::move(texels);
  history = std::move(now);
  return out;
}

}  // namespace aftershade::temporal
#endif
