#include "core/pipeline/read_ahead.h"

#include <new>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::pipeline {

namespace {

RoleSet united(RoleSet a, RoleSet b) {
  a.insert(b);
  return a;
}

/// What stages see of `frame` as the frame before theirs: its roles `wanted`. Those that only serve this are taken from
/// the frame; `own` are its own. Copied before any stage, because stages may change the window; a copy costs a tenth of
/// decoding the frame again.
Frame as_previous(Frame& frame, RoleSet wanted, RoleSet own) {
  Frame before;
  before.number = frame.number;
  before.view = frame.view;
  before.part = frame.part;
  before.window = frame.window;
  before.display = frame.display;
  before.pixel_aspect = frame.pixel_aspect;
  before.camera = frame.camera;
  before.shutter_angle_deg = frame.shutter_angle_deg;
  for (const auto& [role, name, count] : kRoles) {
    if (!wanted.contains(role)) continue;
    if (own.contains(role))
      for (const Plane& plane : frame.planes(role)) before.planes(role).push_back(copy_of(plane));
    else
      before.planes(role) = std::exchange(frame.planes(role), {});
  }
  return before;
}

}  // namespace

void ReadAhead::begin() {
  const PlannedFrame& planned = planned_[next_++];
  const bool is_previous = !at_end() && !planned_[next_].restarts;
  auto reading = std::make_unique<Reading>();
  reading->number = planned.number;
  for (const ViewPipeline& view : views_)
    reading->wishes.push_back({view.view(), view.roles(planned.through),
                               is_previous ? view.previous_roles() : RoleSet(), view.layers(planned.through)});
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
  try {
    for (const Wish& wish : reading.wishes) {
      Frame frame = load(reading.number, wish);
      std::optional<Frame> for_next;
      if (!wish.for_next.empty()) for_next = as_previous(frame, wish.for_next, wish.roles);
      loaded.views.push_back(std::move(frame));
      loaded.for_next.push_back(std::move(for_next));
    }
  } catch (const std::bad_alloc&) {  // like any other failure, it is this frame's
    loaded.failure = std::make_exception_ptr(Error(ErrorCode::memory, cat("frame ", reading.number, ": out of memory"),
                                                   "fewer --threads or less --memory need less"));
  } catch (...) {
    loaded.failure = std::current_exception();
  }
  if (loaded.failure) loaded.views.clear(), loaded.for_next.clear();
}

Frame ReadAhead::load(int number, const Wish& wish) const {
  auto frame = source_.load(number, wish.view, united(wish.roles, wish.for_next), wish.layers);
  if (!frame) throw Error(ErrorCode::no_input, cat("frame ", number, " is missing"));
  return std::move(*frame);
}

}  // namespace aftershade::pipeline
