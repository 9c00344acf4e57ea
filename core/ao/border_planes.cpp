#include "core/ao/border_planes.h"

namespace aftershade::ao {

std::vector<BorderPlane> border_planes(const filter::Surface& surface) {
  const Projection& lens = surface.projection;
  const int width = surface.depth.width, height = surface.depth.height;
  std::vector<BorderPlane> planes;
  const auto add = [&](int x, int y) {
    const float z = surface.depth(x, y), nx = surface.nx(x, y), ny = surface.ny(x, y), nz = surface.nz(x, y);
    const float slope_x = (static_cast<float>(x) + 0.5F - lens.cx) / lens.fx,
                slope_y = -((static_cast<float>(y) + 0.5F - lens.cy) / lens.fy);
    const float beside = nx * slope_x + ny * slope_y, offset = z * (beside + nz);  // n . p = offset
    if (!(z > 0 && z <= 3.402823466e38F))
      planes.push_back({0, 0, 0});
    else if (lens.orthographic)
      planes.push_back({-nx / nz, -ny / nz, z + beside / nz});
    else
      planes.push_back({nx / offset, ny / offset, nz / offset});
  };
  for (const int y : {0, height - 1})
    for (int x = 0; x < width; ++x) add(x, y);
  for (const int x : {0, width - 1})
    for (int y = 0; y < height; ++y) add(x, y);
  return planes;
}

}  // namespace aftershade::ao
