#include "core/base/text.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

namespace {

/// Share of a picture without a past that makes it a cut (algorithms 13).
constexpr double kCut = 0.6;

class SelectiveTemporal final : public Stage {
 public:
  explicit SelectiveTemporal(const temporal::SelectiveTemporalParams& params) : params_(params) {}

  Needs needs(const Offer& offer) const override {
    Needs needs;
    needs.required = {Role::depth};
    if (params_.reprojection == temporal::ReprojectionSource::automatic) {
      needs.optional = {Role::velocity_prev};
      if (!offer.roles.contains(Role::velocity_prev) && offer.roles.contains(Role::velocity_next))
        needs.previous = {Role::velocity_next, Role::depth};
      if (!offer.position) needs.any_of = {Role::velocity_prev, Role::velocity_next};
    }
    needs.position = params_.reprojection == temporal::ReprojectionSource::camera;
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
    const temporal::Reprojected before = reprojected(work);
    if (temporal::share_without_history(surface.depth, before, history_) > kCut) {
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

  temporal::Reprojected reprojected(Work& work) const {
    temporal::ReprojectionInput input;
    input.depth = work.frame.depth();
    input.window = work.frame.window;
    if (camera_before_) input.camera = CameraReprojection::create(*work.frame.camera, *camera_before_);
    if (!work.frame.camera->world_to_camera)
      work.note("no camera matrices: reprojection follows the vectors alone, and the depth test uses the stored depth");
    temporal::VelocityPlanes scattered;
    if (work.frame.has(Role::velocity_prev)) {
      input.mv_prev_x = work.frame.planes(Role::velocity_prev)[0];
      input.mv_prev_y = work.frame.planes(Role::velocity_prev)[1];
    } else if (work.previous && work.previous->has(Role::velocity_next)) {
      const auto& next = work.previous->planes(Role::velocity_next);
      scattered = temporal::scatter_velocity(next[0], next[1], work.previous->depth(), work.previous->window,
                                             work.frame.window);
      input.holes_are_invalid = true;
      input.mv_prev_x = scattered.x;
      input.mv_prev_y = scattered.y;
      work.note("no backward vectors: those of the frame before are carried forward");
    }
    return temporal::reproject(input, params_.reprojection, params_.agreement_px);
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
