#pragma once
#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "core/math/sampling.h"
#include "tests/filter/analytic_surface.h"
#include "tests/support/on_all_targets.h"

/// Kernels on every SIMD target of this machine against the one-lane twin, for the tests of core/filter and core/ao.
namespace aftershade::tests {

/// Numbers in [0, 1) by pixel and `seed`.
inline Plane noise(int width, int height, uint32_t seed) {
  Plane out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      out(x, y) = static_cast<float>(hash_counters(static_cast<uint32_t>(y * width + x), seed) >> 8) * 0x1p-24F;
  return out;
}

/// Puts what files may hold in place of some values.
inline void spoil(Plane& plane, uint32_t seed) {
  constexpr float kSpecial[]{kNan, kInf, -kInf, 0.0F, -0.0F, -1.0F, 3e38F, 1e-40F};
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      const uint32_t bits = hash_counters(static_cast<uint32_t>(y * plane.width() + x), seed);
      if (bits % 16 == 0) plane(x, y) = kSpecial[(bits >> 4) % 8];
    }
}

/// Rough ground before a wall, sky above, and things that no picture should have. The window begins at odd coordinates.
inline Picture rough_picture(int width, int height, bool orthographic) {
  const Lens lens{80, 70, static_cast<float>(width) / 2, static_cast<float>(height) / 2, orthographic};
  const Plane bumps = noise(width, height, 1);
  constexpr int kOriginX = -7, kOriginY = 5;
  Picture out = picture(
      width, height, lens,
      [&](double x, double y) {
        const int column = static_cast<int>(x) - kOriginX, row = static_cast<int>(y) - kOriginY;
        if (row < height / 5) return Hit{};
        const float bump = bumps(std::clamp(column, 0, width - 1), std::clamp(row, 0, height - 1));
        return Hit{(column / 9 % 2 == 0 ? 2.0 : 3.5) + 0.2 * static_cast<double>(bump), Vec3(0.1, 0.3, -0.95)};
      },
      kOriginX, kOriginY);
  spoil(out.depth, 2);
  for (size_t i = 0; i < 3; ++i) spoil(out.normals[i], 3 + static_cast<uint32_t>(i));
  return out;
}

/// What `make` gives for rough pictures, with fewer pixels than lanes and with many, must not depend on the target.
inline void expect_same_on_all_targets(const std::string& name,
                                       const std::function<std::vector<Plane>(const Picture&)>& make) {
  for (const bool orthographic : {false, true})
    for (const auto& [width, height] : {std::pair(131, 23), std::pair(37, 9), std::pair(3, 2), std::pair(1, 1)}) {
      const Picture rough = rough_picture(width, height, orthographic);
      expect_same(cat(name, ", ", width, " x ", height), [&] { return make(rough); });
    }
}

}  // namespace aftershade::tests
