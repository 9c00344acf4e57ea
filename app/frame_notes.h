#pragma once
#include <functional>
#include <map>
#include <mutex>
#include <vector>

namespace aftershade::app {

/// What there is to say about frames that are read or written on whatever thread, kept until the run comes to them.
class FrameNotes {
 public:
  void add(int frame, std::function<void()> note) {
    const std::lock_guard lock(mutex_);
    notes_[frame].push_back(std::move(note));
  }
  /// Says what was added for a frame, in that order.
  void say(int frame) {
    std::vector<std::function<void()>> notes;
    {
      const std::lock_guard lock(mutex_);
      if (auto node = notes_.extract(frame)) notes = std::move(node.mapped());
    }
    for (const auto& note : notes) note();
  }

 private:
  std::mutex mutex_;
  std::map<int, std::vector<std::function<void()>>> notes_;
};

}  // namespace aftershade::app
