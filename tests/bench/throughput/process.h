#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Other programs, run and weighed.
namespace aftershade::tests::throughput {

using Command = std::vector<std::string>;  ///< a program (found in PATH) and its arguments

struct Usage {
  double wall_s = 0, cpu_s = 0;  ///< until the last ends; user and system of all
  double peak_mb = 0;            ///< resident, of the one that takes most
};

/// Runs the commands side by side; what they print goes to `log`. Throws std::runtime_error with its end when one
/// fails. An interrupt (Ctrl-C) ends them even where this program ignores it.
Usage run(const std::vector<Command>& commands, const std::filesystem::path& log);

/// One command; ten times a second `meanwhile` is called and its resident memory noted, in MB.
struct Watched {
  Usage usage;
  std::vector<double> resident_mb;
};
Watched watch(const Command& command, const std::filesystem::path& log, const std::function<void()>& meanwhile);

/// Is there such a program?
bool found_in_path(const std::string& program);

}  // namespace aftershade::tests::throughput
