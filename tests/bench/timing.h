#pragma once
#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <vector>

#include "core/parallel/rows.h"

namespace aftershade::tests {

/// With one thread the processor's time, which others on the machine do not lengthen; with more, the wall's.
inline double now_ms() {
  using std::chrono::steady_clock;
  if (thread_count() == 1) return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  return std::chrono::duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}
inline double milliseconds(const std::function<void()>& work) {
  const double start = now_ms();
  work();
  return now_ms() - start;
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
}

}  // namespace aftershade::tests
