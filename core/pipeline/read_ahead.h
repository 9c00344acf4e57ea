#pragma once
#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/parallel/background.h"
#include "core/pipeline/pipeline.h"

namespace aftershade::pipeline {

/// All views of a planned frame, or what went wrong with reading them.
struct LoadedFrame {
  std::vector<Frame> views;
  std::vector<std::optional<Frame>> for_next;  ///< what the next frame's stages want of this one, if it follows
  std::exception_ptr failure;
};

/// Reads planned frames in the background, in order, one at a time. Internal to core/pipeline.
class ReadAhead {
 public:
  ReadAhead(const std::vector<ViewPipeline>& views, FrameSource& source, const std::vector<PlannedFrame>& planned)
      : views_(views), source_(source), planned_(planned) {}
  /// Waits for what is being read; what has not begun never does.
  ~ReadAhead() { abandoned_ = true; }

  bool at_end() const { return next_ == planned_.size(); }
  bool has_begun() const { return reading_ != nullptr; }  ///< a frame was begun and is not taken yet
  void begin();                                           ///< the next frame, if none has begun; not at_end()
  LoadedFrame take();                                     ///< the frame begun, waited for

 private:
  struct Wish {
    std::string view;
    RoleSet roles, for_next;
    bool layers;
  };
  struct Reading {
    int number;
    std::vector<Wish> wishes;
    LoadedFrame loaded;
    std::optional<Background> task;
  };
  void read(Reading& reading) const;
  Frame load(int number, const Wish& wish) const;

  const std::vector<ViewPipeline>& views_;
  FrameSource& source_;
  const std::vector<PlannedFrame>& planned_;
  size_t next_ = 0;
  std::atomic<bool> abandoned_ = false;
  std::unique_ptr<Reading> reading_;  // last: its destruction waits for the task
};

}  // namespace aftershade::pipeline
