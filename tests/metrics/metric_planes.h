#pragma once
#include <vector>

#include "core/image/plane.h"

namespace aftershade::metrics {

inline Plane plane_of(int width, const std::vector<float>& values) {
  Plane plane(width, static_cast<int>(values.size()) / width);
  for (size_t i = 0; i < values.size(); ++i)
    plane(static_cast<int>(i) % width, static_cast<int>(i) / width) = values[i];
  return plane;
}

}  // namespace aftershade::metrics
