#pragma once
#include <optional>
#include <vector>

#include "core/params/table.h"

/// The space that a search moves in: a cube of side 1 with an axis a parameter.
namespace aftershade::tune {

/// A parameter and the part of its range that is searched.
struct Axis {
  std::string key;
  double min, max;  ///< both allowed
  bool integer = false;
  bool operator==(const Axis&) const = default;
  /// Equal steps are equal ratios, where the bounds are positive and a decade apart or more.
  bool is_logarithmic() const { return min > 0 && max >= 10 * min; }
};
using Axes = std::vector<Axis>;

/// Without bounds, what is searched reaches this factor below and above the preset's value.
inline constexpr double kReach = 4;

/// The axis of a parameter whose value in the preset is `value`: between `bounds`, or within kReach of the value as far
/// as the record's range goes. Throws Error(config): not a number, bounds outside the range or in the wrong order, no
/// bounds for a value that is not positive (a factor leads nowhere from there; 0 mostly means that something is off).
Axis axis_of(const params::Record& record, double value, std::optional<params::Range> bounds, std::string_view where);

/// The value at 0 to 1 of the axis, as a preset would have it: whole for integers, else of three significant digits.
double value_at(const Axis& axis, double position);
/// The inverse, as far as rounding allows; values beyond the bounds lie at 0 or 1.
double position_of(const Axis& axis, double value);

}  // namespace aftershade::tune
