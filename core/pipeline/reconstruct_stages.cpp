#include <algorithm>
#include <cmath>
#include <deque>

#include "core/pipeline/blur_stage.h"

namespace aftershade::pipeline {

namespace {

/// What a neighbour needs to keep of a frame: what its motion is made of, its depth, camera and layers.
Frame kept(const Frame& frame) {
  Frame copy;
  copy.number = frame.number;
  copy.window = frame.window;
  copy.display = frame.display;
  copy.camera = frame.camera;
  for (const Role role : {Role::depth, Role::velocity_prev, Role::velocity_next})
    if (frame.has(role))
      for (const Plane& plane : frame.planes(role)) copy.planes(role).push_back(copy_of(plane));
  for (const Layer& layer : frame.layers) {
    if (!layer.receives_blur) continue;
    copy.layers.emplace_back();
    copy.layers.back().name = layer.name;
    for (const Plane& plane : layer.planes) copy.layers.back().planes.push_back(copy_of(plane));
  }
  for (const auto& [name, plane] : frame.named) copy.named[name] = copy_of(plane);
  for (const auto& [name, plane] : frame.added)
    if (copy.named.contains(name)) copy.added[name] = copy_of(plane);
  return copy;
}

class Reconstruct final : public BlurStage {
 public:
  explicit Reconstruct(const motionblur::ReconstructParams& params) : BlurStage(params), params_(params) {}

  Needs needs(const Offer& offer) const override {
    Needs needs = BlurStage::needs(offer);
    needs.frames_before = std::max(needs.frames_before, params_.neighbours);
    needs.frames_after = std::max(needs.frames_after, params_.neighbours);
    needs.aovs = {Aov::guessed};
    return needs;
  }

  void restart() override {
    BlurStage::restart();
    frames_.clear();
  }

  void observe(const Work& work) override {
    BlurStage::observe(work);
    frames_.push_back(kept(work.frame));
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
    const int number = work.frame.number;
    while (!frames_.empty() && frames_.front().number < number - params_.neighbours) frames_.pop_front();
    std::deque<motionblur::Motion> motions;
    std::vector<const Frame*> neighbours;
    for (const Frame& frame : frames_) {
      const int away = std::abs(frame.number - number);
      if (away == 0 || away > params_.neighbours) continue;
      motions.push_back(motion_of(frame));
      neighbours.push_back(&frame);
    }
    for (Layer* layer : layers) {
      std::vector<motionblur::SequenceFrame> sequence{
          {number, scene.window, work.frame.camera, scene.depth, &scene.motion(), {}, layer->alpha}};
      for (const Plane& plane : layer->planes) sequence.front().channels.push_back(plane);
      for (size_t i = 0; i < neighbours.size(); ++i) add_neighbour(*neighbours[i], motions[i], *layer, sequence);
      motionblur::Reconstruction result = motionblur::reconstruct(params_, sequence, shutter(scene));
      layer->planes = std::move(result.channels);
      if (work.wants(Aov::guessed) && layer->is_beauty) work.give(Aov::guessed, std::move(result.guessed));
    }
  }

  /// A neighbour without such a layer shows nothing of it.
  static void add_neighbour(const Frame& frame, const motionblur::Motion& motion, const Layer& layer,
                            std::vector<motionblur::SequenceFrame>& sequence) {
    const auto same = std::find_if(frame.layers.begin(), frame.layers.end(),
                                   [&](const Layer& other) { return other.name == layer.name; });
    if (same == frame.layers.end() || same->planes.size() != layer.planes.size()) return;
    const ConstPlaneView depth = frame.has(Role::depth) ? ConstPlaneView(frame.depth()) : ConstPlaneView();
    sequence.push_back({frame.number, frame.window, frame.camera, depth, &motion, {}, layer.alpha});
    for (const Plane& plane : same->planes) sequence.back().channels.push_back(plane);
  }

  motionblur::ReconstructParams params_;
  std::deque<Frame> frames_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const motionblur::ReconstructParams& params) {
  return std::make_unique<Reconstruct>(params);
}

}  // namespace aftershade::pipeline
