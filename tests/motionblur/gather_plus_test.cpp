#include "core/motionblur/gather_plus.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/motionblur/gather_plus_tiles.h"
#include "core/parallel/rows.h"
#include "tests/motionblur/coverage.h"
#include "tests/motionblur/moving_scene.h"

namespace aftershade::tests {
namespace {

using motionblur::GatherPlusParams;
using motionblur::Motion;
using motionblur::Path;
using motionblur::ShutterPhase;

std::vector<Plane> blurred(const GatherPlusParams& params, const MovingScene& scene) {
  std::vector<Plane> out;
  std::vector<Plane*> pointers;
  for (const Plane& plane : scene.channels) out.push_back(copy_of(plane));
  for (Plane& plane : out) pointers.push_back(&plane);
  const motionblur::Shutter shutter = motionblur::shutter_of(params, params.shutter_frames);
  motionblur::gather_plus(params, {&scene.motion, scene.depth, scene.window, shutter}, pointers);
  return out;
}

// ---- coverage, algorithms 3.5 ----

/// Half-exposure vectors, for a shutter of half a frame.
std::vector<Plane> blurred_layers(const BlurScene& scene) {
  const int width = scene.window.width(), height = scene.window.height();
  MovingScene moving = make_scene(scene.window, [&](int ax, int ay) {
    const int x = ax - scene.window.min_x, y = ay - scene.window.min_y;
    const float vx = 4 * scene.velocity.x(x, y), vy = 4 * scene.velocity.y(x, y);
    return Surface{scene.depth(x, y), -vx, -vy, vx, vy};
  });
  copy_at(scene.channels[0], moving.channels[0], 0, 0);
  EXPECT_EQ(moving.depth.width(), width);
  EXPECT_EQ(moving.depth.height(), height);
  return blurred({}, moving);
}

TEST(GatherPlusCoverage, IsTheTruthInEveryCase) {
  for (const Layers& layers : {kEdge, kBar, kStill, kOpposed, kOvertaking, kOvertaken}) {
    const CoverageError error = coverage_error(blurred_layers, layers);
    std::cout << layers.name << ": mean " << error.mean << ", largest " << error.largest << "\n";
    EXPECT_LT(error.mean, 0.005) << layers.name;
    EXPECT_LT(error.largest, 0.005) << layers.name;
  }
}

// ---- the definition ----

double at(Path path, float prev, float next, double t) {
  return motionblur::displacement<double>(path, double{prev}, double{next}, static_cast<float>(t));
}

/// The nearest pixel of the whole picture that covers (x, y) at time t; -1: none.
int in_front(const MovingScene& scene, Path path, int x, int y, double t) {
  int best = -1;
  std::pair<float, double> first{kInf, 1};  // of equal depth the closest
  for (int v = 0; v < scene.window.height(); ++v)
    for (int u = 0; u < scene.window.width(); ++u) {
      const Motion& m = scene.motion;
      const double dx = u + at(path, m.prev_x(u, v), m.next_x(u, v), t) - x;
      const double dy = v + at(path, m.prev_y(u, v), m.next_y(u, v), t) - y;
      const double off = std::max(std::abs(dx), std::abs(dy));
      const std::pair<float, double> here{scene.depth(u, v), off};
      if (off <= 0.505 && here < first) first = here, best = v * scene.window.width() + u;
    }
  return best;
}

/// Written from the definition: pixels that some surface of the picture covers all the time. NaN elsewhere.
Plane reference(const GatherPlusParams& params, const MovingScene& scene, int taps) {
  const int width = scene.window.width();
  const motionblur::Shutter shutter = motionblur::shutter_of(params, params.shutter_frames);
  Plane out(width, scene.window.height());
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int i = 0; i < taps; ++i) {
        const double jitter = kBayer4x4[static_cast<size_t>((y & 3) * 4 + (x & 3))];
        const int pixel =
            in_front(scene, params.path, x, y, double{shutter.opens} + (i + jitter) / taps * double{shutter.length()});
        sum += pixel < 0 ? double{kNan} : double{scene.channels[0](pixel % width, pixel / width)};
      }
      out(x, y) = static_cast<float>(sum / taps);
    }
  return out;
}

