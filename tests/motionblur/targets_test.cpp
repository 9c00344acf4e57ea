// The motion blurs with parameters and pixels that presets do not reach, on every SIMD target: the bits of the one-lane
// twin.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/motionblur/gather_plus.h"
#include "core/motionblur/guertin2014.h"
#include "core/motionblur/mcguire2012.h"
#include "tests/motionblur/blur_scene.h"
#include "tests/support/on_all_targets.h"

namespace aftershade::tests {
namespace {

using namespace motionblur;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// Puts what files may hold in place of some values.
void spoil(Plane& plane, uint32_t seed) {
  constexpr float kSpecial[]{kNan, kInf, -kInf, 0.0F, -0.0F, -1.0F, 3e38F, 1e15F};
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x) {
      const uint32_t bits = hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 1, seed);
      if (bits % 24 == 0) plane(x, y) = kSpecial[(bits >> 5) % 8];
    }
}

/// Windows with fewer pixels than lanes and with many, at odd places.
const Window kWindows[]{{-7, 5, 123, 41}, {3, -9, 39, 8}, {5, 5, 7, 6}, {-1, -1, -1, -1}};

/// Patches that move, still ground on the right, and things that no picture should have.
BlurScene rough_scene(Window window, size_t channels) {
  BlurScene scene = make_blur_scene(window, [&](int x, int y) {
    BlurPixel p = patchy_pixel(x, y, 12);
    if (x > window.width() / 2) p.vx = p.vy = noise(x, y, 20, 0, 0.1F);
    while (p.colour.size() < channels) p.colour.push_back(noise(x, y, static_cast<uint32_t>(p.colour.size()), 0, 1));
    p.colour.resize(channels);
    return p;
  });
  spoil(scene.depth, 1);
  for (size_t c = 0; c < channels; ++c) spoil(scene.channels[c], 2 + static_cast<uint32_t>(c));
  return scene;
}

template <class Blur>
void expect_blur_same(const std::string& name, const Blur& blur) {
  for (const Window& window : kWindows)
    for (const size_t channels : {1U, 4U, 6U})
      expect_same(cat(name, ", ", channels, " channels, ", window.width(), " x ", window.height()), [&] {
        BlurScene scene = rough_scene(window, channels);
        std::vector<Plane*> pointers;
        for (Plane& plane : scene.channels) pointers.push_back(&plane);
        blur(GatherInput{channels == 4 ? ConstPlaneView(scene.depth) : ConstPlaneView(), &scene.velocity, window, 1},
             std::span<Plane* const>(pointers));
        return std::move(scene.channels);
      });
}

TEST(MotionBlurTargets, ScalableBlur) {
  const auto expect = [](const std::string& name, const std::function<void(ScalableBlurParams&)>& change) {
    ScalableBlurParams params = unscaled(9);
    change(params);
    expect_blur_same(name, [&](const GatherInput& input, std::span<Plane* const> channels) {
      scalable_motion_blur(params, input, channels);
    });
  };
  expect("as it is", [](ScalableBlurParams&) {});
  expect("checkerboard, three directions, line", [](ScalableBlurParams& p) {
    p.jitter = Jitter::checkerboard, p.directions = Directions::three, p.dilation = Dilation::line;
  });
  expect("passes, literal directions, relative depths", [](ScalableBlurParams& p) {
    p.passes = 3, p.directions = Directions::alternate_literal, p.comparison = DepthComparison::relative;
  });
  expect("neighbourhood, 8 bits, directional", [](ScalableBlurParams& p) {
    p.directions = Directions::neighbourhood, p.velocity_bits = VelocityBits::eight;
    p.dilation = Dilation::directional;
  });
  expect("no limit", [](ScalableBlurParams& p) { p.max_radius_px = 0; });
}

TEST(MotionBlurTargets, LiteralBlurs) {
  Mcguire2012Params mcguire;
  mcguire.max_radius_px = 7, mcguire.reference_height_px = 1;
  expect_blur_same("mcguire2012", [&](const GatherInput& input, std::span<Plane* const> channels) {
    mcguire2012_blur(mcguire, input, channels);
  });
  for (const TapSplit split : {TapSplit::even, TapSplit::variance}) {
    Guertin2014Params guertin;
    guertin.max_radius_px = 8, guertin.reference_height_px = 1, guertin.split = split, guertin.taps = 12;
    expect_blur_same("guertin2014", [&](const GatherInput& input, std::span<Plane* const> channels) {
      guertin2014_blur(guertin, input, channels);
    });
  }
}

