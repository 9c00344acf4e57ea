#pragma once
#include <string_view>

namespace aftershade {

/// Metres in one unit of length: "m", "cm", "mm", "ft" or a positive factor such as "0.0254".
/// Throws Error(usage) for anything else.
double metres_per_unit(std::string_view unit);

}  // namespace aftershade
