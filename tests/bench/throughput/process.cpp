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

/// Waits for one and adds what it took; its status as wait gives it.
int wait_for(pid_t process, Usage& usage, const std::function<void()>& meanwhile) {
  int status = 0;
  struct rusage taken {};
  while (true) {
    const pid_t ended = ::wait4(process, &status, meanwhile ? WNOHANG : 0, &taken);
    if (ended == process) break;
    if (ended < 0 && errno != EINTR) throw std::runtime_error(cat("wait4: ", std::strerror(errno)));
    if (!meanwhile) continue;
    meanwhile();
    ::usleep(100000);
  }
  usage.cpu_s += seconds(taken.ru_utime) + seconds(taken.ru_stime);
  usage.peak_mb = std::max(usage.peak_mb, static_cast<double>(taken.ru_maxrss) / 1024);
  return status;
}

}  // namespace

Usage run(const std::vector<Command>& commands, const fs::path& log, const std::function<void()>& meanwhile) {
  using Clock = std::chrono::steady_clock;
  fs::remove(log);
  const Clock::time_point begin = Clock::now();
  std::vector<pid_t> processes;
  for (const Command& command : commands) processes.push_back(start(command, log));
  Usage usage;
  std::vector<int> statuses;
  for (const pid_t process : processes) statuses.push_back(wait_for(process, usage, meanwhile));
  usage.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
  for (size_t i = 0; i < commands.size(); ++i) {
    if (WIFSIGNALED(statuses[i])) fail(commands[i], cat("ended by signal ", WTERMSIG(statuses[i])), log);
    if (WEXITSTATUS(statuses[i]) != 0) fail(commands[i], cat("exit status ", WEXITSTATUS(statuses[i])), log);
  }
  return usage;
}

bool found_in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  if (!path) return false;
  const std::vector<std::string> folders = split(path, ':');
  return std::ranges::any_of(
      folders, [&](const std::string& folder) { return ::access((fs::path(folder) / program).c_str(), X_OK) == 0; });
}

}  // namespace aftershade::tests::throughput
