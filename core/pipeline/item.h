#pragma once
#include "core/pipeline/pipeline.h"

namespace aftershade::pipeline {

/// A frame on its way through the stages. Internal to core/pipeline.
struct ViewPipeline::Item {
  Item(Frame current, std::optional<Frame> before, const PlannedFrame& planned, const WorkOptions& options)
      : frame(std::move(current)),
        previous(std::move(before)),
        work(frame, previous ? &*previous : nullptr, options),
        through(planned.through),
        written(planned.written) {}
  Frame frame;
  std::optional<Frame> previous;
  Work work;
  size_t through;
  bool written;
  std::vector<FrameReport::StageTime> times;
  double observed_ms = 0;  ///< what showing it to the stage that it waits at took
  std::optional<Error> error;
};

}  // namespace aftershade::pipeline
