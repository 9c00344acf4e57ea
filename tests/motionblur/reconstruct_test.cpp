#include "core/motionblur/reconstruct.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/motionblur/slice_tile.h"
#include "core/parallel/rows.h"
#include "tests/motionblur/coverage.h"
#include "tests/motionblur/moving_scene.h"

namespace aftershade::tests {
namespace {

using motionblur::Path;
using motionblur::Reconstruction;
using motionblur::ReconstructParams;
using motionblur::SequenceFrame;
using motionblur::Shutter;
using motionblur::ShutterPhase;
using motionblur::SurfacePoint;

SequenceFrame frame_of(const MovingScene& scene, int number = 10) {
  SequenceFrame frame;
  frame.number = number;
  frame.window = scene.window;
  frame.depth = scene.depth;
  frame.motion = &scene.motion;
  for (const Plane& channel : scene.channels) frame.channels.push_back(channel);
  return frame;
}

Reconstruction reconstructed(const ReconstructParams& params, const MovingScene& scene) {
  return motionblur::reconstruct(params, {frame_of(scene)}, motionblur::shutter_of(params, params.shutter_frames));
}
std::vector<Plane> blurred(const ReconstructParams& params, const MovingScene& scene) {
  return reconstructed(params, scene).channels;
}

ReconstructParams with_slices(int slices) {
  ReconstructParams params;
  params.least_slices = params.most_slices = slices;
  return params;
}

// ---- coverage, algorithms 3.5 ----

std::vector<Plane> blurred_layers(const BlurScene& scene) {
  MovingScene moving = make_scene(scene.window, [&](int ax, int ay) {
    const int x = ax - scene.window.min_x, y = ay - scene.window.min_y;
    const float vx = 4 * scene.velocity.x(x, y), vy = 4 * scene.velocity.y(x, y);
    return Surface{scene.depth(x, y), -vx, -vy, vx, vy};
  });
  copy_at(scene.channels[0], moving.channels[0], 0, 0);
  return blurred({}, moving);
}

/// In one dimension the foreground is everywhere what it is in one frame, so nothing has to come from others.
TEST(ReconstructCoverage, IsTheTruthInEveryCase) {
  for (const Layers& layers : {kEdge, kBar, kStill, kOpposed, kOvertaking, kOvertaken}) {
    const CoverageError error = coverage_error(blurred_layers, layers);
    std::cout << layers.name << ": mean " << error.mean << ", largest " << error.largest << "\n";
    EXPECT_LT(error.mean, 0.005) << layers.name;
    EXPECT_LT(error.largest, 0.02) << layers.name;
  }
}

// ---- the definition ----

/// A box of the definition at one time: half a pixel to every side, or half of the way to the neighbour's centre.
struct Box {
  double left, right, top, bottom, depth;
  float value;
};

/// Composites boxes front to back over the square of pixel (x, y): {colour, coverage}.
std::pair<double, double> composited(std::vector<Box> boxes, int x, int y) {
  std::stable_sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.depth < b.depth; });
  double open = 1, colour = 0;
  for (size_t begin = 0; begin < boxes.size();) {
    double coverage = 0, sum = 0;
    size_t end = begin;
    for (; end < boxes.size() && boxes[end].depth <= 1.03 * boxes[begin].depth; ++end) {
      const Box& box = boxes[end];
      const double w = std::min(box.right, x + 0.5) - std::max(box.left, x - 0.5);
      const double h = std::min(box.bottom, y + 0.5) - std::max(box.top, y - 0.5);
      if (w <= 0 || h <= 0) continue;
      coverage += w * h;
      sum += w * h * double{box.value};
    }
    if (coverage > 0) {
      const double alpha = open * std::min(coverage, 1.0);
      colour += alpha * sum / coverage;
      open -= alpha;
    }
    begin = end;
  }
  return {colour, 1 - open};
}

