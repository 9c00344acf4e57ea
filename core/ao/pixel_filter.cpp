#include "core/ao/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/ao/depth_view.h"
#include "core/parallel/rows.h"
#include "core/simd/scalar.h"

namespace aftershade::ao {

Plane pixel_filtered(ConstPlaneView values, ConstPlaneView depth, float deviation) {
  const int reach = static_cast<int>(std::ceil(3 * deviation));
  std::vector<float> weights;
  for (int i = -reach; i <= reach; ++i) {
    constexpr float kLog2E = 1.44269504F;
    const float t = static_cast<float>(i) / deviation;
    weights.push_back(lanes::exp2_of(-0.5F * kLog2E * t * t));
  }
  Plane out = copy_of(values);
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x) {
      if (!is_surface(depth(x, y))) continue;
      float sum = 0, weight = 0;
      for (int j = std::max(-reach, -y); j <= std::min(reach, out.height() - 1 - y); ++j)
        for (int i = std::max(-reach, -x); i <= std::min(reach, out.width() - 1 - x); ++i) {
          if (!is_surface(depth(x + i, y + j))) continue;
          const float w = weights[static_cast<size_t>(reach + i)] * weights[static_cast<size_t>(reach + j)];
          sum += w * values(x + i, y + j);
          weight += w;
        }
      out(x, y) = std::min(sum / weight, 1.0F);
    }
  });
  return out;
}

}  // namespace aftershade::ao
