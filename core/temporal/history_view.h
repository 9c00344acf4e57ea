#pragma once
#include "core/image/plane.h"

namespace aftershade::temporal {

/// History of frame i-1; its index (0, 0) is absolute pixel (min_x, min_y). All planes have one stride.
struct HistoryView {
  ConstPlaneView ao, depth, count;
  int min_x, min_y;
};

}  // namespace aftershade::temporal
