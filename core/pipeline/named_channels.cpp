#include "core/pipeline/named_channels.h"

#include <algorithm>
#include <cmath>

#include "core/parallel/rows.h"
#include "core/pipeline/stage.h"

namespace aftershade::pipeline {

std::vector<std::string> named_channels(const preset::Preset& preset) {
  std::vector<std::string> names;
  for (const preset::StageDescription& stage : preset.stages)
    for (const std::string& name : make_stage(stage.params)->needs({}).channels)
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  return names;
}

Needs needs_of_value(const std::string& channel) {
  Needs needs;
  needs.ao = needs.grid = channel.empty();
  if (!channel.empty()) needs.channels = {channel};
  return needs;
}

ConstPlaneView value_of(const Work& work, const std::string& channel) {
  if (channel.empty()) return work.ao;
  const auto changed = work.frame.added.find(channel);
  return changed != work.frame.added.end() ? changed->second : work.frame.named.at(channel);
}

void put_value(Work& work, const std::string& channel, Plane filtered) {
  if (!channel.empty()) {
    const ConstPlaneView before = value_of(work, channel), depth = work.frame.depth();
    for_rows(filtered.height(), [&](int y) {
      for (int x = 0; x < filtered.width(); ++x)
        if (!std::isfinite(before(x, y)) || !std::isfinite(depth(x, y))) filtered(x, y) = before(x, y);
    });
  }
  (channel.empty() ? work.ao : work.frame.added[channel]) = std::move(filtered);
}

}  // namespace aftershade::pipeline
