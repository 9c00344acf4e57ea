#include "core/ao/reference_ao.h"
#include "core/ao/slice_ao.h"
#include "core/pipeline/ao_stage.h"

namespace aftershade::pipeline {

namespace {

ConstPlaneView second_depth(const Work& work) {
  return work.frame.has(Role::depth2) ? ConstPlaneView(work.frame.planes(Role::depth2)[0]) : ConstPlaneView();
}

Plane slice(const ao::SliceAoParams& params, Work& work) {
  return ao::slice_ao(params, work.surface(), *work.grid, work.frame.number, second_depth(work));
}

Plane reference(const ao::ReferenceAoParams& params, Work& work) {
  return ao::reference_ao(params, work.surface(), *work.grid, second_depth(work));
}

}  // namespace

std::unique_ptr<Stage> make_stage(const ao::SliceAoParams& params) {
  return std::make_unique<AoStage<ao::SliceAoParams, slice>>(params, RoleSet{Role::depth2});
}
std::unique_ptr<Stage> make_stage(const ao::ReferenceAoParams& params) {
  return std::make_unique<AoStage<ao::ReferenceAoParams, reference>>(params, RoleSet{Role::depth2});
}

}  // namespace aftershade::pipeline
