#include "tests/motionblur/reference_motion.h"

#include <cmath>

namespace aftershade::tests {

namespace {

using Vector = std::optional<Vec3>;

Vector vector_at(ConstPlaneView vx, ConstPlaneView vy, int x, int y) {
  if (vx.data == nullptr || vy.data == nullptr) return std::nullopt;
  if (!(std::abs(vx(x, y)) < 1e15F && std::abs(vy(x, y)) < 1e15F)) return std::nullopt;
  return Vec3(vx(x, y), vy(x, y), 0);
}

Vector camera_vector(const std::optional<CameraReprojection>& cameras, double depth, double px, double py) {
  if (!cameras) return std::nullopt;
  const Camera &now = cameras->now(), &other = cameras->before();
  const bool surface = std::isfinite(depth) && depth > 0;
  Vec3 seen = (*cameras)(px, py, depth);
  if (!surface && now.orthographic) {
    seen = other.project(transform_point(now.unproject(px, py, 0), cameras->delta()));
    seen.z = 1;
  } else if (!surface) {
    seen = other.project(transform_direction(now.unproject(px, py, 1), cameras->delta()));
  }
  if (!(seen.z > 0)) return std::nullopt;
  return Vec3(seen.x - px, seen.y - py, 0);
}

void complete(Vector& prev, Vector& next) {
  if (!prev && next) prev = -*next;
  if (!next && prev) next = -*prev;
}

double number_at(ConstPlaneView plane, int x, int y, double without) {
  if (plane.data == nullptr) return without;
  return std::isfinite(plane(x, y)) ? plane(x, y) : 0;
}

}  // namespace

MotionAt reference_motion(const motionblur::MotionParams& params, const motionblur::MotionSources& sources, int x,
                          int y) {
  const double px = sources.window.min_x + x + 0.5, py = sources.window.min_y + y + 0.5;
  Vector prev = vector_at(sources.prev_x, sources.prev_y, x, y);
  Vector next = vector_at(sources.next_x, sources.next_y, x, y);
  const bool camera = sources.depth.data != nullptr && (sources.before || sources.after);
  if (camera && !(std::isfinite(sources.depth(x, y)) && sources.depth(x, y) > 0))
    for (Vector* vector : {&prev, &next})
      if (*vector && (*vector)->length() == 0) vector->reset();
  complete(prev, next);
  Vector camera_prev, camera_next;
  if (camera) {
    camera_prev = camera_vector(sources.before, sources.depth(x, y), px, py);
    camera_next = camera_vector(sources.after, sources.depth(x, y), px, py);
    complete(camera_prev, camera_next);
  }
  const auto shared = [&](Vector all, Vector static_part) {
    const Vec3 by_camera = static_part.value_or(Vec3(0, 0, 0)), total = all ? *all : by_camera;
    return double{params.camera_motion} * by_camera + double{params.object_motion} * (total - by_camera);
  };
  MotionAt out{shared(prev, camera_prev), shared(next, camera_next)};
  const Window d = sources.display;
  Vec3 added(params.added_x_px + params.added_zoom * (px - 0.5 * (d.min_x + d.max_x + 1)),
             params.added_y_px + params.added_zoom * (py - 0.5 * (d.min_y + d.max_y + 1)), 0);
  added += Vec3(number_at(sources.added_x, x, y, 0), number_at(sources.added_y, x, y, 0), 0);
  added *= number_at(sources.added_mask, x, y, 1);
  out.prev -= added;
  out.next += added;
  const double speed = std::max(out.prev.length(), out.next.length());
  double factor = params.max_speed_px > 0 && speed > params.max_speed_px ? params.max_speed_px / speed : 1;
  if (speed < params.min_speed_px) factor = 0;
  return {out.prev * factor, out.next * factor};
}

}  // namespace aftershade::tests
