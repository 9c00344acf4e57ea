#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/throughput/process.h"

/// Jobs on whole sequences, each of one or more processes side by side.
namespace aftershade::tests::throughput {

struct Job {
  std::string name;
  std::vector<Command> commands;
  std::filesystem::path out;              ///< folder for what they write, emptied before and after; empty: none
  int frames = 1;                         ///< that all commands work on together
  std::function<void()> check = nullptr;  ///< of the first run's files; throws when they are wrong
  std::optional<int> files{};             ///< that they write; as many as frames by default
};

/// Times of a job, run after run.
class Record {
 public:
  int frames = 1;
  std::vector<Usage> runs;
  double packed_bytes = 0;          ///< of one written file, in the mean
  std::vector<double> resident_mb;  ///< ten times a second, of a job that was watched

  double wall_s() const;  ///< medians
  double cpu_s() const;
  double wall_ms_per_frame() const { return 1e3 * wall_s() / frames; }
  double cpu_ms_per_frame() const { return 1e3 * cpu_s() / frames; }
  double peak_mb() const;  ///< of all runs
  /// Resident memory in the last third of a watched run over that in the middle third; nothing if it was too short.
  std::optional<double> growth() const;
};

/// A ratio of two jobs that took turns, time per frame: the median over the turns.
struct Ratio {
  double wall, cpu;
};
Ratio ratio(const Record& a, const Record& b);

/// Runs jobs and keeps what they took, by name.
class Jobs {
 public:
  explicit Jobs(std::filesystem::path folder) : log_(folder / "log.txt") {}

  /// Every job in turn, `repetitions` times. Throws when one fails or writes another number of files.
  void run(const std::vector<Job>& jobs, int repetitions);
  /// Once, watched, a job of one command; files that are done are removed while it runs, so that it needs little room.
  void run_and_drop_files(const Job& job);

  bool has(const std::string& name) const { return records_.contains(name); }
  const Record& at(const std::string& name) const { return records_.at(name); }
  const std::map<std::string, Record>& all() const { return records_; }

 private:
  void run_once(const Job& job);
  Record& prepare(const Job& job);

  std::filesystem::path log_;
  std::map<std::string, Record> records_;
};

}  // namespace aftershade::tests::throughput
