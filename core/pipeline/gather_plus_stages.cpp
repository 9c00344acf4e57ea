#include <algorithm>
#include <cmath>

#include "core/pipeline/blur_stage.h"

namespace aftershade::pipeline {

namespace {

class GatherPlus final : public BlurStage {
 public:
  explicit GatherPlus(const motionblur::GatherPlusParams& params) : BlurStage(params), params_(params) {}

 private:
  motionblur::Shutter shutter(const BlurScene& scene) const {
    return motionblur::shutter_of(params_, scene.shutter_frames);
  }

  int reach_px(const BlurScene& scene) const override {
    const float longest = motionblur::longest_displacement_px(scene.motion(), shutter(scene), params_.path);
    const int side = std::max(scene.window.width(), scene.window.height());
    return static_cast<int>(std::ceil(std::min(longest, static_cast<float>(side))));
  }

  void blur(Work&, const BlurScene& scene, std::span<Layer* const> layers) override {
    const motionblur::GatherPlusInput input{&scene.motion(), scene.depth, scene.window, shutter(scene)};
    for (Layer* layer : layers) motionblur::gather_plus(params_, input, channels_of(*layer));
  }

  motionblur::GatherPlusParams params_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const motionblur::GatherPlusParams& params) {
  return std::make_unique<GatherPlus>(params);
}

}  // namespace aftershade::pipeline
