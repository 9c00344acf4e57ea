#pragma once
#include <cstddef>
#include <vector>

namespace aftershade::ao {

/// The block of pixels after which the turns of the slices repeat.
enum class NoiseTile { four, three };

/// How the slices of each pixel of a tile are turned, and how its samples are shifted along them: rows that lanes load
/// from, for pixels (x, y) by their cells.
class SliceTurns {
 public:
  /// `turn`: of the whole pattern, in parts of the angle between two slices.
  SliceTurns(NoiseTile tile, int slices, double turn);
  /// Cell of an absolute coordinate.
  int cell(int absolute) const { return ((absolute % size_) + size_) % size_; }
  const float* cos(int y, int slice) const { return row(y, 1 + 2 * slice); }
  const float* sin(int y, int slice) const { return row(y, 2 + 2 * slice); }
  const float* offsets(int y) const { return row(y, 0); }  ///< in [0, 1)

 private:
  size_t stride() const;
  const float* row(int y, int which) const {
    return values_.data() + static_cast<size_t>(y * (1 + 2 * slices_) + which) * stride();
  }
  int size_, slices_;
  std::vector<float> values_;
};

}  // namespace aftershade::ao
