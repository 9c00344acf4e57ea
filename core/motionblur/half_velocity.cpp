#include "core/motionblur/half_velocity.h"

#include <algorithm>
#include <cmath>

#include "core/motionblur/half_velocity_kernel.h"
#include "core/parallel/rows.h"

namespace aftershade::motionblur {

namespace {

VelocityRow row_of(ConstPlaneView x, ConstPlaneView y, int row) {
  if (x.data == nullptr || y.data == nullptr) return {nullptr, nullptr};
  return {x.row(row), y.row(row)};
}

}  // namespace

HalfVelocity half_velocity(ConstPlaneView prev_x, ConstPlaneView prev_y, ConstPlaneView next_x, ConstPlaneView next_y,
                           float shutter_frames, float max_radius) {
  const ConstPlaneView size = next_x.data != nullptr ? next_x : prev_x;
  HalfVelocity out{Plane(size.width, size.height), Plane(size.width, size.height)};
  const HalfVelocityKernel kernel{0.5F * shutter_frames, max_radius};
  for_rows(size.height, [&](int y) {
    half_velocity_row(kernel, row_of(prev_x, prev_y, y), row_of(next_x, next_y, y), size.width, out.x.row(y),
                      out.y.row(y));
  });
  return out;
}

HalfVelocity half_velocity(const Motion& motion, float shutter_frames, float max_radius) {
  return half_velocity(motion.prev_x, motion.prev_y, motion.next_x, motion.next_y, shutter_frames, max_radius);
}

HalfVelocity at_8_bits(const HalfVelocity& velocity, float max_radius) {
  const int width = velocity.x.width(), height = velocity.x.height();
  HalfVelocity out{Plane(width, height), Plane(width, height)};
  for_rows(height, [&](int y) {
    at_8_bits_row(velocity.x.row(y), max_radius, width, out.x.row(y));
    at_8_bits_row(velocity.y.row(y), max_radius, width, out.y.row(y));
  });
  return out;
}

float longest_px(const HalfVelocity& velocity) {
  float longest = 0;
  for (int y = 0; y < velocity.x.height(); ++y)
    for (int x = 0; x < velocity.x.width(); ++x) {
      const float vx = velocity.x(x, y), vy = velocity.y(x, y);
      longest = std::max(longest, vx * vx + vy * vy);
    }
  return std::sqrt(longest);
}

}  // namespace aftershade::motionblur
