#include <cmath>

#include "core/ao/ball_samples.h"
#include "core/ao/sample_validation.h"
#include "core/base/text.h"
#include "core/filter/convergence_blur.h"
#include "core/parallel/rows.h"
#include "core/pipeline/ao_stage.h"
#include "core/pipeline/reprojection_of.h"
#include "core/pipeline/stage.h"
#include "core/temporal/accumulation.h"
#include "core/temporal/history_use.h"

namespace aftershade::pipeline {

namespace {

Plane sphere(const ao::SphereKernelParams& params, Work& work) {
  const int first = params.per_frame_noise ? ao::first_of_frame(work.frame.number, params.samples) : 0;
  return ao::sphere_kernel(params, work.surface(), *work.grid, {first, params.samples, {}, {}});
}

/// A new plane of f(x, y).
template <class F>
Plane each_pixel(int width, int height, F&& f) {
  Plane out(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) out(x, y) = f(x, y);
  });
  return out;
}

/// AO at full resolution whose history is part of how it is made. `Params` is a ao::SphereSamples with `reprojection`
/// and `agreement_px`.
template <class Params>
class AccumulatingStage : public Stage {
 public:
  explicit AccumulatingStage(const Params& params) : params_(params) {}

  Needs needs(const Offer& offer) const override {
    Needs needs;
    needs.required = {Role::depth};
    (params_.normals == ao::NormalSource::file ? needs.required : needs.optional).insert(Role::normal);
    add_reprojection_needs(needs, offer, params_.reprojection);
    needs.lens = needs.makes_ao = needs.makes_ao_at_pixels = needs.recursive = true;
    needs.aovs = {Aov::ao_raw, Aov::history_age, Aov::rejected, Aov::ao_filtered};
    return needs;
  }

  void restart() override {
    history_ = {};
    camera_before_.reset();
  }

  void run(Work& work) override {
    work.choose_normals(params_.normals);
    work.grid = filter::full_grid(work.surface());
    const temporal::Reprojected before =
        reprojection_of(work, camera_before_, params_.reprojection, params_.agreement_px);
    if (looks_like_a_cut(work, before)) {
      work.note(cat("frame ", work.frame.number, " looks like a cut: the AO's history starts anew"));
      history_ = {};
    }
    refine(work, before);
    work.ao_at_pixels = true;
    camera_before_ = work.frame.camera;
    if (work.wants(Aov::history_age)) work.give(Aov::history_age, copy_of(history_.weight));
    if (work.wants(Aov::ao_filtered)) work.give(Aov::ao_filtered, copy_of(history_.ao));
  }

 protected:
  /// Makes work.ao and the new history.
  virtual void refine(Work& work, const temporal::Reprojected& before) = 0;
  bool looks_like_a_cut(Work& work, const temporal::Reprojected& before) const {
    return temporal::share_without_history(work.surface().depth, before, history_.depth, history_.window) > kCut;
  }

  Plane history_use(Work& work, const temporal::Reprojected& before, ConstPlaneView compared) const {
    return temporal::history_use(work.surface().depth, before, compared,
                                 {history_.depth, history_.window, params_.epsilon});
  }

  Params params_;
  temporal::AccumulationHistory history_;
  std::optional<Camera> camera_before_;
};

class AccumulativeSsao final : public AccumulatingStage<preset::AccumulativeSsaoParams> {
 public:
  using AccumulatingStage::AccumulatingStage;

 private:
  void refine(Work& work, const temporal::Reprojected& before) override {
    const filter::Surface& surface = work.surface();
    const auto frames_kept = static_cast<float>(params_.accumulated_frames - 1);
    const ConstPlaneView compared = params_.literal ? surface.depth : before.depth;
    temporal::Past past = temporal::look_up(history_, before, compared, params_.epsilon);
    if (work.wants(Aov::rejected)) work.give(Aov::rejected, history_use(work, before, compared));
    const auto every = [&](auto&& f) { return each_pixel(surface.depth.width, surface.depth.height, f); };
    if (params_.literal) past.weight = every([&](int x, int y) { return past.weight(x, y) > 0 ? frames_kept : 0.0F; });
    const Plane frames = every(
        [&](int x, int y) { return past.weight(x, y) > 0 ? 1.0F : static_cast<float>(params_.miss_samples_factor); });
    // A miss also takes the points that the frames before would have taken.
    const int end = ao::first_of_frame(work.frame.number, params_.samples) + params_.samples;
    const auto samples = static_cast<float>(params_.samples);
    const Plane count = every([&](int x, int y) { return frames(x, y) * samples; });
    const Plane first = every([&](int x, int y) {
      return static_cast<float>((end + 16 * ao::kSequenceLength - static_cast<int>(count(x, y))) % ao::kSequenceLength);
    });
    const Plane ao = ao::sphere_kernel(params_, surface, *work.grid, {0, 0, first, count});
    history_ = temporal::accumulate(past, {ao, frames, surface.depth, work.frame.window}, frames_kept);
    if (params_.literal_packing) temporal::pack_literally(history_, params_.packed_range_m);
    work.ao = copy_of(history_.ao);
    if (work.wants(Aov::ao_raw)) work.give(Aov::ao_raw, copy_of(ao));
  }
};

