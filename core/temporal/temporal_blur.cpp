#include "core/temporal/temporal_blur.h"

#include "core/base/error.h"
#include "core/parallel/rows.h"
#include "core/temporal/temporal_blur_kernel.h"

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

using namespace blur_kernel;

std::array<float, 3> tap_weights(BlurTaps taps) {
  return taps == BlurTaps::box ? std::array{1.0F, 1.0F, 1.0F} : std::array{6.0F, 4.0F, 1.0F};
}

/// Of the five taps, in texels: (4 + 1 + 0 + 1 + 4) / 5, or (4 + 4 + 0 + 4 + 4) / 16.
float tap_variance(BlurTaps taps) { return taps == BlurTaps::box ? 2.0F : 1.0F; }

Projection absolute_projection(const filter::Surface& surface) {
  Projection p = surface.projection;
  p.cx += static_cast<float>(surface.origin_x);
  p.cy += static_cast<float>(surface.origin_y);
  return p;
}

class Step {
 public:
  Step(const TemporalBlurParams& params, const filter::SampleGrid& grid, const filter::Surface& surface)
      : params_(params),
        grid_(grid),
        surface_(surface),
        texels_(texel_surface(grid, surface)),
        cut_(params.cut_m, params.cut_footprints, grid.step, surface.projection) {}

  /// B, or with `spacing` the same with taps that far apart.
  Plane blurred(ConstPlaneView value, const Plane* spacing = nullptr) const {
    const auto pass = [&](ConstPlaneView in, int dx, int dy) {
      Plane out(in.width, in.height);
      for_rows(in.height, [&](int y) {
        five_tap_row(
            {PointSamples(texels_.point), PointSamples(texels_.normal), Samples(in), dx, dy,
             tap_weights(params_.weights), cut_, params_.literal, spacing ? spacing->row(y) : nullptr, out.row(y)},
            y);
      });
      return out;
    };
    return pass(pass(value, 1, 0), 0, 1);
  }

  /// What this frame keeps, but for `value`, which is not blurred again yet.
  TemporalBlurHistory blended(ConstPlaneView value, const Reprojected& where, const TemporalBlurHistory& before) {
    const int width = grid_.width(), height = grid_.height();
    const float variance = tap_variance(params_.weights);
    TemporalBlurHistory now{grid_.step,
                            (surface_.origin_x + grid_.origin_x) / grid_.step,
                            (surface_.origin_y + grid_.origin_y) / grid_.step,
                            absolute_projection(surface_),
                            {},
                            Plane(width, height),
                            Plane(width, height, 2 * variance),
                            Plane(width, height)};
    if (before.step != grid_.step || before.value.empty()) {
      now.value = copy_of(value);
    } else {
      const HistoryView view{PointSamples(before.texels.point),
                             PointSamples(before.texels.normal),
                             Samples(before.value),
                             Samples(before.variance),
                             before.texel_x,
                             before.texel_y,
                             filter::Lens(before.projection)};
      for_rows(height, [&](int y) {
        blend_row({filter::GridSamples(grid_),
                   grid_.step,
                   grid_.origin_x,
                   grid_.origin_y,
                   Samples(where.x),
                   Samples(where.y),
                   Samples(where.depth),
                   view,
                   value.row(y),
                   cut_,
                   params_.cut_m,
                   params_.near_m,
                   std::max(params_.near_m, params_.far_m),
                   params_.history_weight,
                   params_.difference_scale,
                   params_.literal,
                   variance,
                   now.value.row(y),
                   now.variance.row(y),
                   now.weight.row(y)},
                  y);
      });
    }
    return now;
  }

  /// The value with the variance that it still lacks.
  Plane warmed(const TemporalBlurHistory& now) const {
    const float variance = tap_variance(params_.weights), a = params_.history_weight;
    const float wanted = 2 * variance + variance * a / (1 - a);  // algorithms 5.3
    Plane spacing(now.value.width(), now.value.height());
    for_rows(spacing.height(),
             [&](int y) { spacing_row(now.variance.row(y), spacing.width(), wanted, variance, spacing.row(y)); });
    return blurred(now.value, &spacing);
  }

  TexelSurface take_texels() { return std::move(texels_); }

 private:
  const TemporalBlurParams& params_;
  const filter::SampleGrid& grid_;
  const filter::Surface& surface_;
  TexelSurface texels_;
  filter::EdgeTolerance cut_;
};

void require_same_size(ConstPlaneView plane, int width, int height, const char* name) {
  if (plane.width == width && plane.height == height) return;
  throw Error(ErrorCode::internal, std::string("temporal blur: ") + name + " does not cover its pixels");
}

}  // namespace

TexelSurface texel_surface(const filter::SampleGrid& grid, const filter::Surface& surface) {
  TexelSurface out;
  for (Plane& plane : out.point) plane = Plane(grid.width(), grid.height());
  for (Plane& plane : out.normal) plane = Plane(grid.width(), grid.height());
  for_rows(grid.height(), [&](int y) {
    blur_kernel::texel_surface_row({filter::GridSamples(grid),
                                    filter::NormalSamples(surface),
                                    filter::Lens(surface.projection),
                                    {out.point[0].row(y), out.point[1].row(y), out.point[2].row(y)},
                                    {out.normal[0].row(y), out.normal[1].row(y), out.normal[2].row(y)}},
                                   y);
  });
  return out;
}

Plane temporal_blur(const TemporalBlurParams& params, ConstPlaneView value, const filter::SampleGrid& grid,
                    const filter::Surface& surface, const Reprojected& reprojected, TemporalBlurHistory& history) {
  require_same_size(value, grid.width(), grid.height(), "the value");
  require_same_size(reprojected.x, surface.depth.width, surface.depth.height, "the reprojection");
  Step step(params, grid, surface);
  TemporalBlurHistory now = step.blended(step.blurred(value), reprojected, history);
  now.value = step.blurred(now.value);
  Plane out = params.warm_start ? step.warmed(now) : copy_of(now.value);
  now.texels = step.take_texels();
  history = std::move(now);
  return out;
}

}  // namespace aftershade::temporal