/// Where the surfaces of the layered scene lie at time t, edges and all, written out for its three rigid parts.
std::vector<Box> boxes_at(const MovingScene& scene, Path path, double t) {
  std::vector<Box> boxes;
  const auto at = [&](float prev, float next) {
    return motionblur::displacement<double>(path, double{prev}, double{next}, static_cast<float>(t));
  };
  for (int y = 0; y < scene.window.height(); ++y)
    for (int x = 0; x < scene.window.width(); ++x) {
      const double cx = x + at(scene.motion.prev_x(x, y), scene.motion.next_x(x, y));
      const double cy = y + at(scene.motion.prev_y(x, y), scene.motion.next_y(x, y));
      boxes.push_back({cx - 0.5, cx + 0.5, cy - 0.5, cy + 0.5, double{scene.depth(x, y)}, scene.channels[0](x, y)});
    }
  return boxes;
}

/// NaN where nothing is seen at some time, infinity where rounding decides that.
Plane reference(const MovingScene& scene, const ReconstructParams& params, int slices) {
  const Shutter shutter = motionblur::shutter_of(params, params.shutter_frames);
  Plane out(scene.window.width(), scene.window.height());
  for (int s = 0; s < slices; ++s) {
    const double t = double{shutter.opens} + (s + 0.5) / slices * double{shutter.length()};
    const std::vector<Box> boxes = boxes_at(scene, params.path, t);
    for (int y = 0; y < out.height(); ++y) {
      std::vector<Box> row;
      std::copy_if(boxes.begin(), boxes.end(), std::back_inserter(row),
                   [&](const Box& b) { return b.top < y + 0.5 && b.bottom > y - 0.5; });
      for (int x = 0; x < out.width(); ++x) {
        std::vector<Box> near;
        std::copy_if(row.begin(), row.end(), std::back_inserter(near),
                     [&](const Box& b) { return b.left < x + 0.5 && b.right > x - 0.5; });
        const auto [colour, seen] = composited(near, x, y);
        const bool open = std::abs(seen - 0.5) < 1e-3;
        out(x, y) += open ? kInf : seen < 0.5 ? kNan : static_cast<float>(colour / seen / slices);
      }
    }
  }
  return out;
}

TEST(Reconstruct, CompositesTheSlicesOfTheExposure) {
  for (const Path path : {Path::straight, Path::separate, Path::curved})
    for (const ShutterPhase phase :
         {ShutterPhase::centred, ShutterPhase::start, ShutterPhase::end, ShutterPhase::custom}) {
      SCOPED_TRACE(testing::Message() << "path " << static_cast<int>(path) << ", phase " << static_cast<int>(phase));
      ReconstructParams params = with_slices(6);
      params.path = path;
      params.shutter_phase = phase;
      params.shutter_opens_frames = -0.1F;
      const MovingScene scene = make_scene(kLayered, layered);
      const Reconstruction got = reconstructed(params, scene);
      const Plane expected = reference(scene, params, 6);
      int known = 0;
      for (int y = 0; y < expected.height(); ++y)
        for (int x = 0; x < expected.width(); ++x) {
          if (std::isinf(expected(x, y))) continue;
          if (std::isnan(expected(x, y))) {
            EXPECT_GT(got.guessed(x, y), 0.5F / 6 - 1e-5F) << "more than half of one slice at " << x << ", " << y;
            continue;
          }
          ++known;
          EXPECT_NEAR(got.channels[0](x, y), expected(x, y), 1e-4) << x << ", " << y;
          EXPECT_NEAR(got.guessed(x, y), 0, 1e-6);
        }
      EXPECT_GT(known, 0.4 * expected.width() * expected.height());
    }
}

