#include "core/base/memory_limit.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace aftershade {
namespace {

namespace fs = std::filesystem;

/// A machine's /proc and /sys below a folder of its own.
class Machine {
 public:
  explicit Machine(const std::string& name) : root_(fs::path(testing::TempDir()) / ("memory_limit_" + name)) {
    fs::remove_all(root_);
  }
  ~Machine() { fs::remove_all(root_); }
  void put(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  std::optional<int64_t> memory() const { return usable_memory(root_.string()); }

 private:
  fs::path root_;
};

TEST(UsableMemory, IsTheMachinesWithoutACgroup) {
  const Machine machine("plain");
  machine.put("proc/meminfo", "MemTotal:       1000 kB\nMemFree:         10 kB\n");
  EXPECT_EQ(machine.memory(), 1000 << 10);
}

TEST(UsableMemory, IsThatOfTheTightestCgroup) {
  const Machine machine("v2");
  machine.put("proc/meminfo", "MemFree: 1 kB\nMemTotal:       1000 kB\n");
  machine.put("proc/self/cgroup", "0::/user.slice/job/step\n");
  machine.put("sys/fs/cgroup/user.slice/job/step/memory.max", "max\n");
  machine.put("sys/fs/cgroup/user.slice/job/memory.max", "65536\n");
  machine.put("sys/fs/cgroup/user.slice/memory.max", "500000\n");
  EXPECT_EQ(machine.memory(), 65536);
}

TEST(UsableMemory, KnowsVersionOneToo) {
  const Machine machine("v1");
  machine.put("proc/meminfo", "MemTotal:       1000 kB\n");
  machine.put("proc/self/cgroup", "12:cpu,cpuacct:/a\n9:memory:/docker/x\n");
  machine.put("sys/fs/cgroup/memory/docker/x/memory.limit_in_bytes", "9223372036854771712\n");
  machine.put("sys/fs/cgroup/memory/memory.limit_in_bytes", "70000\n");  // as a container sees its own
  EXPECT_EQ(machine.memory(), 70000);
}

TEST(UsableMemory, LargerCgroupsAreNoLimitAndNothingIsUnknown) {
  const Machine machine("large");
  EXPECT_EQ(machine.memory(), std::nullopt);
  machine.put("proc/meminfo", "MemTotal:       1000 kB\n");
  machine.put("proc/self/cgroup", "0::/\n");
  machine.put("sys/fs/cgroup/memory.max", "99999999999\n");
  EXPECT_EQ(machine.memory(), 1000 << 10);
}

TEST(ParseSize, TakesUnitsOfPowersOf1024) {
  EXPECT_EQ(parse_size("4096"), 4096);
  EXPECT_EQ(parse_size("2k"), 2048);
  EXPECT_EQ(parse_size("700M"), int64_t{700} << 20);
  EXPECT_EQ(parse_size("2G"), int64_t{2} << 30);
  EXPECT_EQ(parse_size("1.5 GiB"), int64_t{3} << 29);
  EXPECT_EQ(parse_size("1TB"), int64_t{1} << 40);
}

TEST(ParseSize, RefusesEverythingElse) {
  for (const char* text : {"", "G", "-1G", "0", "0.5", "much", "2X", "2GG", "1e40", "nan", "inf", "b", "ib"})
    EXPECT_EQ(parse_size(text), std::nullopt) << text;
}

TEST(SizeText, IsInMegabytes) {
  EXPECT_EQ(size_text(int64_t{700} << 20), "700 MB");
  EXPECT_EQ(size_text((int64_t{3} << 20) / 2), "2 MB");
}

}  // namespace
}  // namespace aftershade
