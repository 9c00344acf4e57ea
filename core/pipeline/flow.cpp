// How frames flow through a view's stages: straight through those that look at one frame, with a halt before those that
// look ahead.
#include <algorithm>
#include <chrono>

#include "core/base/text.h"
#include "core/image/plane_memory.h"
#include "core/parallel/rows.h"
#include "core/pipeline/item.h"

namespace aftershade::pipeline {

namespace {

/// Filters may leave 0..1 by a rounding error.
Plane clamped(Plane ao) {
  for_rows(ao.height(), [&](int y) {
    for (int x = 0; x < ao.width(); ++x) ao(x, y) = std::clamp(ao(x, y), 0.0F, 1.0F);
  });
  return ao;
}

/// Before their pixels change: another preset may have the same ones. Alone, a preset has no need of that, so it counts
/// neither as its time nor as its memory.
void make_own(std::vector<Layer>& layers) {
  const OnAccount nobodys(nullptr);
  for (Layer& layer : layers)
    for (Plane& plane : layer.planes) plane.make_own();
}

}  // namespace

ViewPipeline::~ViewPipeline() = default;
ViewPipeline::ViewPipeline(ViewPipeline&&) noexcept = default;
ViewPipeline& ViewPipeline::operator=(ViewPipeline&&) noexcept = default;

void ViewPipeline::push(Frame frame, std::optional<Frame> previous, const PlannedFrame& planned) {
  if (planned.restarts || display_before_ != frame.display) flush();
  display_before_ = frame.display;
  advance(std::make_unique<Item>(std::move(frame), std::move(previous), planned, outputs_.work), 0);
}

void ViewPipeline::flush() { settle(0); }

void ViewPipeline::settle(size_t first) {
  for (size_t i = first; i < stages_.size(); ++i)
    while (!stages_[i].waiting.empty()) release(i);
  for (size_t i = first; i < stages_.size(); ++i) stages_[i].stage->restart();
}

bool ViewPipeline::attempt(Item& item, size_t blind, const std::function<void()>& work) {
  try {
    with_context(cat("frame ", item.work.frame.number), [&] {
      try {
        work();
      } catch (const std::bad_alloc&) {
        throw Error(ErrorCode::memory, "out of memory", "fewer --threads need less");
      }
    });
    return true;
  } catch (const Error& error) {
    item.error = error;
  }
  settle(blind);
  finish(item);
  return false;
}

bool ViewPipeline::run_stage(size_t stage, Item& item) {
  Entry& entry = stages_[stage];
  if (entry.needs.layers) make_own(item.frame.layers);
  const auto start = std::chrono::steady_clock::now();
  const double shared_before = item.work.shared().milliseconds;
  const size_t blind = entry.needs.has_window() ? stage + 1 : stage;  // a window has seen the frame already
  const bool ok = attempt(item, blind, [&] { entry.stage->run(item.work); });
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  if (ok)
    item.times.push_back({entry.id, std::exchange(item.observed_ms, 0.0) + time.count() +
                                        item.work.shared().milliseconds - shared_before});
  return ok;
}

void ViewPipeline::advance(ItemPtr item, size_t first) {
  for (size_t i = first; sees(i, item->through); ++i) {
    Entry& entry = stages_[i];
    if (entry.needs.has_window()) {
      halt(std::move(item), i);
      return;
    }
    if (!run_stage(i, *item)) return;
  }
  finish(*item);
}

/// The frame is shown to the stage, and waits there if it is to be run; those that waited for it go on.
void ViewPipeline::halt(ItemPtr item, size_t stage) {
  Entry& entry = stages_[stage];
  const auto start = std::chrono::steady_clock::now();
  if (!attempt(*item, stage, [&] { entry.stage->observe(item->work); })) return;
  item->observed_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const int newest = item->work.frame.number;
  if (stage < item->through)
    entry.waiting.push_back(std::move(item));
  else
    finish(*item);
  while (!entry.waiting.empty() && entry.waiting.front()->work.frame.number + entry.needs.frames_after <= newest)
    release(stage);
}

/// The frame that has waited longest goes on.
void ViewPipeline::release(size_t stage) {
  Entry& entry = stages_[stage];
  ItemPtr item = std::move(entry.waiting.front());
  entry.waiting.pop_front();
  if (run_stage(stage, *item)) advance(std::move(item), stage + 1);
}

void ViewPipeline::finish(Item& item) {
  if (outputs_.ao_channel && item.written && !item.error)
    item.frame.added[*outputs_.ao_channel] = clamped(std::move(item.work.ao));
  FrameReport report{std::move(item.work.notes), std::move(item.work.warnings), std::move(item.times),
                     item.work.shared().bytes};
  finished_.push_back({std::move(item.frame), item.written, std::move(report), std::move(item.error)});
}

}  // namespace aftershade::pipeline
