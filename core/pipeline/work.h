#pragma once
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/ao/scalable_ao.h"
#include "core/filter/sample_grid.h"
#include "core/filter/surface.h"
#include "core/image/frame.h"
#include "core/pipeline/aov.h"
#include "core/pipeline/geometry.h"

namespace aftershade::pipeline {

struct WorkOptions {
  AovSet aovs;                    ///< intermediate results that stages add to the files
  bool grow_data_window = false;  ///< blur may leave the data window (as far as the display window)
};

/// One view of one frame on its way through the stages: what was read, what stages hand to each other, what they
/// report.
class Work {
 public:
  Work(Frame& current, const Frame* before, const WorkOptions& wishes)
      : frame(current), previous(before), options(wishes) {}
  Work(const Work&) = delete;

  Frame& frame;
  const Frame* previous;  ///< frame f-1 with the roles that stages asked for, or nullptr
  const WorkOptions& options;

  std::optional<filter::SampleGrid> grid;  ///< where the AO was evaluated; none once the window has changed
  Plane ao;                                ///< 1 = open; on the grid, later on every pixel
  bool ao_at_pixels = false;

  /// Whose normals the surface has from now on; `automatic` takes the file's where it has some.
  void choose_normals(ao::NormalSource source);
  /// The visible surface.
  const filter::Surface& surface();
  /// Depth mips for taps far away.
  const filter::DepthPyramid& pyramid();

  /// Of what this preset has used and may share with others: how long another one took to make it, and the memory.
  struct Shared {
    double milliseconds = 0;
    size_t bytes = 0;
  };
  const Shared& shared() const { return shared_; }

  /// Lays the frame's planes and the AO into `window` (absolute coordinates): new pixels are background (depth +inf,
  /// velocity unknown, named channels NaN, AO 1, everything else 0), pixels outside are dropped.
  void change_window(Window window);

  bool wants(Aov aov) const { return options.aovs.contains(aov); }
  /// Adds an intermediate result, at every pixel; of a vector its component x (0) or y (1).
  void give(Aov aov, Plane plane, size_t component = 0) {
    frame.added[channels_of(aov).at(component)] = std::move(plane);
  }

  void note(std::string text) { notes.push_back(std::move(text)); }
  void warn(std::string text) { warnings.push_back(std::move(text)); }
  std::vector<std::string> notes, warnings;  ///< for the log

 private:
  Geometry& geometry();
  template <class T, class Make>
  const T& once(MadeOnce<T>& made, Make&& make);

  ao::NormalSource normals_ = ao::NormalSource::automatic;
  std::optional<filter::Surface> surface_;
  std::shared_ptr<Geometry> geometry_;
  std::set<const void*> used_;  ///< of the geometry
  Shared shared_;
};

}  // namespace aftershade::pipeline
