#pragma once
#include <vector>

#include "core/filter/surface.h"
#include "core/image/plane.h"

namespace aftershade::filter {

/// Levels that AO's taps read: the image and five mips (SAO's MAX_MIP_LEVEL, algorithms 4.2).
inline constexpr int kDepthLevels = 6;

/// Depth at successively halved resolution by rotated-grid subsampling, z_{m+1}(x,y) = z_m(2x + (y&1), 2y + (x&1)),
/// clamped to the image (SAO, McGuire et al. 2012): no averages, every value is a depth that exists. Level 0 is not
/// stored: it is the image itself. x and y are absolute coordinates, so the levels of a data window that moves hold the
/// same pixels: level m's index (0, 0) is absolute texel (origin_x >> m, origin_y >> m).
class DepthPyramid {
 public:
  /// `levels` >= 1, with level 0. `origin` is the absolute coordinate of depth's index (0, 0), as in Surface.
  DepthPyramid(ConstPlaneView depth, int levels, int origin_x = 0, int origin_y = 0);
  int levels() const { return static_cast<int>(levels_.size()); }
  ConstPlaneView level(int m) const { return levels_.at(static_cast<size_t>(m)); }
  int origin_x() const { return origin_x_; }
  int origin_y() const { return origin_y_; }
  /// All levels but 0 lie in this one plane, so their strides are the same.
  ConstPlaneView mips() const { return mips_; }

 private:
  int origin_x_, origin_y_;
  Plane mips_;
  std::vector<ConstPlaneView> levels_;
};

}  // namespace aftershade::filter
