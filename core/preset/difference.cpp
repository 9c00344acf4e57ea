#include <algorithm>

#include "core/base/text.h"
#include "core/preset/preset.h"

namespace aftershade::preset {

using params::Json;

namespace {

const StageDescription* find(const Preset& preset, std::string_view id) {
  const auto match = [&](const StageDescription& stage) { return stage.id == id; };
  const auto found = std::find_if(preset.stages.begin(), preset.stages.end(), match);
  return found == preset.stages.end() ? nullptr : &*found;
}

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? cat(value.get<double>()) : value.dump();
}

void compare(const StageDescription& a, const StageDescription& b, std::vector<std::string>& lines) {
  if (a.params.index() != b.params.index()) {
    lines.push_back(cat(a.id, ".method: ", method_of(a.params), " -> ", method_of(b.params)));
    return;
  }
  const params::Table& table = table_of(a.params);
  const Json before = params::write(table, values_of(a.params)), after = params::write(table, values_of(b.params));
  for (const auto& [key, value] : before.items())
    if (value != after[key]) lines.push_back(cat(a.id, ".", key, ": ", text_of(value), " -> ", text_of(after[key])));
}

/// The ids of `preset` that `other` has too.
std::vector<std::string> shared_ids(const Preset& preset, const Preset& other) {
  std::vector<std::string> ids;
  for (const StageDescription& stage : preset.stages)
    if (find(other, stage.id)) ids.push_back(stage.id);
  return ids;
}

}  // namespace

std::vector<std::string> difference(const Preset& a, const Preset& b) {
  std::vector<std::string> lines;
  for (const StageDescription& stage : a.stages) {
    if (const StageDescription* other = find(b, stage.id))
      compare(stage, *other, lines);
    else
      lines.push_back(cat(stage.id, ": only in ", a.name));
  }
  for (const StageDescription& stage : b.stages)
    if (!find(a, stage.id)) lines.push_back(cat(stage.id, ": only in ", b.name));
  const auto before = shared_ids(a, b), after = shared_ids(b, a);
  if (before != after) lines.push_back(cat("order: ", join(before, ", "), " -> ", join(after, ", ")));
  return lines;
}

}  // namespace aftershade::preset
