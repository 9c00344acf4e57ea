#include "core/base/text.h"
#include "core/pipeline/reprojection_of.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

namespace {

class SelectiveTemporal final : public Stage {
 public:
  explicit SelectiveTemporal(const temporal::SelectiveTemporalParams& params) : params_(params) {}

  Needs needs(const Offer& offer) const override {
    Needs needs;
    needs.required = {Role::depth};
    add_reprojection_needs(needs, offer, params_.reprojection);
    needs.lens = needs.ao = needs.ao_at_pixels = needs.grid = needs.recursive = true;
    return needs;
  }

  void restart() override {
    history_ = {};
    camera_before_.reset();
  }

  void run(Work& work) override {
    const filter::Surface& surface = work.surface();
    const Plane mask = stable_mask(work, surface);
    const temporal::Reprojected before =
        reprojection_of(work, camera_before_, params_.reprojection, params_.agreement_px);
    if (temporal::share_without_history(surface.depth, before, history_.depth, history_.window) > kCut) {
      work.note(cat("frame ", work.frame.number, " looks like a cut: the AO's history starts anew"));
      history_ = {};
    }
    work.ao =
        temporal::selective_temporal_filter(params_, work.ao, surface.depth, mask, before, work.frame.window, history_);
    camera_before_ = work.frame.camera;
    if (!work.options.diagnostics) return;
    work.frame.added["aftershade.mask"] = copy_of(mask);
    work.frame.added["aftershade.count"] = copy_of(history_.count);
  }

 private:
  Plane stable_mask(Work& work, const filter::Surface& surface) const {
    if (!params_.selective) return Plane(surface.depth.width, surface.depth.height, 0.0F);
    const Plane continuous = temporal::continuity_mask(params_, *work.grid, surface);
    return filter::values_at_pixels(temporal::dilate_discontinuities(continuous, params_.dilation_texels), *work.grid,
                                    surface);
  }

  temporal::SelectiveTemporalParams params_;
  temporal::TemporalHistory history_;
  std::optional<Camera> camera_before_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const temporal::SelectiveTemporalParams& params) {
  return std::make_unique<SelectiveTemporal>(params);
}

}  // namespace aftershade::pipeline
