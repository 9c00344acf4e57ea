#include "core/base/units.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"

namespace aftershade {

double metres_per_unit(std::string_view unit) {
  if (unit == "m") return 1.0;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  if (unit == "ft") return 0.3048;  // international foot, exact
  const auto factor = parse_number(unit);
  if (factor && std::isfinite(*factor) && *factor > 0) return *factor;
  throw Error(ErrorCode::usage, cat("\"", unit, "\" is not a unit of length"), "use m, cm, mm, ft or metres per unit");
}

}  // namespace aftershade
