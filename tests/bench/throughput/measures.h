#pragma once
#include <vector>

#include "tests/bench/throughput/jobs.h"
#include "tests/bench/throughput/rows.h"

namespace aftershade::tests::throughput {

/// Every row of the table, from what the jobs took, Plan::stages() and Plan::kernels(). `packed_bytes` of one file as
/// OpenEXR wrote it.
std::vector<Row> measures(const Jobs& jobs, const params::Json& stages, const params::Json& kernels,
                          double packed_bytes);

}  // namespace aftershade::tests::throughput