/// But for pixels where a border between surfaces passes within the 0.005 px that rounding is given.
void expect_like_reference(const GatherPlusParams& params) {
  const MovingScene scene = make_scene(kLayered, layered);
  const std::vector<Plane> got = blurred(params, scene);
  const Plane expected = reference(params, scene, params.least_taps);
  int known = 0, different = 0;
  for (int y = 0; y < expected.height(); ++y)
    for (int x = 0; x < expected.width(); ++x) {
      if (std::isnan(expected(x, y))) continue;
      ++known;
      different += std::abs(got[0](x, y) - expected(x, y)) > 1e-5;
    }
  EXPECT_GT(known, 0.5 * expected.width() * expected.height());
  EXPECT_LE(different, 0.01 * known) << "of " << known;
}

GatherPlusParams with_taps(int taps) {
  GatherPlusParams params;
  params.least_taps = params.most_taps = taps;
  return params;
}

TEST(GatherPlus, ShowsWhatIsInFrontAtEachTime) {
  for (const Path path : {Path::straight, Path::separate, Path::curved})
    for (const ShutterPhase phase :
         {ShutterPhase::centred, ShutterPhase::start, ShutterPhase::end, ShutterPhase::custom}) {
      SCOPED_TRACE(testing::Message() << "path " << static_cast<int>(path) << ", phase " << static_cast<int>(phase));
      GatherPlusParams params = with_taps(12);
      params.path = path;
      params.shutter_phase = phase;
      params.shutter_opens_frames = -0.1F;
      expect_like_reference(params);
    }
}

TEST(GatherPlus, EveryParameterCounts) {
  const MovingScene scene = make_scene(kLayered, layered);
  const Plane usual = std::move(blurred({}, scene)[0]);
  const auto differs = [&](auto set) {
    GatherPlusParams params;
    set(params);
    return !same_bits(blurred(params, scene)[0], usual);
  };
  EXPECT_TRUE(differs([](auto& p) { p.taps_per_px = 3; }));
  EXPECT_TRUE(differs([](auto& p) { p.least_taps = 90; }));
  EXPECT_TRUE(differs([](auto& p) { p.least_taps = p.most_taps = 8; }));
  EXPECT_TRUE(differs([](auto& p) { p.motions = 1; }));
}

// ---- what it tells of itself ----

TEST(GatherPlus, TellsWhatShareOfTheExposureIsGuessed) {
  constexpr int kLeft = 24, kRight = 71;  // moves 5 px to either side of its place
  const MovingScene scene = make_scene({0, 0, 95, 31}, [](int x, int) {
    return x >= kLeft && x <= kRight ? Surface{1, -20, 0, 20, 0} : Surface{2, 0, 0, 0, 0};
  });
  const GatherPlusParams params = with_taps(100);
  Plane channel = copy_of(scene.channels[0]), guessed;
  Plane* const channels[] = {&channel};
  const motionblur::Shutter shutter = motionblur::shutter_of(params, params.shutter_frames);
  motionblur::gather_plus(params, {&scene.motion, scene.depth, scene.window, shutter}, channels, &guessed);
  EXPECT_TRUE(same_bits(channel, blurred(params, scene)[0])) << "the picture does not change by asking";
  for (int x = 0; x < 96; ++x) {
    const double inside = std::min(x - kLeft, kRight - x) + 0.5;  // from the box's edge
    const double uncovered = inside > 0 ? std::max(0.0, 5 - inside) / 10 : 0;
    EXPECT_NEAR(guessed(x, 16), uncovered, 0.03) << x;
  }
}

TEST(GatherPlus, TellsTheTilesItGathersBy) {
  constexpr Window window{-5, 3, 90, 50};
  constexpr int kReached = 2;  // what moves 5 px in tile 1 may reach the next one, wherever in its tile it is
  for (const int edge : {25, 31}) {
    const MovingScene scene = make_scene(window, [edge](int x, int) {
      return x < edge ? Surface{1, -20, 6, 20, -6} : Surface{2, 0, 0, 0, 0};  // half the way: (5, -1.5)
    });
    const auto tiles = motionblur::velocity_tiles(scene.motion, Path::straight, {-0.25F, 0.25F}, window);
    const motionblur::TileGrid grid(tiles.tile_px, window);
    for (int x = 0; x < window.width(); ++x) {
      const int column = grid.column_of(x), tile = (x + window.min_x) >> 4;
      EXPECT_FLOAT_EQ(tiles.own.x(column, 0), tile <= 1 ? 5 : 0) << x;
      EXPECT_FLOAT_EQ(tiles.own.y(column, 0), tile <= 1 ? -1.5F : 0) << x;
      EXPECT_FLOAT_EQ(tiles.neighbours.x(column, 0), tile <= kReached ? 5 : 0) << x;
      EXPECT_FLOAT_EQ(tiles.neighbours.y(column, 0), tile <= kReached ? -1.5F : 0) << x;
    }
  }
}

