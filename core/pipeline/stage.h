#pragma once
#include <memory>

#include "core/pipeline/needs.h"
#include "core/pipeline/work.h"
#include "core/preset/methods.h"

namespace aftershade::pipeline {

/// One step of a preset at work on one view of the sequence. A stage object may keep history from frame to frame.
class Stage {
 public:
  virtual ~Stage() = default;
  virtual Needs needs(const Offer& offer) const = 0;
  /// A stage that needs frames around its own (Needs::frames_before, frames_after) is shown every frame, in order, as
  /// the stages before it leave it, and keeps what it needs: all that it can see of frame f's neighbours has been shown
  /// before run() is called for f. Frames that only serve as neighbours are never run.
  virtual void observe(const Work&) {}
  virtual void run(Work& work) = 0;
  /// Forgets the history: first frame, gap, change of the display window.
  virtual void restart() {}
};

/// One overload a method: adding a method to preset::StageParams makes the compiler ask for it here.
std::unique_ptr<Stage> make_stage(const ao::ScalableAoParams& params);
std::unique_ptr<Stage> make_stage(const ao::HbaoParams& params);
std::unique_ptr<Stage> make_stage(const ao::SliceAoParams& params);
std::unique_ptr<Stage> make_stage(const ao::ReferenceAoParams& params);
std::unique_ptr<Stage> make_stage(const ao::SphereKernelParams& params);
std::unique_ptr<Stage> make_stage(const ao::GrowingCircleParams& params);
std::unique_ptr<Stage> make_stage(const preset::AccumulativeSsaoParams& params);
std::unique_ptr<Stage> make_stage(const preset::TemporalRefinementParams& params);
std::unique_ptr<Stage> make_stage(const filter::BilateralBlurParams& params);
std::unique_ptr<Stage> make_stage(const filter::BilateralUpsampleParams& params);
std::unique_ptr<Stage> make_stage(const filter::CrossBilateralBlurParams& params);
std::unique_ptr<Stage> make_stage(const temporal::SelectiveTemporalParams& params);
std::unique_ptr<Stage> make_stage(const temporal::TemporalBlurParams& params);
std::unique_ptr<Stage> make_stage(const temporal::TemporalWindowParams& params);
std::unique_ptr<Stage> make_stage(const ao::ApplyAoParams& params);
std::unique_ptr<Stage> make_stage(const motionblur::ScalableBlurParams& params);
std::unique_ptr<Stage> make_stage(const motionblur::Mcguire2012Params& params);
std::unique_ptr<Stage> make_stage(const motionblur::Guertin2014Params& params);
std::unique_ptr<Stage> make_stage(const motionblur::GatherPlusParams& params);
std::unique_ptr<Stage> make_stage(const motionblur::ReconstructParams& params);

inline std::unique_ptr<Stage> make_stage(const preset::StageParams& params) {
  return std::visit([](const auto& p) { return make_stage(p); }, params);
}

}  // namespace aftershade::pipeline
