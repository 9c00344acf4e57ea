#include "core/temporal/trajectory.h"

#include "core/base/error.h"
#include "tests/temporal/window_helpers.h"

namespace aftershade::tests {
namespace {

using temporal::Match;
using temporal::MatchTolerance;
using temporal::Trajectories;

constexpr int kWidth = 64, kHeight = 48;
constexpr MatchTolerance kTolerance{0.05F, 2, 0.05F, 0.5F, 0.25F};
const Window kWindow = window_of(kWidth, kHeight);

/// The matches of frames[centre] in the frames on one side, nearest first.
std::vector<Match> walk(const std::vector<WindowFrame>& frames, size_t centre, Side side,
                        const MatchTolerance& tolerance = kTolerance) {
  std::vector<const WindowFrame*> chain;
  for (auto i = static_cast<std::ptrdiff_t>(centre); i >= 0 && i < std::ssize(frames);
       i += side == Side::before ? -1 : 1)
    chain.push_back(&frames[static_cast<size_t>(i)]);
  Trajectories trajectories(tolerance, chain, side);
  std::vector<Match> out;
  while (trajectories.left() > 0) out.push_back(trajectories.next());
  return out;
}

/// A square of 10 px, `left` pixels from the left, at depth 4 in front of a floor at 5, that moves by `speed` px a
/// frame.
struct Square {
  double start, speed;
  double left(int frame) const { return start + speed * frame; }
  bool covers(int frame, int x, int y) const {
    return x + 0.5 >= left(frame) && x + 0.5 < left(frame) + 10 && y >= 16 && y < 26;
  }
};
std::vector<WindowFrame> square_frames(const Square& square, int count) {
  std::vector<WindowFrame> frames;
  for (int f = 0; f < count; ++f) {
    WindowFrame frame = window_frame(f, kWindow, camera_at({0, 0, 0}));
    add_still_vectors(frame);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (!square.covers(f, x, y)) continue;
        frame.depth(x, y) = 4;
        frame.mv_prev.x(x, y) = static_cast<float>(-square.speed);
        frame.mv_next.x(x, y) = static_cast<float>(square.speed);
      }
    frames.push_back(std::move(frame));
  }
  return frames;
}

TEST(Trajectories, AStillCameraFindsEveryPixelAtItsPlace) {
  std::vector<WindowFrame> frames;
  for (int f = 0; f < 4; ++f) {
    frames.push_back(window_frame(f, kWindow, camera_at({0.3, -0.2, 1})));
    frames.back().depth = plane_of(kWidth, kHeight, [](int x, int y) { return 3 + 5 * noise(x, y); });
    frames.back().ao = plane_of(kWidth, kHeight, [&](int x, int y) { return noise(x, y, f + 1); });
  }
  for (const Side side : {Side::before, Side::after}) {
    const std::vector<Match> matches = walk(frames, side == Side::before ? 3 : 0, side);
    ASSERT_EQ(matches.size(), 3U);
    for (size_t d = 0; d < 3; ++d)
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          const WindowFrame &centre = frames[side == Side::before ? 3 : 0],
                            &there = frames[side == Side::before ? 2 - d : d + 1];
          ASSERT_EQ(matches[d].x(x, y), static_cast<float>(x) + 0.5F);
          ASSERT_EQ(matches[d].y(x, y), static_cast<float>(y) + 0.5F);
          ASSERT_EQ(matches[d].depth(x, y), centre.depth(x, y));
          ASSERT_EQ(matches[d].weight(x, y), 1);
          ASSERT_EQ(matches[d].difference(x, y), there.ao(x, y) - centre.ao(x, y));
        }
  }
}

TEST(Trajectories, ThereMustBeAFurtherFrame) {
  const std::vector<WindowFrame> frames = square_frames({20, 1}, 1);
  const std::vector<const WindowFrame*> chain = pointers(frames);
  Trajectories alone(kTolerance, chain, Side::after);
  EXPECT_EQ(alone.left(), 0U);
  EXPECT_THROW(alone.next(), Error);
}

TEST(Trajectories, ACameraThatDolliesFindsStaticPointsWhereProjectionPutsThem) {
  // A wall parallel to the image: depth 6 seen from z = 0, and 0.25 m less with every frame.
  std::vector<WindowFrame> frames;
  for (int f = 0; f < 5; ++f) {
    frames.push_back(window_frame(f, kWindow, camera_at({0, 0, 0.25 * f})));
    frames.back().depth = Plane(kWidth, kHeight, static_cast<float>(6 - 0.25 * f));
  }
  const std::vector<Match> matches = walk(frames, 4, Side::before);
  for (int d = 1; d <= 4; ++d)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const double z = 5 + 0.25 * d, shrink = 5 / z;
        const Match& match = matches[static_cast<size_t>(d - 1)];
        ASSERT_NEAR(match.x(x, y), 32 + (x + 0.5 - 32) * shrink, 1e-5);
        ASSERT_NEAR(match.y(x, y), 24 + (y + 0.5 - 24) * shrink, 1e-5);
        ASSERT_NEAR(match.depth(x, y), z, 1e-6);
        ASSERT_NEAR(match.weight(x, y), 1, 1e-6) << "a wall is everywhere the same surface";
      }
}