class TemporalRefinement final : public AccumulatingStage<preset::TemporalRefinementParams> {
 public:
  using AccumulatingStage::AccumulatingStage;

  Needs needs(const Offer& offer) const override {
    Needs needs = AccumulatingStage::needs(offer);
    needs.aovs.insert({Aov::confidence, Aov::ao_blurred});
    return needs;
  }

 private:
  void refine(Work& work, const temporal::Reprojected& before) override {
    const filter::Surface& surface = work.surface();
    const auto every = [&](auto&& f) { return each_pixel(surface.depth.width, surface.depth.height, f); };
    const auto enough = static_cast<float>(params_.converged_count);
    temporal::Past past = temporal::look_up(history_, before, before.depth, params_.epsilon);
    const auto samples_to_take = [&] {
      return every([&](int x, int y) {
        return static_cast<float>(past.weight(x, y) < enough ? params_.unconverged_samples : params_.samples);
      });
    };
    Plane trust;
    if (!history_.ao.empty()) {
      trust = confidence(work, past, samples_to_take(), before);
      past.weight = every([&](int x, int y) { return past.weight(x, y) * trust(x, y); });
    }
    if (work.wants(Aov::rejected)) work.give(Aov::rejected, validated_use(work, before, trust));
    if (work.wants(Aov::confidence))
      work.give(Aov::confidence, every([&](int x, int y) { return trust.empty() ? 0.0F : trust(x, y); }));
    const Plane count = samples_to_take();
    const Plane ao = ao::sphere_kernel(params_, surface, *work.grid, {0, 0, past.next, count});
    history_ = temporal::accumulate(past, {ao, count, surface.depth, work.frame.window},
                                    static_cast<float>(params_.max_count));
    history_.next = every([&](int x, int y) {
      return std::fmod(past.next(x, y) + count(x, y), static_cast<float>(ao::kSequenceLength));
    });
    const Plane convergence = every([&](int x, int y) { return std::min(history_.weight(x, y) / enough, 1.0F); });
    work.ao = filter::convergence_blur(params_.blur(), history_.ao, convergence, *work.grid, surface);
    if (work.wants(Aov::ao_blurred)) work.give(Aov::ao_blurred, copy_of(work.ao));
    if (work.wants(Aov::ao_raw)) work.give(Aov::ao_raw, copy_of(ao));
  }

  /// Rejected by the validation of samples is what loses more than half of its weight to it.
  Plane validated_use(Work& work, const temporal::Reprojected& before, const Plane& trust) const {
    Plane use = history_use(work, before, before.depth);
    temporal::mark(use, temporal::HistoryUse::changed_surroundings, [&](int x, int y) {
      return use(x, y) == code_of(temporal::HistoryUse::used) && !(trust(x, y) >= 0.5F);
    });
    return use;
  }

  /// In the AO of the frame before, as far as the next samples can tell.
  Plane confidence(Work& work, const temporal::Past& past, ConstPlaneView count,
                   const temporal::Reprojected& before) const {
    const Window& window = history_.window;
    const ao::PastSurface old{history_.depth, local_projection(*camera_before_, window.min_x, window.min_y),
                              window.min_x,   window.min_y,
                              before.x,       before.y,
                              before.depth,   params_.epsilon};
    return ao::sample_confidence(params_, params_, work.surface(), *work.grid, {0, 0, past.next, count}, old);
  }
};

}  // namespace

std::unique_ptr<Stage> make_stage(const ao::SphereKernelParams& params) {
  return std::make_unique<AoStage<ao::SphereKernelParams, sphere>>(params);
}
std::unique_ptr<Stage> make_stage(const preset::AccumulativeSsaoParams& params) {
  return std::make_unique<AccumulativeSsao>(params);
}
std::unique_ptr<Stage> make_stage(const preset::TemporalRefinementParams& params) {
  return std::make_unique<TemporalRefinement>(params);
}

}  // namespace aftershade::pipeline
