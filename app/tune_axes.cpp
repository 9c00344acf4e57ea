#include <algorithm>

#include "app/tune_job.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::app {

namespace {

/// What lengths in pixels refer to: another way to say how long they are.
constexpr std::string_view kReferenceHeight = "reference_height_px";

struct Wish {
  std::string key;
  std::optional<params::Range> bounds;
};

/// "radius_m" or "radius_m=0.2:3".
Wish wish_of(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos) return {text, {}};
  const std::vector<std::string> ends = split(text.substr(equals + 1), ':');
  const auto min = parse_number(ends.front()), max = parse_number(ends.back());
  if (ends.size() != 2 || !min || !max)
    throw Error(ErrorCode::usage, cat("--parameters ", text, " has no range"), "write it as KEY=MIN:MAX");
  return {text.substr(0, equals), params::Range{*min, *max}};
}

bool is_number(const params::Record& record) {
  return record.kind == params::Kind::number || record.kind == params::Kind::integer;
}

}  // namespace

const preset::StageDescription& stage_named(const preset::Preset& preset, const std::string& id) {
  std::vector<std::string> ids;
  for (const preset::StageDescription& stage : preset.stages) {
    if (stage.id == id) return stage;
    ids.push_back(stage.id);
  }
  throw Error(ErrorCode::usage, cat("preset ", preset.name, " has no stage \"", id, "\""),
              "stages: " + join(ids, ", "));
}

tune::Axes axes_of(const preset::StageDescription& stage, const std::vector<std::string>& parameters) {
  const params::Table& table = preset::table_of(stage.params);
  const void* values = preset::values_of(stage.params);
  const std::string where = "stage " + stage.id;
  const auto value_of = [&](const params::Record& record) {
    return is_number(record) ? record.get(values).get<double>() : 0;
  };
  tune::Axes axes;
  for (const std::string& list : parameters)
    for (const std::string& text : split(list, ',')) {
      const Wish wish = wish_of(text);
      const params::Record& record = params::find(table, wish.key, where);
      if (std::ranges::any_of(axes, [&](const tune::Axis& axis) { return axis.key == wish.key; }))
        throw Error(ErrorCode::usage, cat("--parameters names ", wish.key, " twice"), "once is enough");
      axes.push_back(tune::axis_of(record, value_of(record), wish.bounds, where));
    }
  if (!parameters.empty()) return axes;
  for (const params::Record& record : table)
    if (value_of(record) > 0 && record.key != kReferenceHeight && record.range.min < record.range.max)
      axes.push_back(tune::axis_of(record, value_of(record), {}, where));
  if (axes.empty())
    throw Error(ErrorCode::usage,
                cat(where, " (", preset::method_of(stage.params), ") has no numbers above 0 to search"),
                "name one with its range: --parameters KEY=MIN:MAX");
  return axes;
}

}  // namespace aftershade::app
