#include "core/motionblur/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/math/sampling.h"
#include "core/parallel/rows.h"
#include "tests/motionblur/reference_motion.h"

namespace aftershade::tests {
namespace {

using motionblur::Motion;
using motionblur::motion_of;
using motionblur::MotionParams;
using motionblur::MotionSources;
using motionblur::Path;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
constexpr Window kDisplay{0, 0, 63, 39};

float noise(int x, int y, uint32_t index, float low, float high) {
  return low + (high - low) * unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 0, index));
}

Camera camera_at(Vec3 place_m, double turn, bool orthographic = false) {
  Camera camera = camera_from_fov(50, 1, kDisplay.min_x, kDisplay.min_y, kDisplay.width(), kDisplay.height());
  camera.orthographic = orthographic;
  if (orthographic) camera.fx = camera.fy = 10;
  Mat4 camera_to_world;
  camera_to_world.rotate(Vec3(0.3 * turn, turn, 0.2 * turn));
  camera_to_world[3][0] = place_m.x, camera_to_world[3][1] = place_m.y, camera_to_world[3][2] = place_m.z;
  camera.world_to_camera = inverse(camera_to_world);
  return camera;
}

/// Planes of vectors with every kind of hole, of depth with every kind of background, and of added motion.
struct Picture {
  explicit Picture(Window w) : window(w) {
    for (Plane* plane : {&prev_x, &prev_y, &next_x, &next_y, &depth, &added_x, &added_y, &mask})
      *plane = Plane(w.width(), w.height());
    for (int y = 0; y < w.height(); ++y)
      for (int x = 0; x < w.width(); ++x) fill(x, y, x + w.min_x + 100, y + w.min_y + 100);
  }
  void fill(int x, int y, int ax, int ay) {
    prev_x(x, y) = noise(ax, ay, 1, -9, 9), prev_y(x, y) = noise(ax, ay, 2, -9, 9);
    next_x(x, y) = noise(ax, ay, 3, -9, 9), next_y(x, y) = noise(ax, ay, 4, -9, 9);
    depth(x, y) = noise(ax, ay, 5, 2, 20);
    added_x(x, y) = noise(ax, ay, 6, -3, 3), added_y(x, y) = noise(ax, ay, 7, -3, 3);
    mask(x, y) = noise(ax, ay, 8, 0, 1);
    if (ax % 5 == 0) prev_x(x, y) = ay % 3 == 0 ? kNan : ay % 3 == 1 ? kInf : 1e15F;
    if (ay % 4 == 0) next_y(x, y) = ax % 3 == 0 ? kNan : ax % 3 == 1 ? -kInf : -1e18F;
    if (ax % 7 == 0) depth(x, y) = ay % 4 == 0 ? kInf : ay % 4 == 1 ? kNan : ay % 4 == 2 ? 0.0F : -1.0F;
    if (ay % 3 == 0 && ax % 2 == 0) prev_x(x, y) = prev_y(x, y) = 0;
    if (ay % 5 == 0 && ax % 2 == 0) next_x(x, y) = next_y(x, y) = 0;
    if (ax % 11 == 0) added_x(x, y) = ay % 2 == 0 ? kNan : kInf;
    if (ay % 11 == 0) mask(x, y) = ax % 2 == 0 ? kNan : -kInf;
  }
  MotionSources sources() const {
    MotionSources s;
    s.prev_x = prev_x, s.prev_y = prev_y, s.next_x = next_x, s.next_y = next_y;
    s.depth = depth;
    s.window = window, s.display = kDisplay;
    return s;
  }
  void add_to(MotionSources& s) const { s.added_x = added_x, s.added_y = added_y, s.added_mask = mask; }
  Window window;
  Plane prev_x, prev_y, next_x, next_y, depth, added_x, added_y, mask;
};

/// Cameras around one at the origin.
void move_camera(MotionSources& sources, Vec3 step_m, double turn, bool orthographic = false) {
  const Camera now = camera_at({0, 0, 0}, 0, orthographic);
  sources.before = CameraReprojection::create(now, camera_at(-step_m, -turn, orthographic));
  sources.after = CameraReprojection::create(now, camera_at(step_m * 1.5, 0.5 * turn, orthographic));
}

