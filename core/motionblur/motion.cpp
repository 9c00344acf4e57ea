#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/motionblur/motion.cpp"  // this file, compiled once a SIMD target
#include "core/motionblur/motion.h"

#include <hwy/foreach_target.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/motionblur/motion_kernel.h"
#include "core/parallel/rows.h"

HWY_BEFORE_NAMESPACE();
namespace aftershade::motionblur::HWY_NAMESPACE {

WithoutVector all_motion(const MotionRows& rows, Motion& out) {
  std::atomic<bool> by_camera = false, still = false;
  for_rows(out.prev_x.height(), [&](int y) {
    const MotionOut to{out.prev_x.row(y), out.prev_y.row(y), out.next_x.row(y), out.next_y.row(y)};
    const WithoutVector of_row = motion_row(rows.kernel(), rows.row(y), to);
    if (of_row.by_camera) by_camera = true;
    if (of_row.still) still = true;
  });
  return {by_camera, still};
}

/// One row of length_at().
struct Lengths {
  const Motion& motion;
  Path path;
  float back, ahead;
  int y;
  Float operator()(int x) const {
    return length_at(path, back, ahead, load(motion.prev_x.row(y) + x), load(motion.prev_y.row(y) + x),
                     load(motion.next_x.row(y) + x), load(motion.next_y.row(y) + x));
  }
};

float longest_in_row(const Lengths& lengths) {
  const int width = lengths.motion.prev_x.width();
  Float longest = 0.0F;
  for (int x = 0; x < width; x += kLanes) longest = max(select(iota(x) < Int(width), lengths(x), 0.0F), longest);
  float lanes[kLanes];
  store(lanes, longest);
  return *std::max_element(lanes, lanes + kLanes);
}

/// The longest displacement of each row, nearly.
void longest_of_rows(const Motion& motion, float back, float ahead, Path path, float* rows) {
  for_rows(motion.prev_x.height(), [&](int y) { rows[y] = longest_in_row({motion, path, back, ahead, y}); });
}

/// Calls `visit(x)` for those pixels of a row whose displacement is, nearly, `least` or longer.
void visit_longest(const Motion& motion, float back, float ahead, Path path, int y, float least,
                   const std::function<void(int)>& visit) {
  const Lengths lengths{motion, path, back, ahead, y};
  for (int x = 0; x < motion.prev_x.width(); x += kLanes) {
    const Float length = lengths(x);
    if (!any(length >= least)) continue;
    float lanes[kLanes];
    store(lanes, length);
    for (int i = 0; i < kLanes && x + i < motion.prev_x.width(); ++i)
      if (lanes[i] >= least) visit(x + i);
  }
}

}  // namespace aftershade::motionblur::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aftershade::motionblur {

namespace {

HWY_EXPORT(all_motion);
HWY_EXPORT(longest_of_rows);
HWY_EXPORT(visit_longest);

/// longest_displacement_px() of one pixel, in double.
double exact_length(const Motion& motion, double back, double ahead, Path path, int x, int y) {
  const double px = motion.prev_x(x, y), py = motion.prev_y(x, y), nx = motion.next_x(x, y), ny = motion.next_y(x, y);
  if (path == Path::separate) return std::max(back * std::hypot(px, py), ahead * std::hypot(nx, ny));
  const double longest_time = std::max(back, ahead), mean = 0.5 * longest_time * std::hypot(nx - px, ny - py);
  if (path == Path::straight) return mean;
  return mean + 0.5 * longest_time * longest_time * std::hypot(nx + px, ny + py);
}

std::array<uint32_t, 4> bits_at(const Motion& m, int x, int y) {
  return std::bit_cast<std::array<uint32_t, 4>>(
      std::array{m.prev_x(x, y), m.prev_y(x, y), m.next_x(x, y), m.next_y(x, y)});
}

}  // namespace

Motion motion_of(const MotionParams& params, const MotionSources& sources, WithoutVector* without) {
  const int width = sources.window.width(), height = sources.window.height();
  const auto blank = [&] { return Plane::for_overwrite(width, height); };
  Motion out{blank(), blank(), blank(), blank()};
  const WithoutVector found = HWY_DYNAMIC_DISPATCH(all_motion)(MotionRows(params, sources), out);
  if (without != nullptr) *without = found;
  return out;
}

float longest_displacement_px(const Motion& motion, Shutter shutter, Path path) {
  const float back = std::max(-shutter.opens, 0.0F), ahead = std::max(shutter.closes, 0.0F);
  std::vector<float> nearly(static_cast<size_t>(motion.prev_x.height()));
  if (nearly.empty()) return 0;
  HWY_DYNAMIC_DISPATCH(longest_of_rows)(motion, back, ahead, path, nearly.data());
  constexpr float kRounding = 1e-5F;
  const float least = *std::ranges::max_element(nearly) * (1 - kRounding);
  std::vector<double> exact(nearly.size());
  for_rows(motion.prev_x.height(), [&](int y) {
    const auto row = static_cast<size_t>(y);
    if (nearly[row] < least) return;
    std::array<uint32_t, 4> done{};  // a picture that moves as one has one motion
    HWY_DYNAMIC_DISPATCH(visit_longest)
    (motion, back, ahead, path, y, least, [&](int x) {
      if (bits_at(motion, x, y) == std::exchange(done, bits_at(motion, x, y))) return;
      exact[row] = std::max(exact[row], exact_length(motion, back, ahead, path, x, y));
    });
  });
  return static_cast<float>(*std::ranges::max_element(exact));
}

Shutter shutter_of(const PathParams& params, float shutter_frames) {
  switch (params.shutter_phase) {
    case ShutterPhase::centred:
      return {-0.5F * shutter_frames, 0.5F * shutter_frames};
    case ShutterPhase::start:
      return {0, shutter_frames};
    case ShutterPhase::end:
      return {-shutter_frames, 0};
    case ShutterPhase::custom:
      break;
  }
  return {params.shutter_opens_frames, params.shutter_opens_frames + shutter_frames};
}

}  // namespace aftershade::motionblur
#endif
