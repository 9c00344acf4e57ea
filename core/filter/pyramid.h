#pragma once
#include <vector>

#include "core/image/plane.h"

namespace aftershade::filter {

/// Depth at successively halved resolution by rotated-grid subsampling, z_{m+1}(x,y) = z_m(2x + (y&1), 2y + (x&1)),
/// clamped to the image (SAO, McGuire et al. 2012): no averages, every value is a depth that exists. Level 0 is not
/// stored: it is the image itself.
class DepthPyramid {
 public:
  DepthPyramid(ConstPlaneView depth, int levels);
  int levels() const { return static_cast<int>(mips_.size()) + 1; }
  ConstPlaneView level(int m) const { return m == 0 ? base_ : ConstPlaneView(mips_.at(static_cast<size_t>(m - 1))); }

 private:
  ConstPlaneView base_;
  std::vector<Plane> mips_;
};

}  // namespace aftershade::filter