void forget_vectors(MotionSources& s) { s.prev_x = s.prev_y = s.next_x = s.next_y = {}; }

void expect_like_reference(const MotionParams& params, const MotionSources& sources, const std::string& what) {
  const Motion got = motion_of(params, sources);
  for (int y = 0; y < sources.window.height(); ++y)
    for (int x = 0; x < sources.window.width(); ++x) {
      const MotionAt expected = reference_motion(params, sources, x, y);
      const double tolerance = 3e-5 * (1 + expected.prev.length() + expected.next.length());
      ASSERT_NEAR(got.prev_x(x, y), expected.prev.x, tolerance) << what << " at " << x << ", " << y;
      ASSERT_NEAR(got.prev_y(x, y), expected.prev.y, tolerance) << what << " at " << x << ", " << y;
      ASSERT_NEAR(got.next_x(x, y), expected.next.x, tolerance) << what << " at " << x << ", " << y;
      ASSERT_NEAR(got.next_y(x, y), expected.next.y, tolerance) << what << " at " << x << ", " << y;
    }
}

MotionParams shares(float camera, float object) {
  MotionParams params;
  params.camera_motion = camera;
  params.object_motion = object;
  return params;
}

TEST(Motion, AgreesWithItsDefinition) {
  const Picture picture({-5, 3, 52, 37});
  MotionParams added = shares(0.7F, 1.4F);
  added.added_x_px = 2, added.added_y_px = -1, added.added_zoom = 0.05F;
  MotionParams limited;
  limited.min_speed_px = 4, limited.max_speed_px = 8;
  for (const bool orthographic : {false, true})
    for (const bool vectors : {false, true}) {
      MotionSources sources = picture.sources();
      if (!vectors) forget_vectors(sources);
      expect_like_reference({}, sources, "no camera");
      expect_like_reference(shares(0.5F, 2), sources, "shares without a camera");
      move_camera(sources, {0.2, -0.1, 0.3}, orthographic ? 0 : 0.02, orthographic);
      expect_like_reference({}, sources, "camera");
      expect_like_reference(limited, sources, "limits");
      expect_like_reference(shares(0.3F, 1.7F), sources, "shares");
      picture.add_to(sources);
      expect_like_reference(added, sources, "added");
      sources.added_mask = {};
      expect_like_reference(added, sources, "added everywhere");
      sources.before.reset();
      expect_like_reference({}, sources, "first frame");
      sources.depth = {};
      expect_like_reference({}, sources, "no depth");
    }
}

TEST(Motion, OfOneKnownVectorIsEven) {
  const Picture picture(kDisplay);
  MotionSources sources = picture.sources();
  sources.prev_x = sources.prev_y = {};
  motionblur::WithoutVector without;
  const Motion motion = motion_of({}, sources, &without);
  EXPECT_TRUE(without.still && !without.by_camera);
  for (int x = 0; x < 64; ++x) {
    EXPECT_EQ(motion.prev_x(x, 1), -motion.next_x(x, 1));
    EXPECT_EQ(motion.next_x(x, 1), picture.next_x(x, 1));
    EXPECT_EQ(motion.next_x(x, 0), 0) << "no vector is known of row 100";
  }
}

TEST(Motion, BackgroundFollowsTheRotationAlone) {
  Picture picture(kDisplay);
  picture.depth = Plane(64, 40, kInf);
  MotionSources sources = picture.sources();
  forget_vectors(sources);
  motionblur::WithoutVector without;
  move_camera(sources, {3, 2, 5}, 0);
  const Motion still = motion_of({}, sources, &without);
  EXPECT_TRUE(without.by_camera && !without.still);
  move_camera(sources, {3, 2, 5}, 0.05);
  const Motion turned = motion_of({}, sources);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 64; ++x) {
      EXPECT_EQ(still.prev_x(x, y), 0);
      EXPECT_EQ(still.next_y(x, y), 0);
      EXPECT_GT(std::abs(turned.prev_x(x, y)), 1);
    }
  const Plane zero(64, 40);  // as Cycles writes it
  sources.prev_x = sources.prev_y = sources.next_x = sources.next_y = zero;
  EXPECT_EQ(motion_of({}, sources).prev_x(5, 5), turned.prev_x(5, 5));
  picture.depth(5, 5) = 3;
  EXPECT_EQ(motion_of({}, sources).prev_x(5, 5), 0) << "a surface that moves with the camera";
}

