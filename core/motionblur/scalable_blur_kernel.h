// The gather of Vicarious Visions' motion blur (seed 004), one row.
#if defined(AFTERSHADE_CORE_MOTIONBLUR_SCALABLE_BLUR_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_SCALABLE_BLUR_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_SCALABLE_BLUR_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_SCALABLE_BLUR_KERNEL_H
#endif
#include "core/math/sampling.h"
#include "core/motionblur/gather_kernel.h"
#include "core/motionblur/motion_rows.h"
#include "core/motionblur/scalable_blur_params.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

/// Below it the direction of a velocity says nothing (algorithms 2.4, G3D's threshold).
inline constexpr float kLeastDirection_px = 1.5F;

/// The row's own data: the velocity v_C of the pixels, v_N of the tiles around each pixel, and of its own tile.
struct ScalableBlurRow {
  VelocityRow own, neighbourhood, tile;
};

/// How far the sample lies behind the centre, in depth extents. Slides: over a soft extent; Guertin et al. 2014: as a
/// share of the nearer depth (algorithms 3.1).
inline Float behind_by(const ScalableBlurKernel& k, Float centre_depth, Float sample_depth) {
  const Float difference = sample_depth - centre_depth;
  return k.relative ? difference / min(centre_depth, sample_depth) : difference * k.inverse_soft_extent;
}

/// Slides "Foreground vs. Background" to "Mutually Blurry Samples": the cases are not exclusive, the third is mixed in.
/// Paper and slides differ in the sign of z; with positive z, F = sat(1 - (z_S - z_C) / E), B the reverse (algorithms
/// 14 no. 20).
inline Float tap_weight(const ScalableBlurKernel& k, Float centre_speed, Float centre_depth, const Tap& sample,
                        Float distance) {
  const Order order = soft_order(behind_by(k, centre_depth, sample.depth));
  const Float background = order.behind * cone(distance, centre_speed);
  const Float foreground = order.before * cone(distance, sample.speed);
  const Mask both_moving = (sample.speed >= distance) & (centre_speed >= distance);
  return k.background_weight * background + k.foreground_weight * foreground +
         select(both_moving, Float(k.both_moving_weight), Float(0.0F));
}

/// Jitter is the same every so many pixels.
inline constexpr int kJitterPeriod_px = 4;

/// In (-0.5, 0.5), a share of the tap spacing. Slides: checkerboard (its +-1/4 is G3D's, algorithms 2.3), or 4x4. Every
/// further pass shifts it by an even share of the spacing.
inline Float jitter_of(const ScalableBlurKernel& k, int x, int y, int pass) {
  const Int column = iota(x) + Int(k.origin_x), row = Int(y) + Int(k.origin_y);
  const Float first = k.checkerboard ? 0.5F * to_float((column + row) & Int(1)) - 0.25F
                                     : gather(kBayer4x4.data(), ((row & Int(3)) << 2) + (column & Int(3))) - 0.5F;
  if (pass == 0) return first;
  const Float shifted = first + static_cast<float>(pass) / static_cast<float>(k.passes);
  return select(shifted < 0.5F, shifted, shifted - 1.0F);
}

/// A velocity's direction with the neighbourhood's length, where it has a direction (algorithms 2.4, 14 no. 19); else
/// the neighbourhood's.
inline Vector directed(VelocityRow row, int x, Vector neighbourhood, Float search_length) {
  const Vector v{load(row.x + x), load(row.y + x)};
  const Float speed = length(v);
  const Mask known = speed >= kLeastDirection_px;
  const Float scale = search_length / max(speed, kLeastDirection_px);
  return {select(known, v.x * scale, neighbourhood.x), select(known, v.y * scale, neighbourhood.y)};
}

/// From one end of a search to its middle.
struct Direction {
  Vector v;
  Float length;
};

