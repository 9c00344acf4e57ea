#include "core/pipeline/read_ahead.h"

#include <chrono>
#include <new>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::pipeline {

namespace {

RoleSet united(RoleSet a, RoleSet b) {
  a.insert(b);
  return a;
}

/// What stages see of `frame` as the frame before theirs.
Frame as_previous(const Frame& frame, RoleSet roles) {
  Frame before = with_only(shared(frame), roles, false);
  before.named.clear();
  before.file.reset();
  return before;
}

}  // namespace

Frame with_only(Frame frame, RoleSet roles, bool layers) {
  for (const RoleInfo& role : kRoles)
    if (!roles.contains(role.role)) frame.planes(role.role).clear();
  if (!layers) frame.layers.clear();
  return frame;
}

ReadAhead::Wish ReadAhead::wish_of(size_t view, const Visit& visit, const Visit* next) const {
  Wish wish{programs_.front().views[view].view(), {}, {}};
  for (size_t i = 0; i < programs_.size(); ++i) {
    const ViewPipeline& stages = programs_[i].views[view];
    if (const auto& planned = visit.programs[i]) {
      wish.roles.insert(stages.roles(planned->through));
      wish.layers = wish.layers || stages.layers(planned->through);
    }
    if (next && next->programs[i] && !next->programs[i]->restarts) wish.for_next.insert(stages.previous_roles());
  }
  return wish;
}

void ReadAhead::begin() {
  const Visit& visit = visits_[next_++];
  auto reading = std::make_unique<Reading>();
  reading->number = visit.number;
  for (size_t view = 0; view < programs_.front().views.size(); ++view)
    reading->wishes.push_back(wish_of(view, visit, at_end() ? nullptr : &visits_[next_]));
  reading->task.emplace([this, &target = *reading] { read(target); });
  reading_ = std::move(reading);
}

LoadedFrame ReadAhead::take() {
  const std::unique_ptr<Reading> reading = std::move(reading_);
  reading->task->wait();
  return std::move(reading->loaded);
}

void ReadAhead::read(Reading& reading) const {
  if (abandoned_) return;
  LoadedFrame& loaded = reading.loaded;
  const auto start = std::chrono::steady_clock::now();
  try {
    for (const Wish& wish : reading.wishes) {
      Frame frame = load(reading.number, wish);
      std::optional<Frame> for_next;
      if (!wish.for_next.empty()) for_next = as_previous(frame, wish.for_next);
      loaded.views.push_back(std::move(frame));
      loaded.for_next.push_back(std::move(for_next));
    }
  } catch (const std::bad_alloc&) {  // like any other failure, it is this frame's
    loaded.failure = std::make_exception_ptr(Error(ErrorCode::memory, cat("frame ", reading.number, ": out of memory"),
                                                   "fewer --threads or less --memory need less"));
  } catch (...) {
    loaded.failure = std::current_exception();
  }
  loaded.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (loaded.failure) loaded.views.clear(), loaded.for_next.clear();
}

Frame ReadAhead::load(int number, const Wish& wish) const {
  auto frame = source_.load(number, wish.view, united(wish.roles, wish.for_next), wish.layers);
  if (!frame) throw Error(ErrorCode::no_input, cat("frame ", number, " is missing"));
  return std::move(*frame);
}

}  // namespace aftershade::pipeline
