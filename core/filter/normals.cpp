#include "core/filter/normals.h"

#include "core/filter/normals_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::filter {

Normals normals_from_depth(ConstPlaneView depth, const Projection& projection) {
  Normals out;
  for (Plane& plane : out) plane = Plane(depth.width, depth.height);
  for_rows(depth.height, [&](int y) {
    normals_row(
        {Samples(depth), Lens(projection), projection.fx, projection.fy, out[0].row(y), out[1].row(y), out[2].row(y)},
        y);
  });
  return out;
}

}  // namespace aftershade::filter
