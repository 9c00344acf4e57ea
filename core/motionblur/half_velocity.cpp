#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/half_velocity.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/half_velocity.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "core/motionblur/half_velocity_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

VelocityRow row_of(ConstPlaneView x, ConstPlaneView y, int row) {
  if (x.data == nullptr || y.data == nullptr) return {nullptr, nullptr};
  return {x.row(row), y.row(row)};
}

void of_vectors(const ConstPlaneView (&prev)[2], const ConstPlaneView (&next)[2], float shutter_frames,
                float max_radius, HalfVelocity& out) {
  for_rows(out.x.height(), [&](int y) {
    half_velocity_row({0.5F * shutter_frames, max_radius}, row_of(prev[0], prev[1], y), row_of(next[0], next[1], y),
                      out.x.width(), out.x.row(y), out.y.row(y));
  });
}

WithoutVector of_sources(const MotionRows& rows, float shutter_frames, float max_radius, HalfVelocity& out) {
  std::atomic<bool> by_camera = false, still = false;
  for_rows(out.x.height(), [&](int y) {
    const WithoutVector of_row =
        half_velocity_row({0.5F * shutter_frames, max_radius}, rows.kernel(), rows.row(y), out.x.row(y), out.y.row(y));
    if (of_row.by_camera) by_camera = true;
    if (of_row.still) still = true;
  });
  return {by_camera, still};
}

void through_8_bits(const HalfVelocity& velocity, float max_radius, HalfVelocity& out) {
  const int width = velocity.x.width();
  for_rows(velocity.x.height(), [&](int y) {
    at_8_bits_row(velocity.x.row(y), max_radius, width, out.x.row(y));
    at_8_bits_row(velocity.y.row(y), max_radius, width, out.y.row(y));
  });
}

void longest_squares(const HalfVelocity& velocity, float* rows) {
  for_rows(velocity.x.height(),
           [&](int y) { rows[y] = longest_square(velocity.x.row(y), velocity.y.row(y), velocity.x.width()); });
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

namespace {

HWY_EXPORT(of_vectors);
HWY_EXPORT(of_sources);
HWY_EXPORT(through_8_bits);
HWY_EXPORT(longest_squares);

HalfVelocity blank(int width, int height) {
  return {Plane::for_overwrite(width, height), Plane::for_overwrite(width, height)};
}

}  // namespace

HalfVelocity half_velocity(ConstPlaneView prev_x, ConstPlaneView prev_y, ConstPlaneView next_x, ConstPlaneView next_y,
                           float shutter_frames, float max_radius) {
  const ConstPlaneView size = next_x.data != nullptr ? next_x : prev_x;
  HalfVelocity out = blank(size.width, size.height);
  HWY_DYNAMIC_DISPATCH(of_vectors)({prev_x, prev_y}, {next_x, next_y}, shutter_frames, max_radius, out);
  return out;
}

HalfVelocity half_velocity(const Motion& motion, float shutter_frames, float max_radius) {
  return half_velocity(motion.prev_x, motion.prev_y, motion.next_x, motion.next_y, shutter_frames, max_radius);
}

HalfVelocity half_velocity(const MotionParams& params, const MotionSources& sources, float shutter_frames,
                           float max_radius, WithoutVector* without) {
  HalfVelocity out = blank(sources.window.width(), sources.window.height());
  const WithoutVector found =
      HWY_DYNAMIC_DISPATCH(of_sources)(MotionRows(params, sources), shutter_frames, max_radius, out);
  if (without != nullptr) *without = found;
  return out;
}

HalfVelocity at_8_bits(const HalfVelocity& velocity, float max_radius) {
  HalfVelocity out = blank(velocity.x.width(), velocity.x.height());
  HWY_DYNAMIC_DISPATCH(through_8_bits)(velocity, max_radius, out);
  return out;
}

float longest_px(const HalfVelocity& velocity) {
  std::vector<float> rows(static_cast<size_t>(velocity.x.height()));
  if (rows.empty()) return 0;
  HWY_DYNAMIC_DISPATCH(longest_squares)(velocity, rows.data());
  return std::sqrt(*std::ranges::max_element(rows));
}

}  // namespace aftershade::motionblur
#endif
