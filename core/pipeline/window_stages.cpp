#include <deque>

#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

namespace {

temporal::VelocityPlanes vectors_of(const Frame& frame, Role role) {
  if (!frame.has(role)) return {};
  return {copy_of(frame.planes(role)[0]), copy_of(frame.planes(role)[1])};
}

class TemporalWindow final : public Stage {
 public:
  explicit TemporalWindow(const temporal::TemporalWindowParams& params) : params_(params) {}

  Needs needs(const Offer& offer) const override {
    Needs needs;
    needs.required = {Role::depth};
    needs.optional = {Role::normal, Role::velocity_prev, Role::velocity_next};
    if (!offer.position) needs.any_of = {Role::velocity_prev, Role::velocity_next};
    needs.lens = needs.ao = needs.ao_at_pixels = needs.grid = true;
    needs.frames_before = needs.frames_after = params_.frames;
    needs.aovs = {Aov::ao_filtered, Aov::window_weight};
    return needs;
  }

  void restart() override { frames_.clear(); }

  void observe(const Work& work) override {
    const Frame& frame = work.frame;
    temporal::WindowFrame kept;
    kept.number = frame.number;
    kept.window = frame.window;
    kept.camera = frame.camera.value();
    kept.ao = copy_of(work.ao);
    kept.depth = copy_of(frame.depth());
    filter::Normals normals;
    if (frame.has(Role::normal))
      for (size_t i = 0; i < 3; ++i) normals[i] = copy_of(frame.planes(Role::normal)[i]);
    else
      normals =
          filter::normals_from_depth(kept.depth, local_projection(kept.camera, frame.window.min_x, frame.window.min_y));
    kept.nx = std::move(normals[0]);
    kept.ny = std::move(normals[1]);
    kept.nz = std::move(normals[2]);
    kept.mv_prev = vectors_of(frame, Role::velocity_prev);
    kept.mv_next = vectors_of(frame, Role::velocity_next);
    frames_.push_back(std::move(kept));
  }

  void run(Work& work) override {
    if (params_.frames == 0) return;  // a window of the frame alone: nothing was observed
    const int number = work.frame.number;
    while (frames_.front().number < number - params_.frames) frames_.pop_front();
    std::vector<const temporal::WindowFrame*> window;
    size_t centre = 0;
    for (const temporal::WindowFrame& frame : frames_) {
      if (frame.number == number) centre = window.size();
      window.push_back(&frame);
    }
    temporal::WindowedAo filtered = temporal::temporal_window(params_, window, centre);
    work.ao = std::move(filtered.ao);
    if (work.wants(Aov::ao_filtered)) work.give(Aov::ao_filtered, copy_of(work.ao));
    if (work.wants(Aov::window_weight)) work.give(Aov::window_weight, std::move(filtered.weight));
  }

 private:
  temporal::TemporalWindowParams params_;
  std::deque<temporal::WindowFrame> frames_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const temporal::TemporalWindowParams& params) {
  return std::make_unique<TemporalWindow>(params);
}

}  // namespace aftershade::pipeline
