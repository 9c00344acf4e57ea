#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/params/table.h"
#include "tests/bench/throughput/jobs.h"
#include "tests/bench/throughput/options.h"

/// What is run, on which frames.
namespace aftershade::tests::throughput {

inline constexpr const char* kCopy = "copy: two oiiotool side by side";
inline constexpr const char* kOneCopy = "one oiiotool";
inline constexpr const char* kWhole = "high-dx11";
inline constexpr const char* kRecode = "--recode";
inline constexpr const char* kHalves = "high-dx11: two jobs of one thread side by side";
inline constexpr const char* kNoFsync = "high-dx11 --fsync off";
inline constexpr const char* kBlurJob = "high-dx11 --only motion_blur";
inline constexpr const char* kGatherPlusJob = "gather-plus alone";
inline constexpr const char* kSmall = "high-dx11, links, 1080p";
inline constexpr const char* kLarge = "high-dx11, links, 4K";
inline constexpr const char* kOneFrame = "high-dx11, one frame";
inline constexpr const char* kVersion = "--version";
inline constexpr const char* kDisk = "high-dx11 to disk";
inline constexpr const char* kDiskNoFsync = "high-dx11 to disk --fsync off";
inline constexpr const char* kMemory = "high-dx11, many frames";
inline constexpr const char* kOffline = "offline";
inline constexpr const char* kSixJobs = "six presets, a job each";
inline constexpr const char* kCompareWritten = "compare of six presets, frames written";
inline constexpr const char* kCompareAlone = "compare of six presets";

/// Makes the frames and runs everything in folder `work`. Heavy work happens in child processes, this program again
/// among them: what a child's peak of memory begins with is its parent's.
class Plan {
 public:
  Plan(const Options& options, std::filesystem::path work);

  void make_frames();
  void run(Jobs& jobs) const;
  params::Json stages() const;   ///< measure_stages
  params::Json kernels() const;  ///< the JSON of bench_kernels
  const FrameSet& frames() const { return frames_; }

 private:
  Command render(const FrameSet& set, const std::filesystem::path& out, const std::vector<std::string>& more) const;
  Job whole(const std::string& name, const FrameSet& set, const std::vector<std::string>& more) const;
  Job halves() const;
  Job copies(const std::string& name, int processes) const;
  std::vector<Job> main_jobs() const;
  std::vector<Job> disk_jobs() const;
  std::vector<Job> compare_jobs() const;
  bool offers(const std::string& option) const;
  void make(const FrameSet& set) const;
  params::Json json_of(Command command, const std::string& name) const;

  Options options_;
  std::filesystem::path work_, self_, program_;
  FrameSet frames_, large_, linked_, linked_large_, one_, many_;
  std::string help_;
};

}  // namespace aftershade::tests::throughput