TEST(Reconstruct, ASurfaceThatGrowsHasNoCracks) {
  // 6 % larger at the ends of the exposure: the background, 5 everywhere, must not show through
  MovingScene scene = make_scene({0, 0, 79, 59}, [](int x, int y) {
    const float dx = 0.24F * (static_cast<float>(x) - 40), dy = 0.24F * (static_cast<float>(y) - 30);
    return std::abs(x - 40) < 26 && std::abs(y - 30) < 20 ? Surface{1, -dx, -dy, dx, dy} : Surface{9, 0, 0, 0, 0};
  });
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x) scene.channels[0](x, y) = scene.depth(x, y) == 1 ? 1.0F : 5.0F;
  const std::vector<Plane> out = blurred({}, scene);
  for (int y = 16; y < 45; ++y)
    for (int x = 20; x < 61; ++x) EXPECT_NEAR(out[0](x, y), 1, 1e-3) << x << ", " << y;
}

TEST(Reconstruct, EveryParameterCounts) {
  const MovingScene scene = make_scene(kLayered, layered), beside = make_scene(kLayered, layered);
  const auto run = [&](const ReconstructParams& params) {
    SequenceFrame next = frame_of(beside, 11);
    for (ConstPlaneView& channel : next.channels) channel = scene.depth;  // some other picture
    return std::move(motionblur::reconstruct(params, {frame_of(scene), next}, {-0.25F, 0.25F}).channels[0]);
  };
  const Plane usual = run({});
  const auto differs = [&](auto set) {
    ReconstructParams params;
    set(params);
    return !same_bits(run(params), usual);
  };
  EXPECT_TRUE(differs([](auto& p) { p.slices_per_px = 3; }));
  EXPECT_TRUE(differs([](auto& p) { p.least_slices = 100; }));
  EXPECT_TRUE(differs([](auto& p) { p.least_slices = p.most_slices = 8; }));
  EXPECT_TRUE(differs([](auto& p) { p.changing_light = false; }));
  EXPECT_TRUE(differs([](auto& p) { p.path = Path::straight; }));
}

// ---- neighbours ----

/// A board, 1, that moves 24 px per frame before a wall of stripes that stands still, as frame 10 + `step` shows it.
MovingScene board(int step) {
  MovingScene scene = make_scene({0, 0, 95, 31}, [&](int x, int) {
    const int left = 32 + 24 * step;
    return x >= left && x < left + 24 ? Surface{2, -24, 0, 24, 0} : Surface{5, 0, 0, 0, 0};
  });
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 96; ++x)
      scene.channels[0](x, y) = scene.depth(x, y) == 2 ? 1.0F : 0.2F + 0.1F * static_cast<float>(x % 3);
  return scene;
}

TEST(ReconstructNeighbours, ShowWhatIsUncovered) {
  const MovingScene before = board(-1), now = board(0), after = board(1);
  const Reconstruction alone = reconstructed({}, now);
  const Reconstruction with =
      motionblur::reconstruct({}, {frame_of(now), frame_of(before, 9), frame_of(after, 11)}, {-0.25F, 0.25F});
  double error = 0, error_alone = 0;
  for (int x = 20; x < 70; ++x) {
    const double covered = std::clamp(std::min((x + 0.5 - 26.0) / 12, (62 - (x + 0.5)) / 12), 0.0, 1.0);
    const double truth = covered + (1 - covered) * (0.2 + 0.1 * (x % 3));
    error = std::max(error, std::abs(double{with.channels[0](x, 16)} - truth));
    error_alone = std::max(error_alone, std::abs(double{alone.channels[0](x, 16)} - truth));
    EXPECT_NEAR(with.guessed(x, 16), 0, 1e-6) << x;
  }
  EXPECT_LT(error, 0.012);  // 16 and more slices of an edge that crosses a pixel in one
  EXPECT_GT(error_alone, 0.04);
  EXPECT_NEAR(alone.guessed(33, 16), 0.36, 0.1) << "nobody saw the wall behind the board";
}