TEST(Motion, WhatWasBehindTheCameraMovesEvenlyOrStandsStill) {
  Picture picture(kDisplay);
  picture.depth = Plane(64, 40, 2);
  MotionSources sources = picture.sources();
  forget_vectors(sources);
  move_camera(sources, {0, 0, 1.5}, 0);  // the camera after has passed the surface
  const Motion motion = motion_of({}, sources);
  EXPECT_GT(motion.prev_x(5, 5), 1) << "it was nearer to the picture's centre";
  EXPECT_EQ(motion.next_x(5, 5), -motion.prev_x(5, 5));
  sources.before.reset();
  EXPECT_EQ(motion_of({}, sources).next_x(5, 5), 0);
}

TEST(Motion, OfTheCameraAloneOrOfTheObjectsAlone) {
  Picture picture(kDisplay);
  MotionSources sources = picture.sources();
  forget_vectors(sources);
  move_camera(sources, {0.3, 0.1, 0}, 0.03);
  const Motion camera = motion_of({}, sources);
  sources.prev_x = camera.prev_x, sources.prev_y = camera.prev_y;
  sources.next_x = camera.next_x, sources.next_y = camera.next_y;
  const Motion objects = motion_of(shares(0, 1), sources);
  Plane moved = copy_of(camera.next_x);
  for (int x = 0; x < 64; ++x) moved(x, 7) += 5;
  sources.next_x = moved;
  const Motion objects_of_row = motion_of(shares(0, 1), sources), camera_of_row = motion_of(shares(1, 0), sources);
  for (int x = 0; x < 64; ++x) {
    EXPECT_EQ(objects.prev_x(x, 20), 0) << "a static surface has no motion but the camera's";
    EXPECT_EQ(objects.next_y(x, 20), 0);
    EXPECT_NEAR(objects_of_row.next_x(x, 7), 5, 1e-5);
    EXPECT_EQ(camera_of_row.next_x(x, 7), camera.next_x(x, 7));
  }
}

TEST(Motion, LimitsKeepTheDirection) {
  Picture picture(kDisplay);
  MotionSources sources = picture.sources();
  MotionParams params;
  params.min_speed_px = 3, params.max_speed_px = 6;
  const Motion all = motion_of({}, sources), some = motion_of(params, sources);
  int still = 0, shortened = 0, kept = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 64; ++x) {
      const double speed =
          std::max(std::hypot(all.prev_x(x, y), all.prev_y(x, y)), std::hypot(all.next_x(x, y), all.next_y(x, y)));
      const double limited =
          std::max(std::hypot(some.prev_x(x, y), some.prev_y(x, y)), std::hypot(some.next_x(x, y), some.next_y(x, y)));
      EXPECT_NEAR(limited, speed < 3 ? 0 : std::min(speed, 6.0), 1e-5);
      EXPECT_NEAR(some.prev_x(x, y) * all.next_y(x, y), all.prev_x(x, y) * some.next_y(x, y), 1e-3);
      (speed < 3 ? still : speed > 6 ? shortened : kept) += 1;
    }
  EXPECT_GT(still, 20);
  EXPECT_GT(shortened, 200);
  EXPECT_GT(kept, 200);
}

