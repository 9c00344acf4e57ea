#include "core/parallel/background.h"

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <exception>

namespace aftershade {

/// The exception is kept here, not in the group, which would cancel what the work has started.
struct Background::State {
  tbb::task_group group;
  std::exception_ptr failure;
  bool waited = false;
};

Background::Background(std::function<void()> work) : state_(std::make_unique<State>()) {
  state_->group.run([&state = *state_, work = std::move(work)] {
    try {
      work();
    } catch (...) {
      state.failure = std::current_exception();
    }
  });
}

Background::Background(Background&&) noexcept = default;

Background::~Background() {
  if (state_ && !state_->waited) state_->group.wait();
}

void Background::wait() {
  state_->group.wait();
  state_->waited = true;
  if (state_->failure) std::rethrow_exception(std::exchange(state_->failure, nullptr));
}

void undisturbed(const std::function<void()>& work) { tbb::this_task_arena::isolate(work); }

}  // namespace aftershade
