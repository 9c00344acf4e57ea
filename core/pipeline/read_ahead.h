#pragma once
#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/parallel/background.h"
#include "core/pipeline/pipeline.h"

namespace aftershade::pipeline {

/// All views of a visited frame, or what went wrong with reading them.
struct LoadedFrame {
  std::vector<Frame> views;                    ///< with all that any program wants
  std::vector<std::optional<Frame>> for_next;  ///< what the next frame's stages want of this one, if it follows
  std::exception_ptr failure;
  double milliseconds = 0;  ///< that reading took
};

/// The frame with these roles and, if asked, its layers; everything else is dropped.
Frame with_only(Frame frame, RoleSet roles, bool layers);

/// Reads the frames that programs visit in the background, in order, one at a time. Internal to core/pipeline.
class ReadAhead {
 public:
  ReadAhead(std::span<const Program> programs, FrameSource& source, const std::vector<Visit>& visits)
      : programs_(programs), source_(source), visits_(visits) {}
  /// Waits for what is being read; what has not begun never does.
  ~ReadAhead() { abandoned_ = true; }

  bool at_end() const { return next_ == visits_.size(); }
  bool has_begun() const { return reading_ != nullptr; }  ///< a frame was begun and is not taken yet
  void begin();                                           ///< the next frame, if none has begun; not at_end()
  LoadedFrame take();                                     ///< the frame begun, waited for

 private:
  struct Wish {
    std::string view;
    RoleSet roles, for_next;
    bool layers = false;
  };
  struct Reading {
    int number;
    std::vector<Wish> wishes;
    LoadedFrame loaded;
    std::optional<Background> task;
  };
  Wish wish_of(size_t view, const Visit& visit, const Visit* next) const;
  void read(Reading& reading) const;
  Frame load(int number, const Wish& wish) const;

  const std::span<const Program> programs_;
  FrameSource& source_;
  const std::vector<Visit>& visits_;
  size_t next_ = 0;
  std::atomic<bool> abandoned_ = false;
  std::unique_ptr<Reading> reading_;  // last: its destruction waits for the task
};

}  // namespace aftershade::pipeline