TEST(Motion, ThreadsAndTheWindowsPositionDoNotMatter) {
  const Window whole{-10, -4, 70, 50}, part{3, 5, 40, 30};
  MotionParams params = shares(0.3F, 1.7F);
  params.added_zoom = 0.1F, params.max_speed_px = 12;
  const Picture large(whole), small(part);
  MotionSources a = large.sources(), b = small.sources();
  large.add_to(a), small.add_to(b);
  move_camera(a, {0.2, -0.1, 0.3}, 0.02);
  move_camera(b, {0.2, -0.1, 0.3}, 0.02);
  set_thread_count(1);
  const Motion one = motion_of(params, a);
  set_thread_count(4);
  const Motion four = motion_of(params, a);
  set_thread_count(0);
  const Motion within = motion_of(params, b);
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x) {
      const int wx = x + part.min_x - whole.min_x, wy = y + part.min_y - whole.min_y;
      EXPECT_EQ(one.prev_x(wx, wy), four.prev_x(wx, wy));
      EXPECT_EQ(one.next_y(wx, wy), four.next_y(wx, wy));
      EXPECT_EQ(one.prev_x(wx, wy), within.prev_x(x, y));
      EXPECT_EQ(one.next_y(wx, wy), within.next_y(x, y));
    }
}

TEST(Displacement, PassesThroughTheThreePositions) {
  for (const Path path : {Path::separate, Path::curved}) {
    EXPECT_EQ(motionblur::displacement(path, -3.0, 7.0, -1.0), -3);
    EXPECT_EQ(motionblur::displacement(path, -3.0, 7.0, 0.0), 0);
    EXPECT_EQ(motionblur::displacement(path, -3.0, 7.0, 1.0), 7);
  }
  EXPECT_EQ(motionblur::displacement(Path::straight, -3.0, 7.0, 1.0), 5);
  EXPECT_EQ(motionblur::displacement(Path::straight, -3.0, 7.0, -0.5), -2.5);
  EXPECT_EQ(motionblur::displacement(Path::separate, -3.0, 7.0, -0.5), -1.5);
  EXPECT_EQ(motionblur::displacement(Path::curved, -3.0, 7.0, 0.5), 2.5 + 0.5) << "half of the mean, a quarter bend";
}

TEST(Displacement, TheLongestIsABound) {
  const Picture picture(kDisplay);
  const Motion motion = motion_of({}, picture.sources());
  for (const Path path : {Path::straight, Path::separate, Path::curved})
    for (const motionblur::Shutter shutter :
         {motionblur::Shutter{-0.5F, 0.5F}, {0, 0.7F}, {-1.2F, -0.2F}, {0.1F, 2.0F}}) {
      double longest = 0;
      for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 64; ++x)
          for (int i = 0; i <= 20; ++i) {
            const float t = shutter.opens + shutter.length() * static_cast<float>(i) / 20;
            longest = std::max<double>(
                longest, std::hypot(motionblur::displacement(path, motion.prev_x(x, y), motion.next_x(x, y), t),
                                    motionblur::displacement(path, motion.prev_y(x, y), motion.next_y(x, y), t)));
          }
      const float bound = motionblur::longest_displacement_px(motion, shutter, path);
      EXPECT_LE(longest, bound * 1.00001);
      EXPECT_LE(bound, longest * (path == Path::curved ? 1.5 : 1.00001));
    }
}

TEST(Shutter, OpensAsThePhaseSays) {
  motionblur::PathParams params;
  const auto opens = [&](motionblur::ShutterPhase phase) {
    params.shutter_phase = phase;
    const motionblur::Shutter shutter = motionblur::shutter_of(params, 0.5F);
    EXPECT_EQ(shutter.length(), 0.5F);
    return shutter.opens;
  };
  EXPECT_EQ(opens(motionblur::ShutterPhase::centred), -0.25F);
  EXPECT_EQ(opens(motionblur::ShutterPhase::start), 0);
  EXPECT_EQ(opens(motionblur::ShutterPhase::end), -0.5F);
  params.shutter_opens_frames = 0.125F;
  EXPECT_EQ(opens(motionblur::ShutterPhase::custom), 0.125F);
}

}  // namespace
}  // namespace aftershade::tests
