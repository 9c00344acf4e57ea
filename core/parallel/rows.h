#pragma once
#include <functional>

namespace aftershade {

/// Calls `row(y)` for every y in [0, rows), spread over the threads. Rows must not depend on each other, so the result
/// does not depend on the number of threads. An exception from a row is rethrown here.
void for_rows(int rows, const std::function<void(int)>& row);

/// Limits all work of this process to `threads` (>= 1) from now on; 0 means what the machine and its cgroup allow.
void set_thread_count(int threads);
/// The number of threads that for_rows uses.
int thread_count();

}  // namespace aftershade
