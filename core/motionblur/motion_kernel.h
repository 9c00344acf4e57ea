#pragma once
#include "core/filter/static_motion.h"
#include "core/motionblur/motion.h"
#include "core/simd/lanes.h"

/// The motion of one row of pixels.
namespace aftershade::motionblur {

/// One row of vectors; null pointers: unknown everywhere.
struct VelocityRow {
  const float *x, *y;
};

struct MotionKernel {
  float camera_share, object_share;
  bool split;                  ///< do the shares differ from 1?
  float min_speed, max_speed;  ///< px per frame; max_speed may be infinite
  float added_x, added_y, added_zoom;
  float centre_x;  ///< of the display window, from the first pixel's left edge
};

struct MotionRow {
  VelocityRow prev, next;
  const filter::StaticMotion *before, *after;  ///< null: unknown camera
  const float* depth;                          ///< read if a camera is known
  VelocityRow added;
  const float* mask;  ///< null: 1 everywhere
  int min_x, width;
  float from_centre_y;  ///< of the row's pixel centres, from the display window's
  float *prev_x, *prev_y, *next_x, *next_y;
};

namespace detail {
using namespace lanes;

/// A displacement as long as this is a sentinel, not a motion; its square still is a float.
inline constexpr float kSentinel_px = 1e15F;

struct Displacement {
  Float x, y;
  Mask known;
};

inline Displacement displacement_of(Float x, Float y) {
  const Mask known = (abs(x) < kSentinel_px) & (abs(y) < kSentinel_px);
  return {select(known, x, 0.0F), select(known, y, 0.0F), known};
}
inline Displacement load_displacement(VelocityRow row, int i) {
  if (row.x == nullptr || row.y == nullptr) return {0.0F, 0.0F, Float(0.0F) > Float(0.0F)};
  return displacement_of(load(row.x + i), load(row.y + i));
}
inline Displacement first_known(Displacement a, Displacement b) {
  return {select(a.known, a.x, b.x), select(a.known, a.y, b.y), a.known | b.known};
}
inline Displacement reversed(Displacement d) { return {-d.x, -d.y, d.known}; }

struct BothWays {
  Displacement prev, next;
};
/// A surface of which one vector is known moves evenly.
inline BothWays completed(BothWays d) {
  return {first_known(d.prev, reversed(d.next)), first_known(d.next, reversed(d.prev))};
}

inline Displacement camera_displacement(const filter::StaticMotion* camera, Float x, Float z) {
  if (camera == nullptr) return load_displacement({nullptr, nullptr}, 0);
  const filter::Point moved = filter::select(filter::is_surface(z), filter::static_displacement(*camera, x, z),
                                             filter::background_displacement(*camera, x));
  return displacement_of(moved.x, moved.y);
}

/// Renderers write 0 where they have no vector, in the background above all (Cycles does).
inline Displacement unless_background(Displacement d, Float z) {
  return {d.x, d.y, d.known & (filter::is_surface(z) | (abs(d.x) + abs(d.y) > 0.0F))};
}

/// camera share * camera + object share * (all - camera).
inline Displacement shared_out(const MotionKernel& k, Displacement all, Displacement camera) {
  return {k.camera_share * camera.x + k.object_share * (all.x - camera.x),
          k.camera_share * camera.y + k.object_share * (all.y - camera.y), all.known};
}

inline Float finite_or_zero(Float v) { return select(abs(v) < kSentinel_px, v, 0.0F); }

/// Artificial velocity (slide "Scalability and Implementation"): forward motion of the surface.
inline Displacement added_motion(const MotionKernel& k, const MotionRow& row, int i) {
  const Float from_centre_x = to_float(iota(i)) + (0.5F - k.centre_x);
  Float x = k.added_x + k.added_zoom * from_centre_x, y = k.added_y + k.added_zoom * row.from_centre_y;
  if (row.added.x != nullptr) x += finite_or_zero(load(row.added.x + i));
  if (row.added.y != nullptr) y += finite_or_zero(load(row.added.y + i));
  if (row.mask == nullptr) return displacement_of(x, y);
  const Float share = finite_or_zero(load(row.mask + i));
  return displacement_of(share * x, share * y);
}

/// By which both vectors are multiplied.
inline Float limit_factor(const MotionKernel& k, const BothWays& d) {
  const Float speed = sqrt(max(d.prev.x * d.prev.x + d.prev.y * d.prev.y, d.next.x * d.next.x + d.next.y * d.next.y));
  const Float shortened = select(speed > k.max_speed, k.max_speed / speed, 1.0F);
  return select(speed < k.min_speed, 0.0F, shortened);
}

}  // namespace detail

inline WithoutVector motion_row(const MotionKernel& k, const MotionRow& row) {
  using namespace lanes;
  using namespace detail;
  WithoutVector without;
  for (int i = 0; i < row.width; i += kLanes) {
    BothWays d{load_displacement(row.prev, i), load_displacement(row.next, i)};
    BothWays camera = d;
    if (row.before != nullptr || row.after != nullptr) {
      const Float x = to_float(iota(row.min_x + i)) + 0.5F, z = load(row.depth + i);
      d = completed({unless_background(d.prev, z), unless_background(d.next, z)});
      camera = completed({camera_displacement(row.before, x, z), camera_displacement(row.after, x, z)});
    } else {
      d = completed(d);
      camera.prev = camera.next = load_displacement({nullptr, nullptr}, 0);
    }
    const Mask lone = (!d.prev.known) & (iota(i) < Int(row.width));
    without.by_camera = without.by_camera || any(lone & camera.prev.known);
    without.still = without.still || any(lone & (!camera.prev.known));
    d = {first_known(d.prev, camera.prev), first_known(d.next, camera.next)};
    if (k.split) d = {shared_out(k, d.prev, camera.prev), shared_out(k, d.next, camera.next)};
    const Displacement added = added_motion(k, row, i);
    d = {{d.prev.x - added.x, d.prev.y - added.y, d.prev.known},
         {d.next.x + added.x, d.next.y + added.y, d.next.known}};
    const Float factor = limit_factor(k, d);
    store(row.prev_x + i, d.prev.x * factor);
    store(row.prev_y + i, d.prev.y * factor);
    store(row.next_x + i, d.next.x * factor);
    store(row.next_y + i, d.next.y * factor);
  }
  return without;
}

}  // namespace aftershade::motionblur
