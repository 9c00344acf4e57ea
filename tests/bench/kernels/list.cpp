#include "core/ao/apply_ao.h"
#include "core/ao/estimator.h"
#include "core/ao/hbao.h"
#include "core/ao/scalable_ao.h"
#include "core/ao/slice_ao.h"
#include "core/filter/bilateral_blur.h"
#include "core/filter/bilateral_upsample.h"
#include "core/filter/cross_bilateral_blur.h"
#include "core/filter/normals.h"
#include "core/motionblur/gather.h"
#include "core/motionblur/gather_plus.h"
#include "core/motionblur/scalable_blur.h"
#include "core/motionblur/tile_max.h"
#include "core/preset/preset.h"
#include "tests/bench/kernels/kernels.h"

namespace aftershade::tests::kernels {

namespace {

constexpr int kLimit_px = 18;

/// Short enough that most taps of the strip stay inside it.
constexpr float kRadius_m = 0.1F;

void add_ao(std::vector<Kernel>& list, Inputs& in) {
  ao::ScalableAoParams scalable;
  scalable.radius_m = kRadius_m;
  list.push_back(
      {"scalable-ao", true, [&in, scalable] { ao::scalable_ao(scalable, in.surface, in.pyramid, in.grid, 0); }});
  auto slices = std::get<ao::SliceAoParams>(preset::load_preset("slices").preset.stages.at(0).params);
  slices.radius_m = kRadius_m;
  list.push_back({"slice-ao, 18 taps", true,
                  [&in, slices] { ao::slice_ao(slices, in.surface, filter::full_grid(in.surface), 0); }});
  list.push_back(
      {"normals from depth", false, [&in] { filter::normals_from_depth(in.surface.depth, in.surface.projection); }});
  list.push_back({"half_grid", false, [&in] { filter::half_grid(in.surface); }});
  list.push_back({"depth pyramid", false, [&in] {
                    filter::DepthPyramid(in.surface.depth, filter::kDepthLevels, in.surface.origin_x, in.surface.origin_y);
                  }});
}

void add_filters(std::vector<Kernel>& list, Inputs& in) {
  list.push_back({"bilateral-blur, half resolution", false,
                  [&in] { filter::bilateral_blur({}, in.half_ao, in.grid, in.surface); }});
  filter::BilateralBlurParams denoise;
  denoise.radius_px = 1;
  list.push_back({"bilateral-blur, 3x3", false, [&in, denoise] {
                    filter::bilateral_blur(denoise, in.ao, filter::full_grid(in.surface), in.surface);
                  }});
  list.push_back(
      {"bilateral-upsample", false, [&in] { filter::bilateral_upsample({}, in.half_ao, in.grid, in.surface); }});
  list.push_back({"cross-bilateral-blur", false, [&in] {
                    filter::cross_bilateral_blur({}, in.half_ao, in.grid, in.surface.depth, in.surface.display_height);
                  }});
  list.push_back({"apply-ao", false, [&in] { ao::apply_ao({}, in.ao, in.frame); }});
}

void add_temporal(std::vector<Kernel>& list, Inputs& in) {
  using temporal::Reprojection, temporal::ReprojectionSource;
  const temporal::SelectiveTemporalParams params;
  list.push_back({"continuity mask", false, [&in, params] { temporal::continuity_mask(params, in.grid, in.surface); }});
  list.push_back({"reprojection", false, [&in, params] {
                    temporal::reproject(in.before, ReprojectionSource::automatic, params.agreement_px);
                  }});
  const auto mask = std::make_shared<Plane>(in.grid.width(), in.grid.height(), 0.0F);
  list.push_back({"selective temporal filter", true, [&in, params, mask] {
                    const Reprojection before(in.before, ReprojectionSource::automatic, params.agreement_px);
                    temporal::selective_temporal_filter(params, in.ao, in.surface.depth, {*mask, in.grid}, before,
                                                        in.frame.window, in.history);
                  }});
}

void add_motion_blur(std::vector<Kernel>& list, Inputs& in) {
  list.push_back({"half velocity", false, [&in] { motionblur::half_velocity(in.motion, 0.5F, kLimit_px); }});
  list.push_back({"longest displacement", false, [&in] {
                    motionblur::longest_displacement_px(in.motion, {-0.25F, 0.25F}, motionblur::Path::straight);
                  }});
  list.push_back({"tile maximum", false, [&in] { motionblur::tile_max(in.velocity, kLimit_px, in.frame.window); }});
  const auto channels = [&in] {
    std::vector<Plane*> planes;
    for (Plane& plane : in.frame.layers.at(0).planes) planes.push_back(&plane);
    return planes;
  };
  list.push_back({"scalable-motion-blur", true, [&in, channels] {
                    const motionblur::GatherInput input{in.surface.depth, &in.velocity, in.frame.window,
                                                        in.surface.display_height};
                    motionblur::scalable_motion_blur({}, input, channels());
                  }});
  list.push_back(
      {"gather-plus", true, [&in, channels] {
         motionblur::gather_plus({}, {&in.motion, in.surface.depth, in.frame.window, {-0.25F, 0.25F}}, channels());
       }});
}

}  // namespace

std::vector<Kernel> all_kernels(Inputs& inputs) {
  std::vector<Kernel> list;
  add_ao(list, inputs);
  add_filters(list, inputs);
  add_temporal(list, inputs);
  add_motion_blur(list, inputs);
  return list;
}

}  // namespace aftershade::tests::kernels
