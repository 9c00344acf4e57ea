#include "core/pipeline/plan.h"

#include <algorithm>
#include <map>

namespace aftershade::pipeline {

namespace {

/// Frame number -> how far it goes (PlannedFrame::through).
using Visits = std::map<int, size_t>;

void visit(Visits& visits, int number, size_t through) {
  size_t& entry = visits[number];
  entry = std::max(entry, through);
}

bool exists(const std::vector<int>& on_disk, int number) {
  return std::binary_search(on_disk.begin(), on_disk.end(), number);
}

/// Adds up to `count` frames that follow each other from `number` in direction `step`.
void add_window(Visits& visits, const std::vector<int>& on_disk, int number, int step, int count, size_t through) {
  for (int i = 1; i <= count && exists(on_disk, number + i * step); ++i) visit(visits, number + i * step, through);
}

/// Adds up to `count` (kPrerollAll: all) frames before `number`, up to one that has a past of its own.
void add_preroll(Visits& visits, const Visits& with_past, const std::vector<int>& on_disk, int number, int count,
                 size_t through) {
  for (int i = 1; (count == kPrerollAll || i <= count) && exists(on_disk, number - i); ++i) {
    const auto before = with_past.find(number - i);
    if (before != with_past.end() && before->second >= through) break;
    visit(visits, number - i, through);
  }
}

}  // namespace

std::vector<PlannedFrame> plan(const std::vector<int>& written, const std::vector<int>& on_disk, size_t stages,
                               const std::vector<Dependency>& dependencies, int preroll) {
  Visits visits;
  for (const int frame : written) visits[frame] = stages;
  for (auto d = dependencies.rbegin(); d != dependencies.rend(); ++d) {
    const Visits so_far = visits;
    for (const auto& [number, through] : so_far) {
      if (through <= d->stage) continue;
      add_window(visits, on_disk, number, -1, d->frames_before, d->stage);
      add_window(visits, on_disk, number, 1, d->frames_after, d->stage);
      if (d->recursive) add_preroll(visits, so_far, on_disk, number, preroll, d->stage + 1);
    }
  }
  std::vector<PlannedFrame> frames;
  for (const auto& [number, through] : visits) {
    const bool follows = !frames.empty() && frames.back().number == number - 1;
    frames.push_back({number, through, std::binary_search(written.begin(), written.end(), number), !follows});
  }
  return frames;
}

std::vector<Visit> merged(const std::vector<std::vector<PlannedFrame>>& plans) {
  std::map<int, Visit> visits;
  for (size_t program = 0; program < plans.size(); ++program)
    for (const PlannedFrame& planned : plans[program]) {
      Visit& visit = visits.try_emplace(planned.number, Visit{planned.number, {}}).first->second;
      visit.programs.resize(plans.size());
      visit.programs[program] = planned;
    }
  std::vector<Visit> out;
  for (auto& [number, visit] : visits) out.push_back(std::move(visit));
  return out;
}

}  // namespace aftershade::pipeline
