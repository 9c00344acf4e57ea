#include <algorithm>
#include <cmath>

#include "core/motionblur/gather_plus_tiles.h"
#include "core/pipeline/blur_stage.h"

namespace aftershade::pipeline {

namespace {

class GatherPlus final : public BlurStage {
 public:
  explicit GatherPlus(const motionblur::GatherPlusParams& params) : BlurStage(params), params_(params) {}

  Needs needs(const Offer& offer) const override {
    Needs needs = BlurStage::needs(offer);
    needs.aovs = kTileAovs;
    needs.aovs.insert(Aov::guessed);
    return needs;
  }

 private:
  motionblur::Shutter shutter(const BlurScene& scene) const {
    return motionblur::shutter_of(params_, scene.shutter_frames);
  }

  int reach_px(const BlurScene& scene) const override {
    const float longest = motionblur::longest_displacement_px(scene.motion(), shutter(scene), params_.path);
    const int side = std::max(scene.window.width(), scene.window.height());
    return static_cast<int>(std::ceil(std::min(longest, static_cast<float>(side))));
  }

  void blur(Work& work, const BlurScene& scene, std::span<Layer* const> layers) override {
    const motionblur::GatherPlusInput input{&scene.motion(), scene.depth, scene.window, shutter(scene)};
    if (wants_tiles(work))
      give_tiles(work, motionblur::velocity_tiles(*input.motion, params_.path, input.shutter, input.window));
    Plane guessed;
    for (Layer* layer : layers) {
      const bool asked = work.wants(Aov::guessed) && layer->is_beauty;
      motionblur::gather_plus(params_, input, channels_of(*layer), asked ? &guessed : nullptr);
    }
    if (!guessed.empty()) work.give(Aov::guessed, std::move(guessed));
  }

  motionblur::GatherPlusParams params_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const motionblur::GatherPlusParams& params) {
  return std::make_unique<GatherPlus>(params);
}

}  // namespace aftershade::pipeline
