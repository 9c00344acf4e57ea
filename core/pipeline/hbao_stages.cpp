#include "core/pipeline/ao_stage.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

namespace {

Plane horizon_based(const ao::HbaoParams& params, Work& work) {
  const auto estimate = params.resolution == ao::Resolution::dual ? ao::dual_resolution_hbao : ao::hbao;
  return estimate(params, work.surface(), *work.grid, work.frame.number);
}

}  // namespace

std::unique_ptr<Stage> make_stage(const ao::HbaoParams& params) {
  return std::make_unique<AoStage<ao::HbaoParams, horizon_based>>(params);
}

}  // namespace aftershade::pipeline
