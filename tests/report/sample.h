#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/report/comparison.h"

/// Made-up comparisons: no preset was run for them.
namespace aftershade::tests {

struct SampleOptions {
  std::vector<std::string> presets{"high-dx11", "high-current-gen", "offline", "soma"};  ///< shipped ones
  int frames = 12;
  int shown = 4;  ///< frames with pictures
  bool reference = true, cost = true, detail = true;
  Window display{16, 8, 16 + 639, 8 + 359};
};
report::Comparison sample_comparison(const SampleOptions& options = {});

/// What the pictures of the sample hold: red, green, blue of picture `index` at the display window's pixel (x, y).
std::array<unsigned char, 3> sample_pixel(int frame, size_t index, int x, int y);

}  // namespace aftershade::tests
