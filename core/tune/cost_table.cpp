#include "core/tune/cost_table.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::tune {

namespace {

double ms_of(const Measured& measured) { return measured.cost.milliseconds; }
double bytes_of(const Measured& measured) { return measured.cost.bytes; }

/// log2 of the cost at `value`, interpolated between the curve's.
double log_cost(const CostCurve& curve, double value, double (*cost_of)(const Measured&)) {
  const std::vector<double>& values = curve.values;
  const auto log_at = [&](size_t i) { return std::log2(cost_of(curve.costs[i])); };
  if (value <= values.front()) return log_at(0);
  if (value >= values.back()) return log_at(values.size() - 1);
  const auto above = static_cast<size_t>(std::ranges::upper_bound(values, value) - values.begin());
  const auto x = [&](double v) { return values.front() > 0 ? std::log2(v) : v; };
  const double t = (x(value) - x(values[above - 1])) / (x(values[above]) - x(values[above - 1]));
  return log_at(above - 1) + t * (log_at(above) - log_at(above - 1));
}

double least(const CostCurve& curve, double (*cost_of)(const Measured&)) {
  double least = cost_of(curve.costs.front());
  for (const Measured& measured : curve.costs) least = std::min(least, cost_of(measured));
  return least;
}

}  // namespace

Cost CostTable::predict(const std::map<std::string, double>& values) const {
  double log_ms = 0, log_bytes = 0;
  for (const CostCurve& curve : curves) {
    const auto value = values.find(curve.key);
    if (value == values.end()) continue;
    const double at_base = base.at(curve.key).get<double>();
    const auto log_ratio = [&](double (*cost_of)(const Measured&)) {
      return log_cost(curve, value->second, cost_of) - log_cost(curve, at_base, cost_of);
    };
    if (curve.time_varies) log_ms += log_ratio(ms_of);
    if (curve.memory_varies) log_bytes += log_ratio(bytes_of);
  }
  return {cost.cost.milliseconds * std::exp2(log_ms), cost.cost.bytes * std::exp2(log_bytes)};
}

Cost CostTable::cheapest() const {
  Cost out = cost.cost;
  for (const CostCurve& curve : curves) {
    if (curve.time_varies) out.milliseconds *= least(curve, ms_of) / ms_of(cost);
    if (curve.memory_varies) out.bytes *= least(curve, bytes_of) / bytes_of(cost);
  }
  return out;
}

void judge_noise(CostTable& table) {
  constexpr double kTime = 0.03, kClock_ms = 0.01, kMemory = 0.01;
  const double ms = ms_of(table.cost), bytes = bytes_of(table.cost);
  for (CostCurve& curve : table.curves)
    for (const Measured& m : curve.costs) {
      const double noise_ms = kTime * ms + kClock_ms + m.spread_ms + table.cost.spread_ms;
      curve.time_varies = curve.time_varies || std::abs(ms_of(m) - ms) > noise_ms;
      curve.memory_varies = curve.memory_varies || std::abs(bytes_of(m) - bytes) > kMemory * bytes;
    }
}

void check_fits(const CostTable& table, const CostTable& wanted, const Axes& axes, std::string_view where) {
  const auto differs = [&](std::string_view what, const auto& has, const auto& wants, const std::string& hint) {
    if (has != wants)
      throw Error(ErrorCode::config, cat(where, ": the costs were measured with ", what, " ", has, ", not ", wants),
                  hint);
  };
  const std::string again = "leave out --cost-table to measure again";
  differs("stage", table.stage, wanted.stage, again);
  differs("method", table.method, wanted.method, again);
  differs("frames of width", table.width, wanted.width, again);
  differs("frames of height", table.height, wanted.height, again);
  differs("--threads", table.threads, wanted.threads, cat("--threads ", table.threads, ", or ", again));
  const auto curve_of = [&](const std::string& key) {
    return std::ranges::find_if(table.curves, [&](const CostCurve& curve) { return curve.key == key; });
  };
  for (const auto& [key, value] : wanted.base.items())
    if (curve_of(key) == table.curves.end())
      differs(key, table.base.value(key, params::Json()).dump(), value.dump(), again);
  for (const Axis& axis : axes) {
    const auto curve = curve_of(axis.key);
    if (curve == table.curves.end() || axis.min < curve->values.front() || axis.max > curve->values.back())
      throw Error(ErrorCode::config,
                  cat(where, ": the costs were not measured for ", axis.key, " from ", axis.min, " to ", axis.max),
                  again);
  }
}

}  // namespace aftershade::tune
