#include "core/tune/space.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade::tune {

namespace {

double three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  return parse_number(text).value_or(value);
}

[[noreturn]] void fail(std::string_view where, const params::Record& record, const std::string& what,
                       const std::string& hint) {
  throw Error(ErrorCode::config, cat(where, ": ", record.key, what), hint);
}

}  // namespace

Axis axis_of(const params::Record& record, double value, std::optional<params::Range> bounds, std::string_view where) {
  const bool integer = record.kind == params::Kind::integer;
  if (!integer && record.kind != params::Kind::number)
    fail(where, record, cat(" is ", params::domain_text(record), ", not a number to search"), "leave it out");
  if (!bounds) {
    if (value <= 0)
      fail(where, record, cat(" is ", value, " in the preset, from where no factor leads anywhere"),
           cat("give the range to search, such as ", record.key, "=0:1"));
    bounds = {std::max(record.range.min, value / kReach), std::min(record.range.max, value * kReach)};
    if (integer) bounds->min = std::max({record.range.min, std::floor(bounds->min), 1.0});  // 0 would be a switch
  }
  if (bounds->min < record.range.min || bounds->max > record.range.max)
    fail(where, record, cat(": ", bounds->min, " to ", bounds->max, " leaves its range ", params::domain_text(record)),
         record.doc);
  if (integer) bounds = {std::ceil(bounds->min), std::floor(bounds->max)};
  if (!(bounds->min < bounds->max))
    fail(where, record, cat(": there is nothing to search from ", bounds->min, " to ", bounds->max),
         "write KEY=MIN:MAX");
  return {record.key, bounds->min, bounds->max, integer};
}

double value_at(const Axis& axis, double position) {
  const double at = std::clamp(position, 0.0, 1.0);
  const double value =
      axis.is_logarithmic() ? axis.min * std::pow(axis.max / axis.min, at) : axis.min + (axis.max - axis.min) * at;
  return std::clamp(axis.integer ? std::round(value) : three_digits(value), axis.min, axis.max);
}

double position_of(const Axis& axis, double value) {
  const double at = axis.is_logarithmic()
                        ? std::log(std::max(value, axis.min) / axis.min) / std::log(axis.max / axis.min)
                        : (value - axis.min) / (axis.max - axis.min);
  return std::clamp(at, 0.0, 1.0);
}

}  // namespace aftershade::tune
