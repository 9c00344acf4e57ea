#include <algorithm>

#include "core/base/text.h"
#include "core/pipeline/ao_stage.h"
#include "core/pipeline/named_channels.h"
#include "core/pipeline/reprojection_of.h"
#include "core/pipeline/stage.h"
#include "core/temporal/history_use.h"

namespace aftershade::pipeline {

namespace {

Plane growing_circle(const ao::GrowingCircleParams& params, Work& work) {
  const int screen_px = std::max(work.frame.display.width(), work.frame.display.height());
  return ao::growing_circle(params, work.surface(), *work.grid, screen_px, work.frame.number);
}

class TemporalBlur final : public Stage {
 public:
  explicit TemporalBlur(const temporal::TemporalBlurParams& params) : params_(params) {}

  Needs needs(const Offer& offer) const override {
    Needs needs = needs_of_value(params_.channel);
    needs.required = {Role::depth};
    needs.optional = {Role::normal};
    add_reprojection_needs(needs, offer, params_.reprojection);
    needs.lens = needs.recursive = true;
    needs.aovs = {Aov::history_weight, Aov::rejected};
    if (params_.channel.empty()) needs.aovs.insert({Aov::ao_blurred, Aov::ao_filtered});
    return needs;
  }

  void restart() override {
    history_ = {};
    depth_before_ = {};
    camera_before_.reset();
  }

  void run(Work& work) override {
    const filter::Surface& surface = work.surface();
    const temporal::Reprojected before =
        reprojection_of(work, camera_before_, params_.reprojection, params_.agreement_px);
    if (temporal::share_without_history(surface.depth, before, depth_before_, window_before_) > kCut) {
      work.note(cat("frame ", work.frame.number, " looks like a cut: the history starts anew"));
      history_ = {};
    }
    const bool on_grid = params_.channel.empty() && (!work.ao_at_pixels || work.grid->step == 1);
    const filter::SampleGrid every_pixel = on_grid ? filter::SampleGrid{} : filter::full_grid(surface);
    const filter::SampleGrid& grid = on_grid ? *work.grid : every_pixel;
    const auto give = [&](Aov aov, ConstPlaneView on_grid_texels) {
      if (work.wants(aov)) work.give(aov, filter::values_at_pixels(on_grid_texels, grid, surface));
    };
    Plane use, blurred_once;
    if (work.wants(Aov::rejected)) use = temporal::history_use(params_, grid, surface, before, history_);
    Plane filtered = temporal::temporal_blur(params_, value_of(work, params_.channel), grid, surface, before, history_,
                                             work.wants(Aov::ao_blurred) ? &blurred_once : nullptr);
    give(Aov::history_weight, history_.weight);
    if (work.wants(Aov::rejected))
      temporal::mark(use, temporal::HistoryUse::changed_value, [&](int x, int y) {
        return use(x, y) == code_of(temporal::HistoryUse::used) && !(history_.weight(x, y) > 0);
      });
    give(Aov::rejected, use);
    if (params_.channel.empty()) {
      give(Aov::ao_blurred, blurred_once);
      give(Aov::ao_filtered, filtered);
    }
    put_value(work, params_.channel, std::move(filtered));
    depth_before_ = copy_of(surface.depth);
    window_before_ = work.frame.window;
    camera_before_ = work.frame.camera;
  }

 private:
  temporal::TemporalBlurParams params_;
  temporal::TemporalBlurHistory history_;
  Plane depth_before_;  ///< at every pixel, for the cut rule
  Window window_before_;
  std::optional<Camera> camera_before_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const ao::GrowingCircleParams& params) {
  return std::make_unique<AoStage<ao::GrowingCircleParams, growing_circle>>(params);
}
std::unique_ptr<Stage> make_stage(const temporal::TemporalBlurParams& params) {
  return std::make_unique<TemporalBlur>(params);
}

}  // namespace aftershade::pipeline
