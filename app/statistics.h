#pragma once
#include <cstdint>
#include <string>

#include "core/image/plane.h"

/// What inspect tells about the numbers in a frame.
namespace aftershade::app {

struct DepthStatistics {
  double min_m = 0, median_m = 0, max_m = 0;
  int64_t foreground = 0, background = 0;  ///< pixels
};
DepthStatistics depth_statistics(ConstPlaneView depth);
std::string text_of(const DepthStatistics& statistics);

struct VelocityStatistics {
  double median_px = 0, max_px = 0;  ///< of the length
  int64_t known = 0, unknown = 0;    ///< pixels
};
VelocityStatistics velocity_statistics(ConstPlaneView x, ConstPlaneView y);
std::string text_of(const VelocityStatistics& statistics);

}  // namespace aftershade::app
