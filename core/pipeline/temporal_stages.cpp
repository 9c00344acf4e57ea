#include <vector>

#include "core/base/text.h"
#include "core/pipeline/reprojection_of.h"
#include "core/pipeline/stage.h"
#include "core/temporal/history_use.h"

namespace aftershade::pipeline {

namespace {

/// What one graphics card keeps; with a single one, frame i-1.
struct Lane {
  temporal::TemporalHistory history;
  std::optional<Camera> camera;
};

class SelectiveTemporal final : public Stage {
 public:
  explicit SelectiveTemporal(const temporal::SelectiveTemporalParams& params)
      : params_(params), lanes_(static_cast<size_t>(params.afr_lanes)) {
    if (params_.afr_lanes > 1) params_.reprojection = temporal::ReprojectionSource::camera;
  }

  Needs needs(const Offer& offer) const override {
    Needs needs;
    needs.required = {Role::depth};
    add_reprojection_needs(needs, offer, params_.reprojection);
    needs.lens = needs.ao = needs.ao_at_pixels = needs.grid = needs.recursive = true;
    needs.aovs = {Aov::mask, Aov::history_age, Aov::rejected, Aov::ao_filtered};
    return needs;
  }

  void restart() override { lanes_ = std::vector<Lane>(lanes_.size()); }

  void run(Work& work) override {
    if (params_.afr_lanes > 1)
      work.note(cat("histories of ", params_.afr_lanes,
                    " alternating frames: vectors reach back one frame only, so reprojection is by the camera"));
    Lane& lane = lane_of(work.frame.number);
    const filter::Surface& surface = work.surface();
    const Plane mask = stable_texels(*work.grid, surface);
    const ReprojectionSources sources = reprojection_sources(work, lane.camera);
    const temporal::Reprojection before(sources.input, params_.reprojection, params_.agreement_px);
    if (temporal::share_without_history(surface.depth, work.frame.window, before, lane.history.depth,
                                        lane.history.window) > kCut) {
      work.note(cat("frame ", work.frame.number, " looks like a cut: the AO's history starts anew"));
      lane.history = {};
    }
    if (work.wants(Aov::rejected)) work.give(Aov::rejected, history_use(work, sources, mask, lane.history));
    work.ao = temporal::selective_temporal_filter(params_, work.ao, surface.depth, {mask, *work.grid}, before,
                                                  work.frame.window, lane.history);
    lane.camera = work.frame.camera;
    if (work.wants(Aov::mask)) work.give(Aov::mask, filter::values_at_pixels(mask, *work.grid, surface));
    if (work.wants(Aov::history_age)) work.give(Aov::history_age, copy_of(lane.history.count));
    if (work.wants(Aov::ao_filtered)) work.give(Aov::ao_filtered, copy_of(work.ao));
  }

 private:
  Lane& lane_of(int frame) {
    const int count = params_.afr_lanes;
    return lanes_[static_cast<size_t>((frame % count + count) % count)];
  }

  /// On the AO's grid, at whatever resolution AO is by now ("Two Half-Res Passes").
  Plane stable_texels(const filter::SampleGrid& grid, const filter::Surface& surface) const {
    if (!params_.selective) return Plane(grid.width(), grid.height(), 0.0F);
    return temporal::dilate_discontinuities(temporal::continuity_mask(params_, grid, surface), params_.dilation_texels);
  }

  Plane history_use(Work& work, const ReprojectionSources& sources, ConstPlaneView mask,
                    const temporal::TemporalHistory& before) const {
    const filter::Surface& surface = work.surface();
    const temporal::Reprojected past = temporal::reproject(sources.input, params_.reprojection, params_.agreement_px);
    Plane use = temporal::history_use(surface.depth, past, past.depth,
                                      {before.depth, before.window, params_.epsilon, params_.literal});
    const Plane stable = filter::values_at_pixels(mask, *work.grid, surface);
    temporal::mark(use, temporal::HistoryUse::stable, [&](int x, int y) { return stable(x, y) >= 0.5F; });
    return use;
  }

  temporal::SelectiveTemporalParams params_;
  std::vector<Lane> lanes_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const temporal::SelectiveTemporalParams& params) {
  return std::make_unique<SelectiveTemporal>(params);
}

}  // namespace aftershade::pipeline
