#pragma once
#include <filesystem>
#include <string>

#include "tests/bench/throughput/frames.h"

namespace aftershade::tests::throughput {

/// What was typed: see usage() in options.cpp.
struct Options {
  Size size, large{3840, 2160};
  int frames = 24;         ///< made, at `size`
  int large_frames = 4;    ///< made, at `large`
  int linked_frames = 24;  ///< worked on where the sizes are compared: links to the first large_frames of both
  int memory_frames = 200;
  int offline_frames = 3;                       ///< in the middle of those made: the preset looks far to both sides
  int repetitions = 3, quick_repetitions = 20;  ///< of whole jobs; of what takes less than a second
  int cores = 2;
  std::filesystem::path folder;  ///< empty: one of its own, that goes when the program ends
  std::filesystem::path disk;    ///< on a real disk, for the cost of fsync there; empty: none
  std::string json_file;
  bool smoke = false, offline = false;
};

/// False, after saying how: the arguments are wrong.
bool parse(int argc, char** argv, Options& options);

}  // namespace aftershade::tests::throughput
