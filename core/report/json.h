#pragma once
#include <string>
#include <string_view>

#include "core/metrics/sequence_scores.h"
#include "core/params/table.h"
#include "core/report/comparison.h"

/// What the writers of reports share.
namespace aftershade::report {

/// report.json's content: see json_text().
params::Json json_of(const Comparison& comparison);

/// UTF-8 whatever the names in it are: broken sequences become U+FFFD.
std::string dumped(const params::Json& json, int indent = -1);

/// metric_infos()'s entry; for a name that is not there one that says nothing but the name.
metrics::MetricInfo info_of(std::string_view metric);

}  // namespace aftershade::report
