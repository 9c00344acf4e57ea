#pragma once
#include <string_view>
#include <vector>

#include "tests/support/scene.h"

namespace aftershade::tests {

/// The scenes, each meant for frames 1 to 8 and useful beyond:
/// corner, columns, grass, trail, crossing, garden (see their descriptions).
const std::vector<Scene>& scenes();
/// Throws Error(usage) that lists the scenes when there is none of this name.
const Scene& find_scene(std::string_view name);

Scene garden_scene();

/// Blades of grass: `count` ribbons of three bent pieces on the ground of the rectangle x0..x1, z0..z1, hashed by
/// `seed`.
struct Lawn {
  double x0, x1, z0, z1;
  int count;
  double height_m = 0.3, width_m = 0.012;
  uint32_t seed = 1;
};
void add_lawn(std::vector<Object>& objects, const Lawn& lawn);

}  // namespace aftershade::tests
