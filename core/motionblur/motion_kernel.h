// The motion of one row of pixels.
#if defined(AFTERSHADE_CORE_MOTIONBLUR_MOTION_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef AFTERSHADE_CORE_MOTIONBLUR_MOTION_KERNEL_H
#undef AFTERSHADE_CORE_MOTIONBLUR_MOTION_KERNEL_H
#else
#define AFTERSHADE_CORE_MOTIONBLUR_MOTION_KERNEL_H
#endif
#include "core/filter/static_motion_lanes.h"
#include "core/motionblur/motion_rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

using namespace lanes::HWY_NAMESPACE;
using namespace filter::HWY_NAMESPACE;

/// A displacement as long as this is a sentinel, not a motion; its square still is a float.
inline constexpr float kSentinel_px = 1e15F;

inline Mask nowhere() { return Float(0.0F) > Float(0.0F); }

struct Displacement {
  Float x, y;
  Mask known;
};

inline Displacement displacement_of(Float x, Float y) {
  const Mask known = (abs(x) < kSentinel_px) & (abs(y) < kSentinel_px);
  return {select(known, x, 0.0F), select(known, y, 0.0F), known};
}
inline Displacement load_displacement(VelocityRow row, int i) {
  if (row.x == nullptr || row.y == nullptr) return {0.0F, 0.0F, nowhere()};
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

inline Displacement camera_displacement(const std::optional<filter::StaticMotion>& camera, Float x, Float z) {
  if (!camera) return {0.0F, 0.0F, nowhere()};
  const Point moved = select(is_surface(z), static_displacement(*camera, x, z), background_displacement(*camera, x));
  return displacement_of(moved.x, moved.y);
}

/// Renderers write 0 where they have no vector, in the background above all (Cycles does).
inline Displacement unless_background(Displacement d, Float z) {
  return {d.x, d.y, d.known & (is_surface(z) | (abs(d.x) + abs(d.y) > 0.0F))};
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

/// What was found of pixels without a vector.
struct Lone {
  Mask by_camera, still;
};
inline WithoutVector without_vector(const Lone& lone) { return {any(lone.by_camera), any(lone.still)}; }

/// The motion of pixels i, i + 1, ...
inline BothWays motion_at(const MotionKernel& k, const MotionRow& row, int i, Lone& lone) {
  BothWays d{load_displacement(row.prev, i), load_displacement(row.next, i)};
  const Displacement unknown{0.0F, 0.0F, nowhere()};
  BothWays camera{unknown, unknown};
  if (row.before || row.after) {
    const Float x = to_float(iota(row.min_x + i)) + 0.5F, z = load(row.depth + i);
    d = completed({unless_background(d.prev, z), unless_background(d.next, z)});
    camera = completed({camera_displacement(row.before, x, z), camera_displacement(row.after, x, z)});
  } else {
    d = completed(d);
  }
  const Mask alone = (!d.prev.known) & (iota(i) < Int(row.width));
  lone.by_camera = lone.by_camera | (alone & camera.prev.known);
  lone.still = lone.still | (alone & !camera.prev.known);
  d = {first_known(d.prev, camera.prev), first_known(d.next, camera.next)};
  if (k.split) d = {shared_out(k, d.prev, camera.prev), shared_out(k, d.next, camera.next)};
  const Displacement added = added_motion(k, row, i);
  d = {{d.prev.x - added.x, d.prev.y - added.y, d.prev.known}, {d.next.x + added.x, d.next.y + added.y, d.next.known}};
  const Float factor = limit_factor(k, d);
  return {{d.prev.x * factor, d.prev.y * factor, d.prev.known}, {d.next.x * factor, d.next.y * factor, d.next.known}};
}

/// What motion_at() gives for a whole row.
struct MotionOut {
  float *prev_x, *prev_y, *next_x, *next_y;
};
inline WithoutVector motion_row(const MotionKernel& k, const MotionRow& row, const MotionOut& out) {
  Lone lone{nowhere(), nowhere()};
  for (int i = 0; i < row.width; i += kLanes) {
    const BothWays d = motion_at(k, row, i, lone);
    store(out.prev_x + i, d.prev.x);
    store(out.prev_y + i, d.prev.y);
    store(out.next_x + i, d.next.x);
    store(out.next_y + i, d.next.y);
  }
  return without_vector(lone);
}

/// The length of longest_displacement_px() to within a few roundings. `back`, `ahead`: >= 0, frames.
inline Float length_at(Path path, float back, float ahead, Float px, Float py, Float nx, Float ny) {
  const auto length = [](Float x, Float y) { return sqrt(x * x + y * y); };
  if (path == Path::separate) return max(back * length(px, py), ahead * length(nx, ny));
  const float longest = back > ahead ? back : ahead;
  const Float mean = 0.5F * longest * length(nx - px, ny - py);
  return path == Path::straight ? mean : mean + 0.5F * longest * longest * length(nx + px, ny + py);
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
