#include "core/motionblur/gather.h"

#include <algorithm>
#include <cmath>

#include "core/filter/surface.h"

namespace aftershade::motionblur {

int radius_at(float radius_px, float reference_height_px, int display_height) {
  return std::max(1, static_cast<int>(std::ceil(filter::scaled_px(radius_px, reference_height_px, display_height))));
}

}  // namespace aftershade::motionblur
