#pragma once
#include <string>
#include <vector>

/// The SIMD targets that kernels are compiled for; which one runs is chosen at run time (core/simd/lanes.h).
namespace aftershade::lanes {

/// Those that this machine can run, the best first, such as "avx512", "avx2", "sse4"; "scalar", the one-lane twin, is
/// always the last.
const std::vector<std::string>& targets();

/// Makes kernels run on one of targets() from now on, for tests and benchmarks. Throws Error(usage) for any other name.
/// Not while kernels run.
void force_target(const std::string& name);

}  // namespace aftershade::lanes
