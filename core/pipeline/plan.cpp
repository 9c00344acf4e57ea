#include "core/pipeline/plan.h"

#include <algorithm>
#include <set>

namespace aftershade::pipeline {

std::vector<PlannedFrame> plan(const std::vector<int>& written, const std::vector<int>& on_disk, bool recursive,
                               int preroll) {
  std::set<int> visited(written.begin(), written.end());
  for (const int frame : written) {
    if (!recursive) break;
    for (int before = frame - 1; preroll == kPrerollAll || frame - before <= preroll; --before) {
      if (!std::binary_search(on_disk.begin(), on_disk.end(), before)) break;
      visited.insert(before);
    }
  }
  std::vector<PlannedFrame> frames;
  for (const int number : visited) {
    const bool follows = !frames.empty() && frames.back().number == number - 1;
    frames.push_back({number, std::binary_search(written.begin(), written.end(), number), !follows});
  }
  return frames;
}

}  // namespace aftershade::pipeline