// ---- what must hold of any blur ----

TEST(GatherPlus, WhatDoesNotMoveKeepsItsBits) {
  const MovingScene still = make_scene({0, 0, 63, 47}, [](int, int) { return Surface{1, -0.7F, 0, 0.7F, 0}; });
  EXPECT_TRUE(same_bits(blurred({}, still)[0], still.channels[0]));
  const MovingScene beside = make_scene({0, 0, 95, 47}, [](int x, int) {
    return x < 16 ? Surface{1, -20, 0, 20, 0} : Surface{2, 0, 0, 0, 0};  // 5 px to either side
  });
  const std::vector<Plane> out = blurred({}, beside);
  int changed = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 96; ++x)
      if (x >= 32)
        EXPECT_EQ(out[0](x, y), beside.channels[0](x, y));
      else
        changed += out[0](x, y) != beside.channels[0](x, y);
  EXPECT_GT(changed, 48 * 19);
}

TEST(GatherPlus, AStillObjectStaysSharpBeforeAMovingBackground) {
  const MovingScene scene = make_scene({0, 0, 63, 31}, [](int x, int) {
    return x >= 20 && x < 44 ? Surface{1, 0, 0, 0, 0} : Surface{10, -30, 0, 30, 0};
  });
  const std::vector<Plane> out = blurred({}, scene);
  for (int y = 0; y < 32; ++y)
    for (int x = 20; x < 44; ++x) EXPECT_EQ(out[0](x, y), scene.channels[0](x, y));
}

TEST(GatherPlus, DoesNotDependOnThreads) {
  const MovingScene scene = make_scene(kLayered, layered);
  const std::vector<Plane> many = blurred({}, scene);
  set_thread_count(1);
  const std::vector<Plane> one = blurred({}, scene);
  set_thread_count(0);
  EXPECT_TRUE(same_bits(many[0], one[0]));
}

TEST(GatherPlus, BlursAnyNumberOfChannelsAlike) {
  MovingScene scene = make_scene(kLayered, layered, 6);
  for (Plane& channel : scene.channels) copy_at(scene.channels[5], channel, 0, 0);
  const std::vector<Plane> out = blurred({}, scene);
  for (const Plane& channel : out) EXPECT_TRUE(same_bits(channel, out[0]));
}

TEST(GatherPlus, TakesNothingFromBeyondTheBorder) {
  // 1 beside the border and 0 inside: what comes from outside is left out, not taken from the border's pixel
  MovingScene line = make_scene(kLayered, [](int, int) { return Surface{1, -40, 0, 40, 0}; });
  for (int y = 0; y < 44; ++y)
    for (int x = 0; x < 72; ++x) line.channels[0](x, y) = x == 0 ? 1.0F : 0.0F;
  const std::vector<Plane> out = blurred(with_taps(256), line);
  for (int y = 0; y < 44; ++y) EXPECT_NEAR(out[0](0, y), 1 / 10.5, 0.005);
}

TEST(GatherPlus, IsTheSameForMirroredPictures) {
  GatherPlusParams params = with_taps(256);
  const MovingScene scene = make_scene(kLayered, layered);
  MovingScene mirrored = make_scene(kLayered, [](int x, int y) {
    const Surface s = layered(71 - x, 43 - y);
    return Surface{s.depth, -s.prev_x, -s.prev_y, -s.next_x, -s.next_y};
  });
  for (int y = 0; y < 44; ++y)
    for (int x = 0; x < 72; ++x) mirrored.channels[0](x, y) = scene.channels[0](71 - x, 43 - y);
  const std::vector<Plane> a = blurred(params, scene), b = blurred(params, mirrored);
  double sum = 0;
  for (int y = 0; y < 44; ++y)
    for (int x = 0; x < 72; ++x) sum += std::abs(double{a[0](x, y)} - double{b[0](71 - x, 43 - y)});
  EXPECT_LT(sum / (72 * 44), 0.004);
}

}  // namespace
}  // namespace aftershade::tests
