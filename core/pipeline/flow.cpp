// How frames flow through a view's stages: straight through those that look at one frame, with a halt before those that
// look ahead.
#include <algorithm>
#include <chrono>

#include "core/base/text.h"
#include "core/pipeline/item.h"

namespace aftershade::pipeline {

namespace {

/// Filters may leave 0..1 by a rounding error.
Plane clamped(Plane ao) {
  for (int y = 0; y < ao.height(); ++y)
    for (int x = 0; x < ao.width(); ++x) ao(x, y) = std::clamp(ao(x, y), 0.0F, 1.0F);
  return ao;
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

void ViewPipeline::flush() {
  for (size_t i = 0; i < stages_.size(); ++i)
    while (!stages_[i].waiting.empty()) release(i);
  for (Entry& entry : stages_) entry.stage->restart();
}

void ViewPipeline::run_stage(Entry& entry, Item& item) {
  const auto start = std::chrono::steady_clock::now();
  with_context(cat("frame ", item.work.frame.number), [&] {
    try {
      entry.stage->run(item.work);
    } catch (const std::bad_alloc&) {
      throw Error(ErrorCode::memory, "out of memory", "fewer --threads need less");
    }
  });
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  item.times.push_back({entry.id, time.count()});
}

void ViewPipeline::advance(ItemPtr item, size_t first) {
  for (size_t i = first; sees(i, item->through); ++i) {
    Entry& entry = stages_[i];
    if (!entry.needs.has_window()) {
      run_stage(entry, *item);
      continue;
    }
    entry.stage->observe(item->work);
    const int newest = item->work.frame.number;
    if (i < item->through)
      entry.waiting.push_back(std::move(item));
    else
      finish(*item);
    while (!entry.waiting.empty() && entry.waiting.front()->work.frame.number + entry.needs.frames_after <= newest)
      release(i);
    return;
  }
  finish(*item);
}

/// The frame that has waited longest goes on.
void ViewPipeline::release(size_t stage) {
  Entry& entry = stages_[stage];
  ItemPtr item = std::move(entry.waiting.front());
  entry.waiting.pop_front();
  run_stage(entry, *item);
  advance(std::move(item), stage + 1);
}

void ViewPipeline::finish(Item& item) {
  if (outputs_.ao_channel && item.written) item.frame.added[*outputs_.ao_channel] = clamped(std::move(item.work.ao));
  FrameReport report{std::move(item.work.notes), std::move(item.work.warnings), std::move(item.times)};
  finished_.push_back({std::move(item.frame), item.written, std::move(report)});
}

}  // namespace aftershade::pipeline
