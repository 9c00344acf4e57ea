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

/// Time by the clock, and the processor's time of all threads of this process.
struct Elapsed {
  double wall_ms = 0, cpu_ms = 0;
};
inline Elapsed operator+(Elapsed a, Elapsed b) { return {a.wall_ms + b.wall_ms, a.cpu_ms + b.cpu_ms}; }

inline Elapsed elapsed(const std::function<void()>& work) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const std::clock_t cpu_start = std::clock();
  work();
  const double cpu_ms = 1e3 * static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC;
  return {std::chrono::duration<double, std::milli>(Clock::now() - start).count(), cpu_ms};
}

/// With one thread the processor's time, which others on the machine do not lengthen; with more, the wall's.
inline double milliseconds(const Elapsed& time) { return thread_count() == 1 ? time.cpu_ms : time.wall_ms; }
inline double milliseconds(const std::function<void()>& work) { return milliseconds(elapsed(work)); }

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
