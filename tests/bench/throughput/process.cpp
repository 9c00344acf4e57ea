#include "tests/bench/throughput/process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "core/base/text.h"

namespace aftershade::tests::throughput {

namespace fs = std::filesystem;

namespace {

std::string last_lines(const fs::path& log) {
  constexpr size_t kLongest = 2000;
  std::ifstream file(log);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return text.size() > kLongest ? text.substr(text.size() - kLongest) : text;
}

[[noreturn]] void fail(const Command& command, const std::string& how, const fs::path& log) {
  throw std::runtime_error(cat(join(command, " "), ": ", how, "\n", last_lines(log)));
}

pid_t start(const Command& command, const fs::path& log) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  sigset_t interrupt;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigdefault(&attributes, &interrupt);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> arguments;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) fail(command, std::strerror(error), log);
  return process;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Adds what the process took once it has ended; its status as wait gives it. With WNOHANG nothing while it runs.
std::optional<int> wait_for(pid_t process, Usage& usage, int options) {
  int status = 0;
  struct rusage taken {};
  pid_t ended = 0;
  do ended = ::wait4(process, &status, options, &taken);
  while (ended < 0 && errno == EINTR);
  if (ended < 0) throw std::runtime_error(cat("wait4: ", std::strerror(errno)));
  if (ended == 0) return std::nullopt;
  usage.cpu_s += seconds(taken.ru_utime) + seconds(taken.ru_stime);
  usage.peak_mb = std::max(usage.peak_mb, static_cast<double>(taken.ru_maxrss) * 1024 / 1e6);
  return status;
}

void check_status(const Command& command, int status, const fs::path& log) {
  if (WIFSIGNALED(status)) fail(command, cat("ended by signal ", WTERMSIG(status)), log);
  if (WEXITSTATUS(status) != 0) fail(command, cat("exit status ", WEXITSTATUS(status)), log);
}

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// 0 when the process is gone.
double resident_mb(pid_t process) {
  std::ifstream file(cat("/proc/", int64_t{process}, "/statm"));
  double all = 0, resident = 0;  // pages
  file >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

}  // namespace

Usage run(const std::vector<Command>& commands, const fs::path& log) {
  fs::remove(log);
  const Clock::time_point begin = Clock::now();
  std::vector<pid_t> processes;
  for (const Command& command : commands) processes.push_back(start(command, log));
  Usage usage;
  std::vector<int> statuses;
  for (const pid_t process : processes) statuses.push_back(wait_for(process, usage, 0).value());
  usage.wall_s = seconds_since(begin);
  for (size_t i = 0; i < commands.size(); ++i) check_status(commands[i], statuses[i], log);
  return usage;
}

Watched watch(const Command& command, const fs::path& log, const std::function<void()>& meanwhile) {
  fs::remove(log);
  const Clock::time_point begin = Clock::now();
  const pid_t process = start(command, log);
  Watched watched;
  std::optional<int> status;
  while (!(status = wait_for(process, watched.usage, WNOHANG))) {
    if (const double mb = resident_mb(process); mb > 0) watched.resident_mb.push_back(mb);
    meanwhile();
    ::usleep(100000);
  }
  watched.usage.wall_s = seconds_since(begin);
  check_status(command, *status, log);
  return watched;
}

bool found_in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  if (!path) return false;
  const std::vector<std::string> folders = split(path, ':');
  return std::ranges::any_of(
      folders, [&](const std::string& folder) { return ::access((fs::path(folder) / program).c_str(), X_OK) == 0; });
}

}  // namespace aftershade::tests::throughput