TEST(Trajectories, VectorsCarryAMovingObjectFromFrameToFrame) {
  const Square square{12, 3.25};
  for (const bool carried : {false, true}) {
    std::vector<WindowFrame> frames = square_frames(square, 7);
    if (carried)
      for (WindowFrame& frame : frames) frame.mv_prev = {};  // only mv_next is there: scattered for the way back
    const std::vector<Match> before = walk(frames, 3, Side::before), after = walk(frames, 3, Side::after);
    int followed = 0, holes = 0;
    for (int y = 17; y < 25; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (!square.covers(3, x - 2, y) || !square.covers(3, x + 2, y)) continue;  // inner pixels
        for (int d = 1; d <= 3; ++d) {
          const Match &b = before[static_cast<size_t>(d - 1)], &a = after[static_cast<size_t>(d - 1)];
          ASSERT_EQ(a.x(x, y), static_cast<float>(x + 0.5 + 3.25 * d));
          ASSERT_EQ(a.weight(x, y), 1);
          if (carried && std::isnan(b.x(x, y))) {
            ++holes;
            continue;
          }
          ASSERT_EQ(b.x(x, y), static_cast<float>(x + 0.5 - 3.25 * d)) << carried << " " << d << " " << x << " " << y;
          ASSERT_EQ(b.weight(x, y), 1);
          ++followed;
        }
      }
    EXPECT_GT(followed, 100);
    EXPECT_EQ(holes, 0);
  }
}

TEST(Trajectories, WhatWasHiddenIsNotMatchedAndIsFoundAgainBehindIt) {
  const Square square{2, 12};  // 10 px wide: it hides a pixel of the floor for one frame only
  const std::vector<WindowFrame> frames = square_frames(square, 5);
  const std::vector<Match> before = walk(frames, 4, Side::before);
  int hidden = 0;
  for (int d = 1; d <= 4; ++d)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (square.covers(4, x, y)) continue;
        const bool covered = square.covers(4 - d, x, y);
        ASSERT_EQ(before[static_cast<size_t>(d - 1)].weight(x, y), covered ? 0.0F : 1.0F) << d << " " << x << " " << y;
        hidden += covered ? 1 : 0;
      }
  EXPECT_EQ(hidden, 4 * 100);
}

TEST(Trajectories, AnObjectThatStartsToMoveIsFollowedThrough) {
  // At rest in frames 2 to 4, it came from the left before.
  std::vector<WindowFrame> frames = square_frames({20, 0}, 5);
  for (int f : {0, 1}) {
    const Square moved{20.0 - 4 * (2 - f), 0};
    frames[static_cast<size_t>(f)] = std::move(square_frames(moved, f + 1)[static_cast<size_t>(f)]);
    for (int y = 16; y < 26; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (moved.covers(f, x, y)) frames[static_cast<size_t>(f)].mv_next.x(x, y) = 4;
  }
  for (int f : {1, 2})
    for (int y = 16; y < 26; ++y)
      for (int x = 0; x < kWidth; ++x)
        if (frames[static_cast<size_t>(f)].depth(x, y) == 4) frames[static_cast<size_t>(f)].mv_prev.x(x, y) = -4;
  const std::vector<Match> before = walk(frames, 4, Side::before);
  const float want[] = {25.5F, 25.5F, 21.5F, 17.5F};
  for (size_t d = 0; d < 4; ++d) {
    EXPECT_EQ(before[d].x(25, 20), want[d]) << d;
    EXPECT_EQ(before[d].weight(25, 20), 1) << d;
  }
}

TEST(Trajectories, DepthThatVectorsDoNotKnowIsTakenFromWhatIsFound) {
  // A wall comes nearer by 4 % a frame: each step is within 5 %, three steps are not.
  std::vector<WindowFrame> frames;
  for (int f = 0; f < 4; ++f) {
    frames.push_back(window_frame(f, kWindow, camera_at({0, 0, 0})));
    frames.back().depth = Plane(kWidth, kHeight, static_cast<float>(8 * std::pow(0.96, f)));
    add_still_vectors(frames.back());
    frames.back().mv_prev.x = Plane(kWidth, kHeight, -1.0F);
    frames.back().mv_next.x = Plane(kWidth, kHeight, 1.0F);
  }
  const std::vector<Match> found = walk(frames, 0, Side::after);
  EXPECT_EQ(found[2].weight(30, 20), 1);
  EXPECT_FLOAT_EQ(found[2].depth(30, 20), frames[2].depth(0, 0)) << "expected is what was found one frame nearer";
  MatchTolerance strict{0, 0, 0.05F, 0.5F, 0.25F};
  EXPECT_EQ(walk(frames, 0, Side::after, strict)[2].weight(30, 20), 1);
  strict.moving_depth = 0.03F;
  const std::vector<Match> none = walk(frames, 0, Side::after, strict);
  EXPECT_EQ(none[0].weight(30, 20), 0);
  EXPECT_TRUE(std::isnan(none[1].x(30, 20))) << "a moving surface that was not found is lost";
}

/// Two frames of one wall; the second is changed by `spoil`. The match of pixel (30, 20).
float weight_when(const std::function<void(WindowFrame&)>& spoil) {
  std::vector<WindowFrame> frames;
  for (int f = 0; f < 2; ++f) {
    frames.push_back(window_frame(f, kWindow, camera_at({0, 0, 0})));
    add_still_vectors(frames.back());
    frames.back().nx = Plane(kWidth, kHeight);
    frames.back().ny = Plane(kWidth, kHeight);
    frames.back().nz = Plane(kWidth, kHeight, -1.0F);
  }
  spoil(frames[1]);
  return walk(frames, 0, Side::after)[0].weight(30, 20);
}

TEST(Trajectories, EachTestOfATapRejectsByItself) {
  EXPECT_EQ(weight_when([](WindowFrame&) {}), 1);
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.depth(30, 20) = 5.16F; }), 1) << "two footprints of 5/60 m";
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.depth(30, 20) = 5.17F; }), 0);
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.depth(30, 20) = kInf; }), 0);
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.nx(30, 20) = -0.86F, f.nz(30, 20) = -0.51F; }), 1);
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.nx(30, 20) = -0.87F, f.nz(30, 20) = -0.49F; }), 0);
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.nz(30, 20) = 0; }), 1) << "no normal contradicts nothing";
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.mv_prev.x(30, 20) = 0.49F; }), 1);
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.mv_prev.x(30, 20) = 0.51F; }), 0) << "it came from elsewhere";
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.mv_prev.y(30, 20) = kNaN; }), 1);
  EXPECT_EQ(weight_when([](WindowFrame& f) { f.ao(30, 20) = kNaN; }), 0);
}

