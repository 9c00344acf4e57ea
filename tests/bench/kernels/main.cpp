// Every hot kernel on every SIMD target against its one-lane twin: the same source for one lane, without
// auto-vectorisation. One thread, planes that stay in the processor's own cache, targets in turn. See ../README.md.
//   bench_kernels [--smoke] [--json FILE] [--repetitions N] [--kernels TEXT]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "core/parallel/rows.h"
#include "core/params/table.h"
#include "core/simd/targets.h"
#include "tests/bench/kernels/kernels.h"
#include "tests/bench/timing.h"

namespace {

using namespace aftershade;
using tests::kernels::Kernel;

struct Options {
  int repetitions = 15;
  double turn_ms = 4;  ///< a turn of one target lasts at least so long
  std::string json_file, only;
};

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--smoke") {
      options.repetitions = 1, options.turn_ms = 0;
      continue;
    }
    const std::string value = ++i < argc ? argv[i] : "";
    if (name == "--json") options.json_file = value;
    if (name == "--kernels") options.only = value;
    if (name == "--repetitions") options.repetitions = std::atoi(value.c_str());
    const bool known = name == "--json" || name == "--kernels" || name == "--repetitions";
    if (known && !value.empty() && options.repetitions > 0) continue;
    std::fprintf(stderr, "usage: bench_kernels [--smoke] [--json FILE] [--repetitions N] [--kernels TEXT]\n");
    return false;
  }
  return true;
}

/// Calls after which at least `least_ms` have passed.
int calls_for(const Kernel& kernel, double least_ms) {
  int calls = 1;
  for (; calls < 1 << 20; calls *= 2)
    if (tests::elapsed([&] {
          for (int i = 0; i < calls; ++i) kernel.run();
        }).cpu_ms >= least_ms)
      break;
  return calls;
}

/// Processor time of one pixel, turn by turn.
using Turns = std::map<std::string, std::vector<double>>;  // by target

Turns measure(const Kernel& kernel, const Options& options) {
  std::map<std::string, int> calls;
  for (const std::string& target : lanes::targets()) {
    lanes::force_target(target);
    calls[target] = calls_for(kernel, options.turn_ms);  // and warms up
  }
  Turns turns;
  for (int turn = 0; turn < options.repetitions; ++turn)
    for (const std::string& target : lanes::targets()) {
      lanes::force_target(target);
      const double ms = tests::elapsed([&] {
                          for (int i = 0; i < calls[target]; ++i) kernel.run();
                        }).cpu_ms;
      turns[target].push_back(1e6 * ms / calls[target] / tests::kernels::kPixels);
    }
  return turns;
}

double median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (size_t i = 0; i < a.size(); ++i)
    if (b[i] > 0) ratios.push_back(a[i] / b[i]);
  return ratios.empty() ? 0 : tests::median(ratios);
}

params::Json row_of(const Kernel& kernel, const Turns& turns) {
  const std::string twin = lanes::targets().back();
  params::Json times, ratios;
  for (const auto& [target, values] : turns) {
    times[target] = tests::median(values);
    if (target != twin) ratios[target] = median_ratio(turns.at(twin), values);
  }
  return {{"kernel", kernel.name}, {"gathers", kernel.gathers}, {"ns_per_pixel", times}, {"ratios", ratios}};
}

void print_heading(const std::vector<std::string>& targets) {
  std::printf("  %-32s %12s", "", "one lane");
  for (auto target = targets.rbegin() + 1; target != targets.rend(); ++target) std::printf(" %18s", target->c_str());
  std::printf("\n");
}

/// Narrow targets first; a ratio that misses its goal is marked.
void print_row(const params::Json& row, const std::vector<std::string>& targets) {
  const std::map<std::string, double> goals{{"avx512", 5}, {"avx2", 3.5}};
  std::printf("  %-32s %9.3f ns", row.at("kernel").get<std::string>().c_str(),
              row.at("ns_per_pixel").at(targets.back()).get<double>());
  for (auto target = targets.rbegin() + 1; target != targets.rend(); ++target) {
    const double ratio = row.at("ratios").at(*target);
    const auto goal = goals.find(*target);
    const bool missed = !row.at("gathers").get<bool>() && goal != goals.end() && ratio < goal->second;
    std::printf(" %7.3f ns %5.2f %c", row.at("ns_per_pixel").at(*target).get<double>(), ratio, missed ? '!' : ' ');
  }
  std::printf("\n");
}

void print(const params::Json& rows) {
  const std::vector<std::string>& targets = lanes::targets();
  for (const bool gathers : {false, true}) {
    std::printf("\n%s\n", gathers ? "bound by gathering (no goal)"
                                  : "time of one pixel, and one lane's over it (goals: avx512 5, avx2 3.5; ! missed)");
    print_heading(targets);
    for (const params::Json& row : rows)
      if (row.at("gathers") == gathers) print_row(row, targets);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!parse(argc, argv, options)) return 64;
  set_thread_count(1);
  tests::kernels::Inputs inputs;
  params::Json rows = params::Json::array();
  for (const Kernel& kernel : all_kernels(inputs))
    if (kernel.name.find(options.only) != std::string::npos) rows.push_back(row_of(kernel, measure(kernel, options)));
  std::printf("planes of %dx%d pixels, one thread, medians of %d turns\n", tests::kernels::kWidth,
              tests::kernels::kHeight, options.repetitions);
  print(rows);
  const params::Json json{{"targets", lanes::targets()}, {"kernels", rows}};
  if (!options.json_file.empty()) std::ofstream(options.json_file) << json.dump(2) << "\n";
}
