#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aftershade::tests {

/// An 8-bit RGB picture, three values a pixel.
struct Png {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;
  std::vector<std::string> chunks;  ///< types in file order

  std::array<int, 3> at(int x, int y) const {
    const size_t i = 3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
  }
};

/// Reads an 8-bit RGB PNG without interlace, by the specification and without the library that wrote it
/// (ISO/IEC 15948). Throws std::runtime_error.
Png read_png(const std::string& path);

}  // namespace aftershade::tests
