#pragma once
#include <cstddef>
#include <optional>
#include <vector>

namespace aftershade::pipeline {

/// A stage that looks at other frames than its own: at those around it, or at its own past.
struct Dependency {
  size_t stage;                             ///< index in the pipeline
  int frames_before = 0, frames_after = 0;  ///< a window
  bool recursive = false;
};

/// A frame that a run visits.
struct PlannedFrame {
  int number;
  size_t through;  ///< stages before this one run; this one, if it has a window, is shown the frame
  bool written;
  bool restarts;  ///< the history is forgotten before it: nothing visited precedes it
  bool operator==(const PlannedFrame&) const = default;
};

/// Preroll of all frames before the first written one: exact.
inline constexpr int kPrerollAll = -1;

/// The frames to visit, in order, so that every one of `written` can be made by `stages` stages. `on_disk` and
/// `written` are sorted, `dependencies` in stage order. A window adds the neighbours, as far as the stages before it;
/// history adds up to `preroll` consecutive frames before. A gap on disk ends both.
std::vector<PlannedFrame> plan(const std::vector<int>& written, const std::vector<int>& on_disk, size_t stages,
                               const std::vector<Dependency>& dependencies, int preroll);

/// A frame that a run of several presets visits, and what each of them plans for it; nullopt: it leaves it out.
struct Visit {
  int number;
  std::vector<std::optional<PlannedFrame>> programs;
};
/// The visits of all plans, in order.
std::vector<Visit> merged(const std::vector<std::vector<PlannedFrame>>& plans);

}  // namespace aftershade::pipeline