TEST(ReconstructNeighbours, ComeInAtTheBorder) {
  const auto pan = [](int step) {
    MovingScene scene = make_scene({0, 0, 47, 15}, [](int, int) { return Surface{3, -40, 0, 40, 0}; });
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 48; ++x) scene.channels[0](x, y) = x - 40 * step < 0 ? 1.0F : 0.0F;
    return scene;
  };
  const MovingScene now = pan(0), after = pan(1);  // where the frame ends there is light, which only f+1 shows
  const Reconstruction with = motionblur::reconstruct({}, {frame_of(now), frame_of(after, 11)}, {-0.25F, 0.25F});
  EXPECT_NEAR(with.channels[0](0, 8), 0.475, 0.04);
  EXPECT_NEAR(with.channels[0](5, 8), 0.225, 0.04);
}

TEST(ReconstructNeighbours, OfAnotherShotShowNothing) {
  const MovingScene now = board(0);
  MovingScene other = board(1);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 96; ++x) other.depth(x, y) = 1;  // f would have to show it, and does not
  const Reconstruction with = motionblur::reconstruct({}, {frame_of(now), frame_of(other, 11)}, {-0.25F, 0.25F});
  std::vector<SurfacePoint> points;
  motionblur::add_hidden_points({frame_of(now), frame_of(board(1), 11)}, 1, {-0.25F, 0.25F}, points);
  EXPECT_FALSE(points.empty());
  const Reconstruction alone = reconstructed({}, now);
  EXPECT_EQ(with.channels[0](33, 16), alone.channels[0](33, 16));
}

TEST(ReconstructNeighbours, LightOfUncoveredWallsIsThatOfTheFrame) {
  const MovingScene now = board(0);
  MovingScene after = board(1);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 96; ++x)
      if (after.depth(x, y) == 5) after.channels[0](x, y) *= 4;
  const std::vector<SequenceFrame> sequence{frame_of(now), frame_of(after, 11)};
  std::vector<SurfacePoint> points;
  motionblur::add_hidden_points(sequence, 1, {-0.25F, 0.25F}, points);
  int walls = 0;
  for (const SurfacePoint& p : points)
    if (p.depth == 5) {
      EXPECT_NEAR(p.light, 0.25, 1e-5);
      ++walls;
    }
  EXPECT_GT(walls, 16 * 24);
}

TEST(ReconstructNeighbours, LightChangesTowardsThem) {
  const auto lit = [](float value) {
    MovingScene scene = make_scene({0, 0, 31, 15}, [](int, int) { return Surface{3, -8, 0, 8, 0}; });
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 32; ++x) scene.channels[0](x, y) = value;
    return scene;
  };
  const MovingScene now = lit(1), after = lit(3);
  const Reconstruction with = motionblur::reconstruct({}, {frame_of(now), frame_of(after, 11)}, {-0.25F, 0.25F});
  EXPECT_NEAR(with.channels[0](16, 8), 1 + 2 * 0.0625, 1e-4) << "half of the exposure, an eighth of a frame on average";
}

// ---- what must hold of any blur ----

TEST(Reconstruct, WhatNothingCrossesKeepsItsBits) {
  const MovingScene beside = make_scene({0, 0, 95, 47}, [](int x, int) {
    return x < 16 ? Surface{1, -20, 0, 20, 0} : Surface{2, 0, 0, 0, 0};  // 5 px to either side
  });
  const std::vector<Plane> out = blurred({}, beside);
  int changed = 0;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 96; ++x)
      if (x >= 22)
        EXPECT_EQ(out[0](x, y), beside.channels[0](x, y));
      else
        changed += out[0](x, y) != beside.channels[0](x, y);
  EXPECT_GT(changed, 48 * 19);
}

TEST(Reconstruct, DoesNotDependOnThreads) {
  const MovingScene now = board(0), after = board(1);
  const auto run = [&] {
    return std::move(motionblur::reconstruct({}, {frame_of(now), frame_of(after, 11)}, {-0.25F, 0.25F}).channels[0]);
  };
  const Plane many = run();
  set_thread_count(1);
  const Plane one = run();
  set_thread_count(0);
  EXPECT_TRUE(same_bits(many, one));
}

}  // namespace
}  // namespace aftershade::tests
