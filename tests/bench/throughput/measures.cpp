#include "tests/bench/throughput/measures.h"

#include <algorithm>

#include "core/base/text.h"
#include "tests/bench/throughput/plan.h"
#include "tests/bench/throughput/stages.h"

namespace aftershade::tests::throughput {

namespace {

class Table {
 public:
  explicit Table(const Jobs& jobs) : jobs_(jobs) {}

  void add(Row row) { rows.push_back(std::move(row)); }
  /// Time per frame of one job over another's.
  void add_ratio(const std::string& measure, const char* a, const char* b, Goal goal, const std::string& note = "") {
    const char* missing = !jobs_.has(a) ? a : !jobs_.has(b) ? b : nullptr;
    if (missing) return add({measure, "", {}, {}, goal, cat("not available: ", missing)});
    const Ratio r = ratio(jobs_.at(a), jobs_.at(b));
    add({measure, "", r.wall, r.cpu, goal, note});
  }
  void add_peak(const std::string& measure, const char* job, Goal goal) {
    if (!jobs_.has(job)) return;
    add({measure, "MB", jobs_.at(job).peak_mb(), {}, goal});
  }

  std::vector<Row> rows;

 private:
  const Jobs& jobs_;
};

void add_jobs(Table& table) {
  table.add_ratio("whole job (high-dx11) against the copy", kWhole, kCopy, at_most(0.48));
  table.add_ratio("whole job against one oiiotool process", kWhole, kOneCopy, at_most(0.33));
  table.add_ratio("--recode against the copy", kRecode, kCopy, at_most(0.28));
  table.add_ratio("whole job against --recode", kWhole, kRecode, at_most(1.8));
}

void add_comparison(Table& table) {
  table.add_ratio("compare of six presets, frames written, against six jobs", kCompareWritten, kSixJobs, at_most(0.9));
  table.add_ratio("compare of six presets, no frames, against six jobs", kCompareAlone, kSixJobs, at_most(0.45));
}

void add_sizes(Table& table, const Jobs& jobs, double packed_bytes) {
  const std::string measure = "output size of --recode against OpenEXR's own ZIP";
  if (!jobs.has(kRecode)) return table.add({measure, "", {}, {}, at_most(1), cat("not available: ", kRecode)});
  table.add({measure,
             "",
             jobs.at(kRecode).packed_bytes / packed_bytes,
             {},
             at_most(1),
             cat("oiiotool's: ", fixed(jobs.at(kCopy).packed_bytes / packed_bytes, 4))});
}

/// The least ratio of the kernels that do not gather.
void add_kernels(Table& table, const params::Json& kernels) {
  for (const auto& [target, goal] : {std::pair{"avx512", 5.0}, std::pair{"avx2", 3.5}}) {
    Row row{cat("hot kernels, least of ", target, " over one lane"), "", {}, {}, at_least(goal), {}};
    for (const params::Json& kernel : kernels.at("kernels")) {
      if (kernel.at("gathers").get<bool>() || !kernel.at("ratios").contains(target)) continue;
      const double value = kernel.at("ratios").at(target).get<double>();
      if (row.value && *row.value <= value) continue;
      row.value = value;
      row.note = cat(kernel.at("kernel").get<std::string>(), "; all: bench_kernels");
    }
    if (!row.value) row.note = "this machine has no such target";
    table.add(row);
  }
}

void add_threads_and_sizes(Table& table, const Jobs& jobs) {
  const Ratio threads = ratio(jobs.at(kHalves), jobs.at(kWhole));
  table.add({"one two-thread job against the throughput of two of one thread", "", threads.wall, threads.cpu,
             at_least(0.93)});
  table.add_ratio("4K against 1080p, whole job", kLarge, kSmall, at_most(4.2),
                  cat(jobs.at(kLarge).frames, " frames each, links to fewer"));
}

void add_memory(Table& table, const Jobs& jobs) {
  table.add_peak("peak memory of high-dx11, 1080p", kWhole, at_most(700));
  table.add_peak("peak memory of high-dx11, 4K", kLarge, at_most(2500));
  if (jobs.has(kMemory)) {
    const Record& many = jobs.at(kMemory);
    table.add_peak(cat("peak memory of high-dx11, 1080p, ", many.frames, " frames"), kMemory, at_most(700));
    table.add({"their last third's memory over the middle third's",
               "",
               many.growth(),
               {},
               at_most(1.05),
               many.growth() ? "" : "too short a run"});
  }
  table.add_peak("peak memory of offline, 1080p", kOffline, {});
}

/// The steady time of a frame: what each further frame adds to a job of one.
void add_start(Table& table, const Jobs& jobs) {
  const Record &one = jobs.at(kOneFrame), &whole = jobs.at(kWhole);
  const double steady_s = (whole.wall_s() - one.wall_s()) / (whole.frames - 1),
               steady_cpu_s = (whole.cpu_s() - one.cpu_s()) / (whole.frames - 1);
  const Record& version = jobs.at(kVersion);
  table.add({"start-up (--version)",
             "ms",
             1e3 * version.wall_s(),
             {},
             at_most(20),
             cat("CPU ", fixed(1e3 * version.cpu_s(), 1), " ms")});
  Row row{"a job of one frame against the steady time of a frame", "", {}, {}, at_most(1.5)};
  row.note = cat(fixed(1e3 * one.wall_s(), 0), " ms; steady ", fixed(1e3 * steady_s, 0), " ms");
  if (steady_s > 0) row.value = one.wall_s() / steady_s;
  if (steady_cpu_s > 0) row.by_cpu = one.cpu_s() / steady_cpu_s;
  table.add(row);
}

/// The stage in memory against the copy's time per frame; the goal holds for `target` (empty: for the best).
void add_stage(Table& table, const Jobs& jobs, const params::Json& stages, const char* stage, Goal goal,
               const std::string& target = "") {
  const std::string best = stages.at(0).at("target");
  for (const params::Json& row : stages) {
    if (row.at("stage") != stage) continue;
    const std::string on = row.at("target");
    const double wall = row.at("wall_ms"), cpu = row.at("cpu_ms");
    table.add({cat(stage, " against the copy, ", on), "", wall / jobs.at(kCopy).wall_ms_per_frame(),
               cpu / jobs.at(kCopy).cpu_ms_per_frame(), on == (target.empty() ? best : target) ? goal : Goal{},
               cat(fixed(wall, 1), " ms, CPU ", fixed(cpu, 1), " ms")});
  }
}

}  // namespace

std::vector<Row> measures(const Jobs& jobs, const params::Json& stages, const params::Json& kernels,
                          double packed_bytes) {
  Table table(jobs);
  add_jobs(table);
  add_comparison(table);
  add_sizes(table, jobs, packed_bytes);
  add_kernels(table, kernels);
  add_threads_and_sizes(table, jobs);
  add_memory(table, jobs);
  add_start(table, jobs);
  add_stage(table, jobs, stages, kBlurDx11, at_most(0.09));
  add_stage(table, jobs, stages, kBlurGatherPlus, at_most(1.3));
  add_stage(table, jobs, stages, kSliceAo, at_most(0.08), "avx512");
  table.add_ratio("job of dx11's motion blur alone against the copy", kBlurJob, kCopy, {}, "with reading and writing");
  table.add_ratio("job of gather-plus alone against the copy", kGatherPlusJob, kCopy, {}, "with reading and writing");
  table.add_ratio("fsync on against off, memory file system", kWhole, kNoFsync, {});
  if (jobs.has(kDisk)) table.add_ratio("fsync on against off, disk", kDisk, kDiskNoFsync, {});
  return std::move(table.rows);
}

}  // namespace aftershade::tests::throughput
