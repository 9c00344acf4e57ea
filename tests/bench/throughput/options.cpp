#include "tests/bench/throughput/options.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace aftershade::tests::throughput {

namespace {

constexpr const char* kUsage =
    "usage: bench_throughput [OPTION]...\n"
    "  --smoke             tiny pictures, one repetition: does everything work?\n"
    "  --json FILE         writes all figures\n"
    "  --repetitions N     of every job, 3 by default; figures are medians\n"
    "  --frames N          frames made, at least 3, 24 by default\n"
    "  --size WxH          1920x1080 by default; --large WxH, 3840x2160 by default\n"
    "  --large-frames N    large frames made, 4 by default\n"
    "  --memory-frames N   length of the run that watches memory, 200 by default; 0: none\n"
    "  --folder FOLDER     works there and leaves the frames for the next run; by default in /dev/shm, all of it "
    "removed\n"
    "  --disk FOLDER       measures the cost of fsync there too\n"
    "  --offline           also runs the preset offline, which is slow, on 3 frames\n"
    "  --cores N           processors to use of those allowed, 2 by default\n";

void make_smoke(Options& options) {
  options.smoke = true;
  options.size = {96, 54}, options.large = {192, 108};
  options.frames = options.linked_frames = 3, options.large_frames = 2;
  options.memory_frames = 6, options.offline_frames = 1;
  options.repetitions = options.quick_repetitions = 1;
}

bool is_size(const std::string& text, Size& size) {
  return std::sscanf(text.c_str(), "%dx%d", &size.width, &size.height) == 2 && size.width > 0 && size.height > 0;
}
bool is_count(const std::string& text, int least, int& count) {
  count = std::atoi(text.c_str());
  return count >= least;
}

bool set(Options& options, const std::string& name, const std::string& value) {
  if (value.empty()) return false;
  if (name == "--json") options.json_file = value;
  if (name == "--folder") options.folder = value;
  if (name == "--disk") options.disk = value;
  if (name == "--json" || name == "--folder" || name == "--disk") return true;
  if (name == "--size") return is_size(value, options.size);
  if (name == "--large") return is_size(value, options.large);
  if (name == "--repetitions") return is_count(value, 1, options.repetitions);
  if (name == "--frames") return is_count(value, 3, options.frames);
  if (name == "--large-frames") return is_count(value, 1, options.large_frames);
  if (name == "--memory-frames") return is_count(value, 0, options.memory_frames);
  return name == "--cores" && is_count(value, 1, options.cores);
}

}  // namespace

bool parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--smoke") {
      make_smoke(options);
    } else if (name == "--offline") {
      options.offline = true;
    } else if (!set(options, name, ++i < argc ? argv[i] : "")) {
      std::fputs(kUsage, stderr);
      return false;
    }
  }
  options.large_frames = std::min(options.large_frames, options.frames);
  return true;
}

}  // namespace aftershade::tests::throughput
