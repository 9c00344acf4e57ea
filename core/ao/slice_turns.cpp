#include "core/ao/slice_turns.h"

#include <array>
#include <cmath>
#include <span>

#include "core/image/plane.h"
#include "core/math/sampling.h"
#include "core/simd/scalar.h"

namespace aftershade::ao {

namespace {

/// Ordered dither of 3x3.
constexpr std::array<float, 9> kDither3x3 = {0 / 9.0F, 7 / 9.0F, 3 / 9.0F, 6 / 9.0F, 5 / 9.0F,
                                             2 / 9.0F, 4 / 9.0F, 1 / 9.0F, 8 / 9.0F};

std::span<const float> shares(NoiseTile tile) {
  if (tile == NoiseTile::three) return kDither3x3;
  return kBayer4x4;
}

}  // namespace

size_t SliceTurns::stride() const { return static_cast<size_t>(size_ + Plane::kPadding); }

/// Half a turn in `slices` parts, shifted by a share of a part from pixel to pixel; sample offsets have the same shares
/// in another order.
SliceTurns::SliceTurns(NoiseTile tile, int slices, double turn)
    : size_(tile == NoiseTile::three ? 3 : 4), slices_(slices) {
  const std::span<const float> share = shares(tile);
  for (int y = 0; y < size_; ++y)
    for (int which = 0; which < 1 + 2 * slices; ++which)
      for (size_t x = 0; x < stride(); ++x) {
        const size_t i = static_cast<size_t>(y * size_) + x % static_cast<size_t>(size_);
        const int k = (which - 1) / 2;
        const double turns = 0.5 * (k + static_cast<double>(share[i]) + turn - std::floor(turn)) / slices;
        const lanes::UnitVector direction = lanes::unit_vector(static_cast<float>(turns));
        const float offset = share[(5 * i + 3) % share.size()];
        values_.push_back(which == 0 ? offset : which % 2 == 1 ? direction.x : direction.y);
      }
}

}  // namespace aftershade::ao