/// What the taps are taken along, and in which order.
struct Search {
  Direction neighbourhood, centre, tile;
  Directions directions;
  const Direction& of_tap(int i, int middle) const {
    const int steps = i < middle ? middle - i : i - middle;
    if (directions == Directions::three) return steps % 3 == 1 ? neighbourhood : steps % 3 == 2 ? centre : tile;
    return directions != Directions::neighbourhood && (i & 1) != 0 ? centre : neighbourhood;
  }
};
inline Search search_of(Directions directions, const ScalableBlurRow& row, int x) {
  const Vector v{load(row.neighbourhood.x + x), load(row.neighbourhood.y + x)};
  const Direction n{v, length(v)};
  Search search{n, n, n, directions};
  if (directions == Directions::alternate_literal) {
    const Vector own{load(row.own.x + x), load(row.own.y + x)};
    search.centre = {own, length(own)};
  } else if (directions != Directions::neighbourhood) {
    search.centre.v = directed(row.own, x, v, n.length);
  }
  if (directions == Directions::three) search.tile.v = directed(row.tile, x, v, n.length);
  return search;
}

/// The distance of a tap is that of the place, not of the pixel that is read there, as in the slides, which do not
/// round; it is also what algorithms 3.5 was computed with.
inline Gathered one_pass(const ScalableBlurKernel& k, const GatherRow& row, const Search& search, const Tap& centre,
                         Float jitter, int x) {
  const int middle = (k.taps - 1) / 2;
  const Float spacing = 2.0F / static_cast<float>(k.taps + 1);
  Gathered sum = gathered(centre, k.centre_weight / centre.speed);  // algorithms 2.2: w = 1 / |V[X]|
  for (int i = 0; i < k.taps; ++i) {
    if (i == middle) continue;
    // algorithms 2.2: mix(-1, 1, (i + j + 1) / (S + 1))
    const Float t = (Float(static_cast<float>(i - middle)) + jitter) * spacing;
    const Direction& along = search.of_tap(i, middle);
    const Tap tap = tap_at(row, x, {along.v.x * t, along.v.y * t});
    add(tap, tap_weight(k, centre.speed, centre.depth, tap, along.length * abs(t)), sum);
  }
  return sum;
}

/// The mean of all passes.
inline Gathered all_passes(const ScalableBlurKernel& k, const GatherRow& row, const Search& search, const Tap& centre,
                           Float jitter, int x) {
  Gathered sum = one_pass(k, row, search, centre, jitter, x);
  if (k.passes == 1) return sum;
  Quad difference{0.0F, 0.0F, 0.0F, 0.0F};
  for (int pass = 0; pass < k.passes; ++pass) {
    if (pass > 0) sum = one_pass(k, row, search, centre, jitter_of(k, x, row.y, pass), x);
    difference.a += sum.difference.a / sum.weight;
    difference.b += sum.difference.b / sum.weight;
    difference.c += sum.difference.c / sum.weight;
    difference.d += sum.difference.d / sum.weight;
  }
  return {sum.centre, difference, static_cast<float>(k.passes)};
}

/// Blurs some columns of a row. Pixels that do not move are left as they are.
inline void scalable_blur_row(const ScalableBlurKernel& k, const GatherRow& row, const ScalableBlurRow& velocities,
                              Columns columns) {
  Float jitter = jitter_of(k, columns.first, row.y, 0);
  for (int x = columns.first; x < columns.last; x += kLanes) {
    const Search search = search_of(k.directions, velocities, x);
    const Mask fast = search.neighbourhood.length > kLeastRadius_px;  // slide "Current Gen Implementation": branch
    if (!any(fast)) continue;
    const Tap centre = centre_at(row, x);
    const Mask moving = fast & centre.usable;
    if (!any(moving)) continue;
    if (kLanes % kJitterPeriod_px != 0) jitter = jitter_of(k, x, row.y, 0);
    store_mean(row, all_passes(k, row, search, centre, jitter, x), moving, x);
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
