#include "core/parallel/rows.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

#include <memory>

namespace aftershade {

namespace {
std::unique_ptr<tbb::global_control>& limit() {
  static std::unique_ptr<tbb::global_control> control;
  return control;
}
}  // namespace

void for_rows(int rows, const std::function<void(int)>& row) {
  if (thread_count() == 1) {
    for (int y = 0; y < rows; ++y) row(y);
    return;
  }
  tbb::parallel_for(0, rows, row);
}

void set_thread_count(int threads) {
  const size_t count = threads > 0 ? static_cast<size_t>(threads) : static_cast<size_t>(tbb::info::default_concurrency());
  limit().reset();
  limit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace aftershade
