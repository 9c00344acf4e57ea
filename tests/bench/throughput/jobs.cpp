#include "tests/bench/throughput/jobs.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "core/base/text.h"
#include "tests/bench/timing.h"

namespace aftershade::tests::throughput {

namespace fs = std::filesystem;

namespace {

template <class Value>
double median_of(const std::vector<Usage>& runs, Value&& value) {
  std::vector<double> values;
  for (const Usage& usage : runs) values.push_back(value(usage));
  return median(values);
}

void empty_folder(const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
}

/// Also in folders within.
std::vector<fs::path> finished_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".exr") files.push_back(entry.path());
  return files;
}

}  // namespace

double Record::wall_s() const {
  return median_of(runs, [](const Usage& usage) { return usage.wall_s; });
}
double Record::cpu_s() const {
  return median_of(runs, [](const Usage& usage) { return usage.cpu_s; });
}
double Record::peak_mb() const {
  return std::ranges::max(runs, {}, [](const Usage& usage) { return usage.peak_mb; }).peak_mb;
}

std::optional<double> Record::growth() const {
  constexpr size_t kLeast = 30;
  if (resident_mb.size() < kLeast) return std::nullopt;
  const auto third = static_cast<std::ptrdiff_t>(resident_mb.size() / 3);
  const double last = std::accumulate(resident_mb.end() - third, resident_mb.end(), 0.0);
  return last / std::accumulate(resident_mb.end() - 2 * third, resident_mb.end() - third, 0.0);
}

Ratio ratio(const Record& a, const Record& b) {
  std::vector<double> wall, cpu;
  const double frames = static_cast<double>(b.frames) / a.frames;
  for (size_t i = 0; i < std::min(a.runs.size(), b.runs.size()); ++i) {
    wall.push_back(frames * a.runs[i].wall_s / b.runs[i].wall_s);
    cpu.push_back(frames * a.runs[i].cpu_s / b.runs[i].cpu_s);
  }
  return {median(wall), median(cpu)};
}

Record& Jobs::prepare(const Job& job) {
  if (::isatty(STDERR_FILENO)) std::fprintf(stderr, "%s\n", job.name.c_str());
  if (!job.out.empty()) empty_folder(job.out);
  Record& record = records_[job.name];
  record.frames = job.frames;
  return record;
}

void Jobs::run_once(const Job& job) {
  Record& record = prepare(job);
  record.runs.push_back(throughput::run(job.commands, log_));
  if (job.out.empty()) return;
  const std::vector<fs::path> files = finished_files(job.out);
  const int expected = job.files.value_or(job.frames);
  if (files.size() != static_cast<size_t>(expected))
    throw std::runtime_error(cat(job.name, ": ", files.size(), " files instead of ", expected));
  double bytes = 0;
  for (const fs::path& file : files) bytes += static_cast<double>(fs::file_size(file));
  if (!files.empty()) record.packed_bytes = bytes / static_cast<double>(files.size());
}

void Jobs::run(const std::vector<Job>& jobs, int repetitions) {
  for (int i = 0; i < repetitions; ++i)
    for (const Job& job : jobs) {
      run_once(job);
      if (job.check && i == 0) job.check();
      if (!job.out.empty()) fs::remove_all(job.out);
    }
}

void Jobs::run_and_drop_files(const Job& job) {
  int dropped = 0;
  const auto drop = [&] {
    for (const fs::path& file : finished_files(job.out)) dropped += fs::remove(file) ? 1 : 0;
  };
  Record& record = prepare(job);
  Watched watched = watch(job.commands.at(0), log_, drop);
  record.runs.push_back(watched.usage);
  record.resident_mb = std::move(watched.resident_mb);
  drop();
  fs::remove_all(job.out);
  if (dropped != job.frames) throw std::runtime_error(cat(job.name, ": ", dropped, " files instead of ", job.frames));
}

}  // namespace aftershade::tests::throughput
