#include "core/base/memory_limit.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/base/text.h"

namespace aftershade {

namespace {

std::optional<int64_t> lesser(std::optional<int64_t> a, std::optional<int64_t> b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

/// "MemTotal:       24576000 kB"
std::optional<int64_t> machine_memory(const std::string& root) {
  std::ifstream file(root + "/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    int64_t kilobytes = 0;
    if (words >> key >> kilobytes && key == "MemTotal:") return kilobytes << 10;
  }
  return std::nullopt;
}

/// A file that holds a number of bytes; "max" and a missing file are no limit.
std::optional<int64_t> limit_in(const std::string& path) {
  std::ifstream file(path);
  int64_t bytes = 0;
  if (file >> bytes && bytes > 0) return bytes;
  return std::nullopt;
}

/// The limit of a group and of all that it lies in; inside a container the host's path may not be there.
std::optional<int64_t> tightest(const std::string& mount, std::string group, const std::string& name) {
  std::optional<int64_t> limit;
  while (true) {
    limit = lesser(limit, limit_in(mount + group + "/" + name));
    const size_t slash = group.rfind('/');
    if (slash == std::string::npos) return limit;
    group.resize(slash);
  }
}

/// Lines "0::/user.slice/job" (version 2) and "9:memory:/job" (version 1).
std::optional<int64_t> cgroup_memory(const std::string& root) {
  std::optional<int64_t> limit;
  std::ifstream file(root + "/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::vector<std::string> controllers =
        split(std::string_view(line).substr(first + 1, second - first - 1), ',');
    const std::string mount = root + "/sys/fs/cgroup", group = line.substr(second + 1);
    if (line.starts_with("0::"))
      limit = lesser(limit, tightest(mount, group, "memory.max"));
    else if (std::find(controllers.begin(), controllers.end(), "memory") != controllers.end())
      limit = lesser(limit, tightest(mount + "/memory", group, "memory.limit_in_bytes"));
  }
  return limit;
}

}  // namespace

std::optional<int64_t> usable_memory(const std::string& root) {
  return lesser(machine_memory(root), cgroup_memory(root));
}

std::optional<int64_t> parse_size(std::string_view text) {
  std::string number = to_lower(text);
  if (number.ends_with("ib"))
    number.resize(number.size() - 2);
  else if (number.ends_with("b"))
    number.resize(number.size() - 1);
  double factor = 1;
  constexpr std::string_view kUnits = "kmgt";
  if (const size_t unit = number.empty() ? kUnits.npos : kUnits.find(number.back()); unit != kUnits.npos) {
    factor = std::exp2(10 * static_cast<double>(unit + 1));
    number.pop_back();
  }
  while (number.ends_with(' ')) number.pop_back();
  const auto value = parse_number(number);
  constexpr double kLargest = 9e18;
  if (!value || !(*value * factor >= 1) || *value * factor > kLargest) return std::nullopt;
  return static_cast<int64_t>(*value * factor);
}

std::string size_text(int64_t bytes) { return cat((bytes + (1 << 19)) >> 20, " MB"); }

}  // namespace aftershade
