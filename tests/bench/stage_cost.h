#pragma once
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/pipeline/stage.h"
#include "core/preset/preset.h"
#include "tests/bench/timing.h"

/// The cost of stages on a frame in memory.
namespace aftershade::tests {

/// What stages read and change.
inline Frame copy_of_frame(const Frame& frame) {
  Frame copy;
  copy.number = frame.number;
  copy.window = frame.window, copy.display = frame.display, copy.camera = frame.camera;
  for (size_t role = 0; role < frame.roles.size(); ++role)
    for (const Plane& plane : frame.roles[role]) copy.roles[role].push_back(copy_of(plane));
  for (const Layer& layer : frame.layers) {
    Layer& target = copy.layers.emplace_back();
    target.channels = layer.channels, target.alpha = layer.alpha, target.data_window = layer.data_window;
    target.is_beauty = layer.is_beauty, target.receives_blur = layer.receives_blur;
    target.receives_ao = layer.receives_ao;
    for (const Plane& plane : layer.planes) target.planes.push_back(copy_of(plane));
  }
  return copy;
}

using Frames = std::map<int, Frame>;

/// The stages of a preset, none of which reads what another stage sees of its neighbours, again and again on a frame in
/// the middle of a sequence.
class TimedStages {
 public:
  TimedStages(const preset::Preset& preset, const pipeline::Offer& offer) {
    for (const auto& stage : preset.stages) {
      stages_.push_back(pipeline::make_stage(stage.params));
      const pipeline::Needs needs = stages_.back()->needs(offer);
      before_ = std::max(before_, needs.frames_before), after_ = std::max(after_, needs.frames_after);
    }
  }
  int frames_before() const { return before_; }
  int frames_after() const { return after_; }

  /// Frame `number` among `frames`, as far as those are needed: what it takes to see one new frame and to run one.
  Elapsed run(const Frames& frames, int number) {
    Elapsed taken;
    for (const auto& stage : stages_) stage->restart();
    for (int f = number - before_; before_ + after_ > 0 && f <= number + after_; ++f) {
      Frame frame = copy_of_frame(frames.at(f));
      const pipeline::Work work(frame, nullptr, options_);
      taken = elapsed([&] {
        for (const auto& stage : stages_) stage->observe(work);
      });
    }
    Frame frame = copy_of_frame(frames.at(number));
    return taken + elapsed([&] {
             pipeline::Work work(frame, nullptr, options_);
             for (const auto& stage : stages_) stage->run(work);
           });
  }

 private:
  pipeline::WorkOptions options_;
  std::vector<std::unique_ptr<pipeline::Stage>> stages_;
  int before_ = 0, after_ = 0;
};

}  // namespace aftershade::tests
