// Everything that issue "Speed" measures, in one run: the whole job against oiiotool's copy, and the rest of the table.
//   bench_throughput [--smoke] [--json FILE] ...   see options.cpp and ../README.md
#include <sched.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/simd/targets.h"
#include "tests/bench/throughput/measures.h"
#include "tests/bench/throughput/plan.h"
#include "tests/bench/throughput/stages.h"

namespace aftershade::tests::throughput {

namespace fs = std::filesystem;

namespace {

/// Where everything is written. A folder that nobody named goes at the end.
class Workplace {
 public:
  explicit Workplace(const fs::path& named)
      : owned_(named.empty()),
        folder_(owned_ ? fs::path(cat("/dev/shm/aftershade-throughput-", int64_t{::getpid()})) : fs::absolute(named)) {
    fs::create_directories(folder_);
  }
  ~Workplace() {
    std::error_code ignored;
    if (owned_) fs::remove_all(folder_, ignored);
  }
  Workplace(const Workplace&) = delete;
  const fs::path& folder() const { return folder_; }

 private:
  bool owned_;
  fs::path folder_;
};

/// Keeps this program and its children on the first `cores` processors of those allowed; how many there are now.
int use_cores(int cores) {
  cpu_set_t allowed, chosen;
  CPU_ZERO(&chosen);
  if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) return cores;
  for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&chosen) < cores; ++i)
    if (CPU_ISSET(i, &allowed)) CPU_SET(i, &chosen);
  ::sched_setaffinity(0, sizeof chosen, &chosen);
  return CPU_COUNT(&chosen);
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

params::Json describe(const Options& options, const fs::path& folder, int cores, const FrameSet& frames) {
  const std::string memory = memory_file_system(folder);
  const double packed = frames.packed_bytes() / static_cast<double>(frames.raw_bytes());
  std::printf("%s, %d of %ld processors, SIMD %s\n", processor().c_str(), cores, ::sysconf(_SC_NPROCESSORS_ONLN),
              lanes::targets().front().c_str());
  std::printf("grass, %d frames of %dx%d, %d channels, colour noise %g rms, packed / raw %.3f (%.1f of %.1f MB)\n",
              frames.frames, frames.size.width, frames.size.height, kChannels, kNoiseRms, packed,
              frames.packed_bytes() / 1e6, static_cast<double>(frames.raw_bytes()) / 1e6);
  std::printf("%d frames of %dx%d; all in %s, %s\n", options.large_frames, options.large.width, options.large.height,
              folder.c_str(), memory.empty() ? "which is NOT a memory file system" : memory.c_str());
  return {{"processor", processor()},     {"cores", cores},          {"targets", lanes::targets()},
          {"memory_file_system", memory}, {"frames", frames.frames}, {"size", {frames.size.width, frames.size.height}},
          {"packed_over_raw", packed}};
}

params::Json report(const Jobs& jobs) {
  params::Json out = params::Json::object();
  std::printf("\n  %-48s %6s %10s %12s %9s\n", "job (medians)", "frames", "ms/frame", "CPU ms/frame", "peak MB");
  for (const auto& [name, record] : jobs.all()) {
    std::printf("  %-48s %6d %10.1f %12.1f %9.1f\n", name.c_str(), record.frames, record.wall_ms_per_frame(),
                record.cpu_ms_per_frame(), record.peak_mb());
    params::Json& json = out[name];
    json = {{"frames", record.frames}, {"packed_bytes", record.packed_bytes}, {"runs", params::Json::array()}};
    for (const Usage& run : record.runs)
      json["runs"].push_back({{"wall_s", run.wall_s}, {"cpu_s", run.cpu_s}, {"peak_mb", run.peak_mb}});
    if (!record.resident_mb.empty()) json["resident_mb"] = record.resident_mb;
  }
  return out;
}

void measure(const Options& options) {
  const Workplace place(options.folder);
  const int cores = use_cores(options.cores);
  Plan plan(options, place.folder());
  plan.make_frames();
  params::Json json{{"machine", describe(options, place.folder(), cores, plan.frames())}};
  Jobs jobs(place.folder());
  plan.run(jobs);
  json["stages"] = plan.stages();
  json["kernels"] = plan.kernels();
  json["jobs"] = report(jobs);
  const std::vector<Row> rows = measures(jobs, json["stages"], json["kernels"], plan.frames().packed_bytes());
  print(rows);
  json["rows"] = to_json(rows);
  if (!options.json_file.empty()) std::ofstream(options.json_file) << json.dump(2) << "\n";
}

/// What this program runs itself for: "frames FOLDER WxH COUNT" and "stages FOLDER WxH COUNT REPETITIONS --json FILE".
bool is_part(int argc, char** argv) {
  const std::string part = argc > 4 ? argv[1] : "";
  if (part != "frames" && part != "stages") return false;
  FrameSet set{argv[2], {}, std::atoi(argv[4])};
  if (std::sscanf(argv[3], "%dx%d", &set.size.width, &set.size.height) != 2) return false;
  if (part == "frames") make_frames(set);
  if (part == "stages" && argc > 7) std::ofstream(argv[7]) << measure_stages(set, std::atoi(argv[5])).dump() << "\n";
  return true;
}

}  // namespace
}  // namespace aftershade::tests::throughput

int main(int argc, char** argv) {
  using namespace aftershade::tests::throughput;
  try {
    if (is_part(argc, argv)) return 0;
    Options options;
    if (!parse(argc, argv, options)) return 64;
    std::signal(SIGINT, SIG_IGN);  // it ends what runs, and this program then tidies up
    measure(options);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_throughput: %s\n", error.what());
    return 1;
  }
}
