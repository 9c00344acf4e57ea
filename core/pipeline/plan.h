#pragma once
#include <vector>

namespace aftershade::pipeline {

/// A frame that a run visits.
struct PlannedFrame {
  int number;
  bool written;   ///< false: only read and filtered, to build up the history of a later frame
  bool restarts;  ///< the history is forgotten before it: nothing filtered precedes it
  bool operator==(const PlannedFrame&) const = default;
};

/// Preroll of all frames before the first written one: exact.
inline constexpr int kPrerollAll = -1;

/// The frames to visit, in order, so that every one of `written` can be made. `on_disk` and `written` are sorted. A
/// recursive pipeline also visits up to `preroll` consecutive frames before each written one; a gap on disk ends the
/// history.
std::vector<PlannedFrame> plan(const std::vector<int>& written, const std::vector<int>& on_disk, bool recursive,
                               int preroll);

}  // namespace aftershade::pipeline
