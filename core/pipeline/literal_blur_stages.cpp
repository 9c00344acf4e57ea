#include <algorithm>
#include <cmath>

#include "core/pipeline/blur_stage.h"

namespace aftershade::pipeline {

namespace {

/// A blur of one paper, which gathers along half-exposure vectors within its radius.
template <class Params>
class LiteralBlur final : public BlurStage {
 public:
  using Blur = void (*)(const Params&, const motionblur::GatherInput&, std::span<Plane* const>);
  LiteralBlur(const Params& params, Blur method) : BlurStage(params), params_(params), method_(method) {}

  Needs needs(const Offer& offer) const override {
    Needs needs = BlurStage::needs(offer);
    needs.aovs = kTileAovs;
    return needs;
  }

 private:
  float limit_px(const BlurScene& scene) const {
    return motionblur::limit_px(params_, scene.window, scene.display.height());
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
    if (wants_tiles(work)) give_tiles(work, velocity_tiles(params_, input));
    for (Layer* layer : layers) method_(params_, input, channels_of(*layer));
  }

  Params params_;
  Blur method_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const motionblur::Mcguire2012Params& params) {
  return std::make_unique<LiteralBlur<motionblur::Mcguire2012Params>>(params, motionblur::mcguire2012_blur);
}
std::unique_ptr<Stage> make_stage(const motionblur::Guertin2014Params& params) {
  return std::make_unique<LiteralBlur<motionblur::Guertin2014Params>>(params, motionblur::guertin2014_blur);
}

}  // namespace aftershade::pipeline
