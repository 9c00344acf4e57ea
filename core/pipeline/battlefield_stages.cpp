#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

namespace {

class CrossBilateralBlur final : public Stage {
 public:
  explicit CrossBilateralBlur(const filter::CrossBilateralBlurParams& params) : params_(params) {}

  Needs needs(const Offer&) const override {
    Needs needs;
    needs.required = {Role::depth};
    needs.ao = needs.grid = needs.makes_ao_at_pixels = true;
    needs.aovs = {Aov::ao_blurred};
    return needs;
  }

  void run(Work& work) override {
    const filter::SampleGrid every_pixel;
    work.ao = filter::cross_bilateral_blur(params_, work.ao, work.ao_at_pixels ? every_pixel : *work.grid,
                                           work.frame.depth(), work.frame.display.height());
    work.ao_at_pixels = true;
    if (work.wants(Aov::ao_blurred)) work.give(Aov::ao_blurred, copy_of(work.ao));
  }

 private:
  filter::CrossBilateralBlurParams params_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const filter::CrossBilateralBlurParams& params) {
  return std::make_unique<CrossBilateralBlur>(params);
}

}  // namespace aftershade::pipeline
