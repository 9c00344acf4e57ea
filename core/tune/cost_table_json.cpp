#include <algorithm>
#include <functional>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/tune/cost_table.h"

namespace aftershade::tune {

namespace {

using params::Json;

Json json_of(const Measured& measured) {
  return {{"milliseconds", measured.cost.milliseconds},
          {"spread_milliseconds", measured.spread_ms},
          {"bytes", measured.cost.bytes}};
}

Measured measured_of(const Json& json) {
  const Measured out{{json.at("milliseconds").get<double>(), json.at("bytes").get<double>()},
                     json.at("spread_milliseconds").get<double>()};
  if (!(out.cost.milliseconds > 0 && out.cost.bytes > 0 && out.spread_ms >= 0))
    throw Error(ErrorCode::config, "a cost is not positive");
  return out;
}

Json json_of(const CostCurve& curve) {
  Json costs = Json::array();
  for (size_t i = 0; i < curve.values.size(); ++i) {
    Json entry{{"value", curve.values[i]}};
    entry.update(json_of(curve.costs[i]));
    costs.push_back(std::move(entry));
  }
  return {{"key", curve.key},
          {"time_varies", curve.time_varies},
          {"memory_varies", curve.memory_varies},
          {"costs", std::move(costs)}};
}

CostCurve curve_of(const Json& json) {
  CostCurve curve{json.at("key").get<std::string>(),
                  {},
                  {},
                  json.at("time_varies").get<bool>(),
                  json.at("memory_varies").get<bool>()};
  for (const Json& entry : json.at("costs")) {
    curve.values.push_back(entry.at("value").get<double>());
    curve.costs.push_back(measured_of(entry));
  }
  if (curve.values.empty() || !std::ranges::is_sorted(curve.values, std::less_equal()))
    throw Error(ErrorCode::config, cat("the values of ", curve.key, " do not rise"));
  return curve;
}

CostTable table_of(const Json& json) {
  CostTable table;
  const auto text = [&](const char* key) { return json.at(key).get<std::string>(); };
  const auto whole = [&](const char* key) { return json.at(key).get<int>(); };
  table.program = text("program"), table.preset = text("preset");
  table.stage = text("stage"), table.method = text("method");
  table.base = json.at("base");
  table.width = whole("width"), table.height = whole("height");
  table.threads = whole("threads"), table.rounds = whole("rounds");
  table.cost = measured_of(json.at("cost"));
  for (const Json& curve : json.at("curves")) {
    table.curves.push_back(curve_of(curve));
    if (!table.base.at(table.curves.back().key).is_number())
      throw Error(ErrorCode::config, cat(table.curves.back().key, " has no number in the base"));
  }
  return table;
}

}  // namespace

Json to_json(const CostTable& table) {
  Json curves = Json::array();
  for (const CostCurve& curve : table.curves) curves.push_back(json_of(curve));
  return {{"program", table.program},    {"preset", table.preset},     {"stage", table.stage},
          {"method", table.method},      {"base", table.base},         {"width", table.width},
          {"height", table.height},      {"threads", table.threads},   {"rounds", table.rounds},
          {"cost", json_of(table.cost)}, {"curves", std::move(curves)}};
}

CostTable cost_table_of(const Json& json, std::string_view where) {
  return with_context(where, [&] {
    try {
      return table_of(json);
    } catch (const Json::exception&) {
      throw Error(ErrorCode::config, "this is no cost table",
                  "give the FILE.front.json that an earlier aftershade tune has written");
    }
  });
}

}  // namespace aftershade::tune
