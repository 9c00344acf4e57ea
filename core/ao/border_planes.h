#pragma once
#include <array>
#include <vector>

#include "core/filter/surface.h"

namespace aftershade::ao {

/// The plane that a border pixel's surface is: 1 / z (in orthographic views z) = a slope_x + b slope_y + c, slopes
/// those of a pixel's ray; 0 where there is no surface.
using BorderPlane = std::array<float, 3>;

/// Of the first row, the last row, the first column and the last column.
std::vector<BorderPlane> border_planes(const filter::Surface& surface);

}  // namespace aftershade::ao
