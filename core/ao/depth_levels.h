// The depth pyramid as taps far from their pixel read it.
#if defined(AFTERSHADE_CORE_AO_DEPTH_LEVELS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_AO_DEPTH_LEVELS_H
#undef AFTERSHADE_CORE_AO_DEPTH_LEVELS_H
#else
#define AFTERSHADE_CORE_AO_DEPTH_LEVELS_H
#endif
#include <array>

#include "core/filter/lane_geometry.h"
#include "core/filter/pyramid.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::ao::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

inline constexpr int kLogMaxOffset = 3;  ///< SAO's LOG_MAX_OFFSET: taps nearer than 16 px read level 0

/// The depth pyramid, read so that each value is put where it was taken.
struct DepthLevels {
  Samples image;
  const float* mips;  ///< all levels but the image, in one plane
  int mip_stride, count;
  int origin_x, origin_y;  ///< absolute coordinates of level 0's index (0, 0)
  /// By level: where absolute texel (0, 0) would be in `mips`, and what puts pixels under texels (seen_through).
  std::array<int32_t, 16> first, whole, odd, even;
};

inline DepthLevels depth_levels(const filter::DepthPyramid& pyramid, bool mips) {
  const ConstPlaneView plane = pyramid.mips();
  DepthLevels out{Samples(pyramid.level(0)),
                  plane.data,
                  static_cast<int>(plane.stride),
                  mips ? std::min(pyramid.levels(), filter::kDepthLevels) : 1,
                  pyramid.origin_x(),
                  pyramid.origin_y(),
                  {},
                  {},
                  {},
                  {}};
  for (int m = 0; m < out.count; ++m) {
    const auto i = static_cast<size_t>(m);
    out.whole[i] = -(1 << m);
    for (int bit = m - 1; bit >= 0; --bit) (((m - bit) & 1) != 0 ? out.odd : out.even)[i] |= 1 << bit;
    if (m == 0) continue;
    const auto begin = static_cast<int32_t>(pyramid.level(m).data - plane.data);
    out.first[i] = begin - (pyramid.origin_y() >> m) * out.mip_stride - (pyramid.origin_x() >> m);
  }
  return out;
}

struct Texels {
  Int x, y;
};

/// The pixel whose depth level `m` has over pixel (x, y), absolute coordinates, by the walk down from level to level:
/// z_{m+1}(x,y) = z_m(2x + (y&1), 2y + (x&1)), clamped to the image.
inline Texels walked_down(const DepthLevels& depth, Int x, Int y, Int m) {
  Texels at{x >> m, y >> m};
  for (int finer = filter::kDepthLevels - 2; finer >= 0; --finer) {
    const Mask on_the_way = m >= Int(finer + 1);
    const auto step = [&](Int next, Int stay, int origin, int size) {
      return select(on_the_way, clamp(next, origin >> finer, (origin + size - 1) >> finer), stay);
    };
    const Int next_x = (at.x << 1) + (at.y & 1), next_y = (at.y << 1) + (at.x & 1);
    at = {step(next_x, at.x, depth.origin_x, depth.image.width),
          step(next_y, at.y, depth.origin_y, depth.image.height)};
  }
  return at;
}

/// The same at once where nothing is clamped: below the texel's own bits, the lowest bit of its row and that of its
/// column take turns.
inline Texels seen_through(const DepthLevels& depth, Int x, Int y, Int m) {
  const Int whole = look_up(depth.whole.data(), m), odd = look_up(depth.odd.data(), m),
            even = look_up(depth.even.data(), m);
  const Int from_x = Int(0) - ((x >> m) & 1), from_y = Int(0) - ((y >> m) & 1);  // no bit or all bits
  return {(x & whole) | (odd & from_y) | (even & from_x), (y & whole) | (odd & from_x) | (even & from_y)};
}

/// Depth over pixels inside the image, and where it was taken.
struct DepthSample {
  Int x, y;
  Float z;
};
/// What level `m` shows over pixel (x, y): the depth of one pixel below its texel.
HWY_INLINE DepthSample depth_sample(const DepthLevels& depth, Int x, Int y, Int m) {
  const Mask fine = m < Int(1);
  if (all(fine)) return {x, y, depth.image(x, y)};
  const Int absolute_x = x + Int(depth.origin_x), absolute_y = y + Int(depth.origin_y);
  Texels pixel = seen_through(depth, absolute_x, absolute_y, m);
  if (!all(depth.image.contains(pixel.x - Int(depth.origin_x), pixel.y - Int(depth.origin_y))))
    pixel = walked_down(depth, absolute_x, absolute_y, m);
  const Int texel = look_up(depth.first.data(), m) + (absolute_y >> m) * Int(depth.mip_stride) + (absolute_x >> m);
  Float z = gather(depth.mips, select(fine, Int(0), texel));
  if (any(fine)) z = select(fine, depth.image(x, y), z);
  return {pixel.x - Int(depth.origin_x), pixel.y - Int(depth.origin_y), z};
}

}  // namespace aftershade::ao::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
