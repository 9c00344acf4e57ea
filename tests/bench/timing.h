#pragma once
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "core/parallel/rows.h"
#include "core/params/table.h"

/// What the benchmarks of cost share.
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

/// --smoke, --json FILE, --size WIDTHxHEIGHT, --repetitions N.
struct CostOptions {
  int width = 1920, height = 1080, repetitions = 7;
  std::string json_file;
};
/// False, after saying how: the arguments are wrong.
inline bool parse(int argc, char** argv, CostOptions& options) {
  bool understood = true;
  for (int i = 1; i < argc && understood; ++i) {
    const std::string argument = argv[i];
    if (argument == "--smoke") {
      options.width = 96, options.height = 54, options.repetitions = 1;
      continue;
    }
    const std::string value = ++i < argc ? argv[i] : "";
    if (argument == "--json") {
      options.json_file = value;
    } else if (argument == "--repetitions") {
      options.repetitions = std::max(std::atoi(value.c_str()), 1);
    } else {
      understood = argument == "--size" && std::sscanf(value.c_str(), "%dx%d", &options.width, &options.height) == 2;
    }
    understood = understood && !value.empty() && options.width > 0 && options.height > 0;
  }
  if (!understood)
    std::fprintf(stderr, "usage: %s [--smoke] [--json FILE] [--size WIDTHxHEIGHT] [--repetitions N]\n", argv[0]);
  return understood;
}

/// Measures with one thread and with all there are, and writes the JSON of both where that is wanted.
inline void with_one_and_all_threads(const CostOptions& options, const std::function<params::Json()>& measure) {
  params::Json runs = params::Json::array();
  const int all_threads = thread_count();
  for (const int threads : {1, all_threads}) {
    if (threads == 1 && !runs.empty()) break;
    set_thread_count(threads);
    std::printf("\n%d thread%s\n", threads, threads == 1 ? "" : "s");
    params::Json run{{"threads", threads}};
    run.update(measure());
    runs.push_back(std::move(run));
  }
  if (!options.json_file.empty()) std::ofstream(options.json_file) << runs.dump(2) << "\n";
}

}  // namespace aftershade::tests