/// Vectors both ways, unlike each other and often unknown, with cameras that move and motion that is added.
struct RoughMotion {
  explicit RoughMotion(Window window) {
    const auto filled = [&](uint32_t seed, float low, float high, bool rough = true) {
      Plane out(window.width(), window.height());
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) out(x, y) = noise(x / 5, y / 4, seed, low, high);
      if (rough) spoil(out, seed);
      return out;
    };
    for (uint32_t i = 0; i < 4; ++i) vectors.push_back(filled(30 + i, -9, 9));
    depth = filled(40, 1, 30);
    for (uint32_t i = 0; i < 3; ++i) added.push_back(filled(50 + i, -1, 1));
    Camera here;
    here.fx = 80, here.fy = 81, here.cx = 20, here.cy = 11;
    here.world_to_camera = Mat4();
    Camera before = here, after = here;
    before.world_to_camera = Mat4().setTranslation(Vec3(0.1, -0.02, 0.3));
    after.world_to_camera = Mat4().setTranslation(Vec3(-0.1, 0.03, -0.2));
    sources.prev_x = vectors[0], sources.prev_y = vectors[1], sources.next_x = vectors[2], sources.next_y = vectors[3];
    sources.depth = depth;
    sources.before = CameraReprojection::create(here, before);
    sources.after = CameraReprojection::create(here, after);
    sources.added_x = added[0], sources.added_y = added[1], sources.added_mask = added[2];
    sources.window = window;
    sources.display = {0, 0, 99, 49};
  }
  std::vector<Plane> vectors, added;
  Plane depth;
  MotionSources sources;
};

MotionParams busy_params() {
  MotionParams params;
  params.camera_motion = 0.7F, params.object_motion = 1.3F;
  params.min_speed_px = 0.5F, params.max_speed_px = 8;
  params.added_x_px = 0.2F, params.added_zoom = 0.01F;
  return params;
}

std::vector<Plane> planes_of(Motion motion) {
  std::vector<Plane> out;
  for (Plane* plane : {&motion.prev_x, &motion.prev_y, &motion.next_x, &motion.next_y})
    out.push_back(std::move(*plane));
  return out;
}

TEST(MotionBlurTargets, Motion) {
  for (const Window& window : kWindows) {
    RoughMotion rough(window);
    for (const bool cameras : {true, false}) {
      if (!cameras) rough.sources.before = rough.sources.after = std::nullopt;
      for (const MotionParams& params : {MotionParams(), busy_params()}) {
        expect_same("motion", [&] { return planes_of(motion_of(params, rough.sources)); });
        expect_same("half velocity", [&] {
          const HalfVelocity half = half_velocity(params, rough.sources, 0.5F, 3);
          const HalfVelocity eight = at_8_bits(half, 3);
          std::vector<Plane> out;
          out.push_back(Plane(1, 1, longest_px(half)));
          for (const Plane* plane : {&half.x, &half.y, &eight.x, &eight.y}) out.push_back(copy_of(*plane));
          return out;
        });
      }
    }
  }
}

TEST(HalfVelocity, IsTheSameWithAndWithoutTheMotionBetween) {
  for (const Window& window : kWindows) {
    const RoughMotion rough(window);
    WithoutVector a, b;
    const HalfVelocity through = half_velocity(motion_of(busy_params(), rough.sources, &a), 0.5F, 3);
    const HalfVelocity direct = half_velocity(busy_params(), rough.sources, 0.5F, 3, &b);
    EXPECT_EQ(a.still, b.still);
    EXPECT_EQ(a.by_camera, b.by_camera);
    for (int y = 0; y < window.height(); ++y)
      for (int x = 0; x < window.width(); ++x) {
        EXPECT_EQ(through.x(x, y), direct.x(x, y));
        EXPECT_EQ(through.y(x, y), direct.y(x, y));
      }
  }
}

TEST(LongestDisplacement, IsThatOfTheLongestPixelInDouble) {
  for (const Window& window : kWindows) {
    const Motion motion = motion_of({}, RoughMotion(window).sources);
    for (const Path path : {Path::straight, Path::separate, Path::curved}) {
      double longest = 0;
      for (int y = 0; y < window.height(); ++y)
        for (int x = 0; x < window.width(); ++x) {
          const double px = motion.prev_x(x, y), py = motion.prev_y(x, y), nx = motion.next_x(x, y),
                       ny = motion.next_y(x, y);
          const double mean = 0.5 * 0.5 * std::hypot(nx - px, ny - py);
          const double bend = path == Path::curved ? 0.5 * 0.5 * 0.5 * std::hypot(nx + px, ny + py) : 0;
          const double apart = std::max(0.25 * std::hypot(px, py), 0.5 * std::hypot(nx, ny));
          longest = std::max(longest, path == Path::separate ? apart : mean + bend);
        }
      for (const std::string& target : lanes::targets()) {
        lanes::force_target(target);
        EXPECT_EQ(longest_displacement_px(motion, {-0.25F, 0.5F}, path), static_cast<float>(longest)) << target;
      }
    }
  }
  lanes::force_target(lanes::targets().front());
}

TEST(MotionBlurTargets, GatherPlus) {
  for (const Window& window : kWindows) {
    const RoughMotion rough(window);
    const Motion motion = motion_of({}, rough.sources);
    for (const Path path : {Path::straight, Path::separate, Path::curved})
      for (const size_t channels : {1U, 4U, 6U})
        expect_same(cat("gather-plus, ", channels, " channels, ", window.width(), " x ", window.height()), [&] {
          BlurScene scene = rough_scene(window, channels);
          std::vector<Plane*> pointers;
          for (Plane& plane : scene.channels) pointers.push_back(&plane);
          GatherPlusParams params;
          params.path = path, params.least_taps = 5, params.most_taps = 11;
          gather_plus(params, {&motion, scene.depth, window, {-0.3F, 0.6F}}, pointers);
          return std::move(scene.channels);
        });
  }
}

}  // namespace
}  // namespace aftershade::tests
