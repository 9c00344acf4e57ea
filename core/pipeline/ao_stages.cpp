#include "core/pipeline/ao_stage.h"
#include "core/pipeline/named_channels.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

namespace {

Plane scalable(const ao::ScalableAoParams& params, Work& work) {
  return ao::scalable_ao(params, work.surface(), work.pyramid(), *work.grid, work.frame.number);
}

class BilateralBlur final : public Stage {
 public:
  explicit BilateralBlur(const filter::BilateralBlurParams& params) : params_(params) {}

  Needs needs(const Offer&) const override {
    Needs needs = needs_of_value(params_.channel);
    needs.required = {Role::depth};
    needs.optional = {Role::normal};
    needs.lens = true;
    if (params_.channel.empty()) needs.aovs = {Aov::ao_blurred};
    return needs;
  }

  void run(Work& work) override {
    const filter::Surface& surface = work.surface();
    const ConstPlaneView value = value_of(work, params_.channel);
    const bool on_grid = params_.channel.empty() && (!work.ao_at_pixels || work.grid->step == 1);
    put_value(work, params_.channel,
              on_grid ? filter::bilateral_blur(params_, value, *work.grid, surface)
                      : filter::bilateral_blur(params_, value, filter::full_grid(surface), surface));
    if (params_.channel.empty() && work.wants(Aov::ao_blurred)) work.give(Aov::ao_blurred, ao_at_pixels(work));
  }

 private:
  filter::BilateralBlurParams params_;
};

class BilateralUpsample final : public Stage {
 public:
  explicit BilateralUpsample(const filter::BilateralUpsampleParams& params) : params_(params) {}

  Needs needs(const Offer&) const override {
    Needs needs;
    needs.required = {Role::depth};
    needs.optional = {Role::normal};
    needs.lens = needs.ao = needs.grid = needs.makes_ao_at_pixels = true;
    needs.aovs = {Aov::ao_upsampled};
    return needs;
  }

  void run(Work& work) override {
    if (!work.ao_at_pixels) work.ao = filter::bilateral_upsample(params_, work.ao, *work.grid, work.surface());
    work.ao_at_pixels = true;
    if (work.wants(Aov::ao_upsampled)) work.give(Aov::ao_upsampled, copy_of(work.ao));
  }

 private:
  filter::BilateralUpsampleParams params_;
};

class ApplyAo final : public Stage {
 public:
  explicit ApplyAo(const ao::ApplyAoParams& params) : params_(params) {}

  Needs needs(const Offer&) const override {
    Needs needs;
    if (params_.target == ao::ApplyTarget::ambient) needs.required = {Role::ambient};
    if (params_.target == ao::ApplyTarget::automatic) needs.optional = {Role::ambient};
    if (params_.baked != ao::BakedAo::ignore) needs.required.insert(Role::ao);
    needs.ao = needs.ao_at_pixels = needs.layers = true;
    return needs;
  }

  void run(Work& work) override {
    const bool ambient = ao::resolved_target(params_, work.frame) == ao::ApplyTarget::ambient;
    if (params_.target == ao::ApplyTarget::automatic)
      work.note(ambient ? "AO is applied to the ambient light only (the file has it)"
                        : "AO is applied to everything (no ambient light channel was found)");
    ao::apply_ao(params_, work.ao, work.frame);
    for (Layer& layer : work.frame.layers)
      layer.changed = layer.changed || (layer.receives_ao && params_.target != ao::ApplyTarget::none);
  }

 private:
  ao::ApplyAoParams params_;
};

}  // namespace

std::unique_ptr<Stage> make_stage(const ao::ScalableAoParams& params) {
  return std::make_unique<AoStage<ao::ScalableAoParams, scalable>>(params);
}
std::unique_ptr<Stage> make_stage(const filter::BilateralBlurParams& params) {
  return std::make_unique<BilateralBlur>(params);
}
std::unique_ptr<Stage> make_stage(const filter::BilateralUpsampleParams& params) {
  return std::make_unique<BilateralUpsample>(params);
}
std::unique_ptr<Stage> make_stage(const ao::ApplyAoParams& params) { return std::make_unique<ApplyAo>(params); }

}  // namespace aftershade::pipeline
