#pragma once
#include <string_view>
#include <variant>

#include "core/ao/apply_ao.h"
#include "core/ao/growing_circle.h"
#include "core/ao/hbao.h"
#include "core/ao/reference_ao.h"
#include "core/ao/scalable_ao.h"
#include "core/ao/slice_ao.h"
#include "core/ao/sphere_kernel.h"
#include "core/filter/bilateral_blur.h"
#include "core/filter/bilateral_upsample.h"
#include "core/filter/cross_bilateral_blur.h"
#include "core/motionblur/gather_plus.h"
#include "core/motionblur/guertin2014.h"
#include "core/motionblur/mcguire2012.h"
#include "core/motionblur/reconstruct.h"
#include "core/motionblur/scalable_blur.h"
#include "core/preset/accumulative_ssao.h"
#include "core/preset/temporal_refinement.h"
#include "core/temporal/selective_temporal.h"
#include "core/temporal/temporal_blur.h"
#include "core/temporal/temporal_window.h"

namespace aftershade::preset {

/// THE list of methods. A method is added by writing its files and putting its parameter struct here (and its stage in
/// core/pipeline, which the compiler then asks for); JSON, --set, help, manual, schema and the property tests loop over
/// it.
using StageParams =
    std::variant<ao::ScalableAoParams, ao::HbaoParams, ao::SliceAoParams, ao::ReferenceAoParams, ao::SphereKernelParams,
                 ao::GrowingCircleParams, AccumulativeSsaoParams, TemporalRefinementParams, filter::BilateralBlurParams,
                 filter::BilateralUpsampleParams, filter::CrossBilateralBlurParams, temporal::SelectiveTemporalParams,
                 temporal::TemporalBlurParams, temporal::TemporalWindowParams, ao::ApplyAoParams,
                 motionblur::ScalableBlurParams, motionblur::Mcguire2012Params, motionblur::Guertin2014Params,
                 motionblur::GatherPlusParams, motionblur::ReconstructParams>;

/// Calls `visit(std::type_identity<Params>{})` for every method in the list's order.
template <class Visit>
void for_each_method(Visit&& visit) {
  [&]<size_t... I>(std::index_sequence<I...>) {
    (visit(std::type_identity<std::variant_alternative_t<I, StageParams>>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<StageParams>>{});
}

}  // namespace aftershade::preset
