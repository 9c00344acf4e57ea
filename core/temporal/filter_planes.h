#pragma once
#include "core/temporal/history_view.h"
#include "core/temporal/selective_temporal.h"

/// What selective_temporal_filter() hands to its rows.
namespace aftershade::temporal {

struct FilterInput {
  const SelectiveTemporalParams& params;
  ConstPlaneView ao, depth;
  const StabilityMask& mask;
  HistoryView before;
};

struct FilterOutput {
  PlaneView ao, history_ao, depth, count;
};

}  // namespace aftershade::temporal
