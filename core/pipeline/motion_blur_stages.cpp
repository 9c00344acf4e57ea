#include <algorithm>
#include <cmath>

#include "core/pipeline/blur_stage.h"

namespace aftershade::pipeline {

namespace {

class ScalableBlur final : public BlurStage {
 public:
  explicit ScalableBlur(const motionblur::ScalableBlurParams& params) : BlurStage(params), params_(params) {}

  Needs needs(const Offer& offer) const override {
    Needs needs = BlurStage::needs(offer);
    needs.aovs = kTileAovs;
    return needs;
  }

 private:
  /// Of half-exposure velocities.
  float limit_px(const BlurScene& scene) const {
    const int limit = params_.max_radius_px > 0 ? motionblur::max_radius_px(params_, scene.display.height())
                                                : std::max(scene.window.width(), scene.window.height());
    return static_cast<float>(limit);
  }

  int reach_px(const BlurScene& scene) const override {
    const float half = 0.5F * scene.shutter_frames;
    const float longest =
        motionblur::longest_displacement_px(scene.motion(), {-half, half}, motionblur::Path::straight);
    return static_cast<int>(std::ceil(std::min(longest, limit_px(scene))));
  }

  void blur(Work& work, const BlurScene& scene, std::span<Layer* const> layers) override {
    const motionblur::HalfVelocity velocity = scene.half_velocity(limit_px(scene));
    const motionblur::GatherInput input{scene.depth, &velocity, scene.window, scene.display.height()};
    if (wants_tiles(work)) give_tiles(work, motionblur::velocity_tiles(params_, input));
    for (Layer* layer : layers) motionblur::scalable_motion_blur(params_, input, channels_of(*layer));
  }

  motionblur::ScalableBlurParams params_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const motionblur::ScalableBlurParams& params) {
  return std::make_unique<ScalableBlur>(params);
}

}  // namespace aftershade::pipeline