TEST(Trajectories, AnUnknownVectorLeavesTheWordToTheCamera) {
  std::vector<WindowFrame> frames;
  for (int f = 0; f < 2; ++f) {
    frames.push_back(window_frame(f, kWindow, camera_at({0, 0, 0})));
    add_still_vectors(frames.back());
    frames.back().mv_next.x(30, 20) = kNaN;
  }
  EXPECT_EQ(walk(frames, 0, Side::after)[0].weight(30, 20), 1);
  for (WindowFrame& frame : frames) frame.camera.world_to_camera.reset();
  const std::vector<Match> matches = walk(frames, 0, Side::after);
  EXPECT_TRUE(std::isnan(matches[0].x(30, 20)));
  EXPECT_EQ(matches[0].weight(30, 20), 0);
  EXPECT_EQ(matches[0].weight(31, 20), 1) << "without a camera the vectors are followed";
}

TEST(Trajectories, WindowsAreAlignedByAbsoluteCoordinates) {
  const Square square{12, 3};
  const std::vector<WindowFrame> whole = square_frames(square, 4);
  std::vector<WindowFrame> parts;
  for (int f = 0; f < 4; ++f) {
    const WindowFrame& from = whole[static_cast<size_t>(f)];
    const Window part = window_of(kWidth - 8, kHeight - 6 - f, 3 + f, 2);
    WindowFrame frame = window_frame(f, part, from.camera);
    add_still_vectors(frame);
    for (const auto& [source, target] : {std::pair(&from.depth, &frame.depth),
                                         {&from.mv_prev.x, &frame.mv_prev.x},
                                         {&from.mv_next.x, &frame.mv_next.x}})
      copy_at(*source, *target, -part.min_x, -part.min_y);
    parts.push_back(std::move(frame));
  }
  const std::vector<Match> want = walk(whole, 2, Side::before), got = walk(parts, 2, Side::before);
  const Window centre = parts[2].window;
  for (size_t d = 0; d < 2; ++d)
    for (int y = 4; y < 30; ++y)
      for (int x = 12; x < 52; ++x) {
        const int i = x - centre.min_x, j = y - centre.min_y;
        ASSERT_EQ(got[d].weight(i, j), want[d].weight(x, y)) << d << " " << x << " " << y;
        ASSERT_TRUE(got[d].x(i, j) == want[d].x(x, y) || std::isnan(want[d].x(x, y)));
      }
}

TEST(Trajectories, BackgroundHasNone) {
  std::vector<WindowFrame> frames = square_frames({20, 1}, 2);
  int i = 0;
  for (const float none : {kInf, kNaN, 0.0F, -2.0F}) frames[0].depth(i++, 3) = none;
  const std::vector<Match> matches = walk(frames, 0, Side::after);
  for (int x = 0; x < 5; ++x) {
    EXPECT_EQ(std::isnan(matches[0].x(x, 3)), x < 4);
    EXPECT_EQ(matches[0].weight(x, 3), x < 4 ? 0.0F : 1.0F);
    EXPECT_EQ(matches[0].difference(x, 3), 0);
  }
}

}  // namespace
}  // namespace aftershade::tests
