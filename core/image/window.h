#pragma once
#include <algorithm>

namespace aftershade {

/// A rectangle of pixels, both corners inclusive, x right and y down: EXR's meaning of a data or display window.
struct Window {
  int min_x = 0, min_y = 0, max_x = -1, max_y = -1;
  int width() const { return max_x - min_x + 1; }
  int height() const { return max_y - min_y + 1; }
  bool empty() const { return max_x < min_x || max_y < min_y; }
  bool contains(int x, int y) const { return x >= min_x && x <= max_x && y >= min_y && y <= max_y; }
  bool operator==(const Window&) const = default;
};

inline Window intersection(Window a, Window b) {
  return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
          std::min(a.max_y, b.max_y)};
}
/// The smallest window that holds both; an empty one counts for nothing.
inline Window united(Window a, Window b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x),
          std::max(a.max_y, b.max_y)};
}

}  // namespace aftershade
