#pragma once
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/image/plane.h"
#include "core/simd/targets.h"

/// Results on every SIMD target of this machine against those of the one-lane twin.
namespace aftershade::tests {

/// Where two lists of planes differ first, bit by bit, any NaN being like any other; "" when they do not.
inline std::string first_difference(const std::vector<Plane>& twin, const std::vector<Plane>& tested) {
  if (twin.size() != tested.size()) return "numbers of planes differ";
  for (size_t i = 0; i < twin.size(); ++i) {
    if (twin[i].width() != tested[i].width() || twin[i].height() != tested[i].height()) return "sizes differ";
    for (int y = 0; y < twin[i].height(); ++y)
      for (int x = 0; x < twin[i].width(); ++x) {
        const float a = twin[i](x, y), b = tested[i](x, y);
        if (std::bit_cast<uint32_t>(a) != std::bit_cast<uint32_t>(b) && !(std::isnan(a) && std::isnan(b)))
          return cat("plane ", i, " (", x, ", ", y, "): ", a, " and ", b);
      }
  }
  return "";
}

inline void expect_same(const std::string& name, const std::function<std::vector<Plane>()>& make) {
  lanes::force_target("scalar");
  const std::vector<Plane> twin = make();
  for (const std::string& target : lanes::targets()) {
    lanes::force_target(target);
    EXPECT_EQ(first_difference(twin, make()), "") << name << " on " << target;
  }
  lanes::force_target(lanes::targets().front());
}

}  // namespace aftershade::tests
