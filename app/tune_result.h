#pragma once
#include <optional>
#include <string>

#include "app/tune_job.h"
#include "core/tune/measure.h"

/// What aftershade tune found, and how it is written and told.
namespace aftershade::app {

struct TuneResult {
  tune::CostTable table;
  tune::Found found;
  /// Of the start and of the best, measured in the end; none after a signal.
  std::optional<tune::Measured> start_cost, best_cost;
  std::optional<double> start_holdout, best_holdout;  ///< scores of the frames that were held out
};

/// The preset with the best values; its description says from what and with which score it was tuned.
preset::Preset tuned_preset(const TuneArgs& args, const TuneJob& job, const TuneResult& result);

/// Everything about the search: the front, the costs it was based on, what was measured.
params::Json front_json(const TuneArgs& args, const TuneJob& job, const TuneResult& result);

/// A table for people.
std::string summary_of(const TuneJob& job, const TuneResult& result);

}  // namespace aftershade::app
