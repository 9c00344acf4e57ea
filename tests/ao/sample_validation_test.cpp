#include "core/ao/sample_validation.h"

#include <gtest/gtest.h>

#include "core/parallel/rows.h"
#include "tests/filter/analytic_surface.h"

/// Neighbourhood validation on a wall 5 m away with a box in front of it that may stand elsewhere a frame before.
namespace aftershade::tests {
namespace {

using ao::PastSurface;
using ao::SphereSamples;
using ao::Validation;
using ao::ValidationParams;

constexpr int kWidth = 120, kHeight = 80;

struct Box {
  double left = 1e9, z = 4.6;
  View view() const {
    const Box box = *this;
    return [box](double x, double y) {
      const bool inside = x >= box.left && x < box.left + 30 && y >= 20 && y < 60;
      return Hit{inside ? box.z : 5.0, Vec3(0, 0, -1)};
    };
  }
};

/// Two frames, and where the pixels of the second were in the first: still, but for the box.
struct Frames {
  Lens lens{100, 100, 60, 40};
  Picture before, now;
  Plane x{kWidth, kHeight}, y{kWidth, kHeight}, expected{kWidth, kHeight};
  Frames(const Box& was, const Box& is, double moved_px = 0)
      : before(picture(kWidth, kHeight, lens, was.view())), now(picture(kWidth, kHeight, lens, is.view())) {
    for (int j = 0; j < kHeight; ++j)
      for (int i = 0; i < kWidth; ++i) {
        const bool box = now.depth(i, j) < 5;
        x(i, j) = static_cast<float>(i + 0.5 - (box ? moved_px : 0));
        y(i, j) = static_cast<float>(j + 0.5);
        expected(i, j) = now.depth(i, j);
      }
  }
  PastSurface past() const { return {before.depth, before.projection, 0, 0, x, y, expected}; }
};

Plane confidence(const Frames& frames, const ValidationParams& validation = {}, int samples = 64) {
  const filter::Surface surface = frames.now.surface();
  return ao::sample_confidence({}, validation, surface, filter::full_grid(surface), {0, samples, {}, {}},
                               frames.past());
}

int pixels_below(ConstPlaneView plane, float value) {
  int count = 0;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) count += !(plane(x, y) >= value);
  return count;
}

TEST(SampleConfidence, IsWholeWhereNothingMoves) {
  const Box box{50};
  EXPECT_EQ(pixels_below(confidence({box, box}), 1), 0);
}

TEST(SampleConfidence, FallsAroundWhatHasCome) {
  const Plane trust = confidence({Box{}, Box{50}});
  EXPECT_LT(trust(45, 40), 0.3F) << "beside the box";
  EXPECT_EQ(trust(5, 5), 1.0F) << "45 px = 2.2 radii away";
}

TEST(SampleConfidence, FallsAroundWhatHasLeft) {
  const Plane trust = confidence({Box{50}, Box{}});
  EXPECT_LT(trust(45, 40), 0.3F) << "where the box was beside";
  EXPECT_EQ(trust(5, 5), 1.0F);
}

TEST(SampleConfidence, FallsWithTheDistanceMoved) {
  // The vectors follow the box, whose distance from the wall's points changes.
  float last = 1;
  for (const int moved : {1, 3, 8}) {
    const Plane trust = confidence({Box{50.0 - moved}, Box{50}, static_cast<double>(moved)});
    EXPECT_LT(trust(46, 40), last) << moved;
    last = trust(46, 40);
  }
  EXPECT_LT(last, 0.4F);
}

TEST(SampleConfidence, IsTheFormulaOfTheLargestChange) {
  // One sample each: 1 / (1 + S delta / R), then the smallest of all.
  const Frames frames({45}, {50}, 5);
  const filter::Surface surface = frames.now.surface();
  const auto of = [&](int first, int count, const ValidationParams& validation) {
    return ao::sample_confidence({}, validation, surface, filter::full_grid(surface), {first, count, {}, {}},
                                 frames.past());
  };
  ValidationParams twice;
  twice.validation_sharpness *= 2;
  const Plane all = of(0, 8, {}), sharper = of(0, 8, twice);
  Plane least(kWidth, kHeight, 1);
  for (int i = 0; i < 8; ++i) {
    const Plane one = of(i, 1, {});
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) least(x, y) = std::min(least(x, y), one(x, y));
  }
  EXPECT_EQ(differing_pixels(all, least), 0);
  int partly = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (all(x, y) == 0) continue;
      ASSERT_NEAR(1 / sharper(x, y) - 1, 2 * (1 / all(x, y) - 1), 1e-3 / all(x, y));
      partly += all(x, y) < 1 ? 1 : 0;
    }
  EXPECT_GT(partly, 100);
}

TEST(SampleConfidence, BinaryIsAllOrNothing) {
  ValidationParams binary;
  binary.validation = Validation::binary;
  const Frames frames({45}, {50}, 5);
  const Plane smooth = confidence(frames), hard = confidence(frames, binary);
  const float at_limit = 1 / (1 + binary.validation_sharpness * binary.validation_limit);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (std::abs(smooth(x, y) - at_limit) < 1e-4F) continue;
      ASSERT_EQ(hard(x, y), smooth(x, y) > at_limit ? 1.0F : 0.0F) << x << ' ' << y;
    }
  binary.validation_limit = 1e6F;
  EXPECT_GT(pixels_below(hard, 1), pixels_below(confidence(frames, binary), 1));
}

TEST(SampleConfidence, CanBeSwitchedOff) {
  ValidationParams off;
  off.validation = Validation::off;
  EXPECT_EQ(pixels_below(confidence({Box{}, Box{50}}, off), 1), 0);
}

TEST(SampleConfidence, OfASurfaceThatOnlySlidesBelowTheTangentPlaneStaysWhole) {
  // What lies behind the tangent plane of a pixel does not occlude it: pixels of the box do not care for the wall.
  const Frames frames({50}, {50});
  Frames deeper({50}, {50});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (deeper.now.depth(x, y) == 5) {
        deeper.now.depth(x, y) = 5.5F;  // the wall recedes
        deeper.expected(x, y) = 5.0F;   // as the camera expects
      }
  const Plane trust = confidence(deeper);
  EXPECT_EQ(trust(65, 40), 1.0F);
}

TEST(SampleConfidence, AnOccluderThatWasOutsideTheOldImageEndsIt) {
  // The old image ends 10 px further right: the box at the left border is new.
  Frames frames({0}, {0});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) frames.x(x, y) -= 30;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) frames.before.depth(x, y) = 5;  // what was in the image is the wall
  const Plane trust = confidence(frames);
  EXPECT_EQ(trust(33, 40), 0.0F) << "beside the box, which is new";
  EXPECT_EQ(trust(100, 40), 1.0F) << "far from it";
}

TEST(SampleConfidence, SeesSkyWhereSomethingHasLeftIt) {
  Frames frames({50}, {50});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (frames.now.depth(x, y) < 5) {
        frames.now.depth(x, y) = kInf;  // the box has left a hole in the wall
        frames.x(x, y) = frames.y(x, y) = frames.expected(x, y) = kNan;
      }
  EXPECT_LT(confidence(frames)(45, 40), 0.3F);
}

TEST(SampleConfidence, UnknownPastIsNoneAndNothingSpreads) {
  Frames frames({50}, {50});
  for (int i = 0; i < 300; ++i) {
    frames.before.depth((i * 37) % kWidth, (i * 53) % kHeight) = i % 2 != 0 ? kNan : kInf;
    frames.now.depth((i * 41) % kWidth, (i * 59) % kHeight) = i % 2 != 0 ? kNan : -1.0F;
    frames.x((i * 29) % kWidth, (i * 61) % kHeight) = kNan;
  }
  const Plane trust = confidence(frames);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) ASSERT_TRUE(trust(x, y) >= 0 && trust(x, y) <= 1) << x << ' ' << y;
  for (int i = 0; i < 300; ++i) ASSERT_EQ(trust((i * 29) % kWidth, (i * 61) % kHeight), 0.0F);
}

TEST(SampleConfidence, AMovingCameraOverASlopeIsOnlyRounding) {
  // The camera has moved to the right by a fraction of a pixel: a slanted plane and a step are found again.
  const Lens lens{100, 100, 60, 40, true};
  const auto view = [&](double shift) {
    return [=](double x, double y) {
      const Hit plane = slanted_plane(lens, {0.3, 0.5, -0.6})(x + shift, y);
      return plane;
    };
  };
  const Picture before = picture(kWidth, kHeight, lens, view(0)), now = picture(kWidth, kHeight, lens, view(0.37));
  Plane x(kWidth, kHeight), y(kWidth, kHeight);
  for (int j = 0; j < kHeight; ++j)
    for (int i = 0; i < kWidth; ++i) x(i, j) = static_cast<float>(i) + 0.87F, y(i, j) = static_cast<float>(j) + 0.5F;
  SphereSamples params;
  params.radius_m = 0.1F;
  const filter::Surface surface = now.surface();
  const Plane trust = ao::sample_confidence(params, {}, surface, filter::full_grid(surface), {0, 32, {}, {}},
                                            {before.depth, before.projection, 0, 0, x, y, now.depth});
  for (int j = 0; j < kHeight; ++j)
    for (int i = 0; i < kWidth - 1; ++i) ASSERT_EQ(trust(i, j), 1.0F) << i << ' ' << j;
}

TEST(SampleConfidence, DoesNotDependOnThreadsUnitOrWindow) {
  const Frames frames({45}, {50}, 5);
  const Plane one = confidence(frames);
  set_thread_count(3);
  EXPECT_EQ(differing_pixels(one, confidence(frames)), 0);
  set_thread_count(0);
  const Picture before = scaled(frames.before, 1024), now = scaled(frames.now, 1024);
  Plane expected(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) expected(x, y) = frames.expected(x, y) * 1024;
  SphereSamples params;
  params.radius_m *= 1024;
  const Plane large =
      ao::sample_confidence(params, {}, now.surface(), filter::full_grid(now.surface()), {0, 64, {}, {}},
                            {before.depth, before.projection, 0, 0, frames.x, frames.y, expected});
  EXPECT_EQ(differing_pixels(one, large), 0);
  // The old planes alone lie elsewhere: index (0, 0) is absolute pixel (-7, -4).
  Plane moved(kWidth + 7, kHeight + 4, 5);
  copy_at(frames.before.depth, moved, 7, 4);
  Projection projection = frames.before.projection;
  projection.cx += 7;
  projection.cy += 4;
  const filter::Surface surface = frames.now.surface();
  const Plane shifted = ao::sample_confidence({}, {}, surface, filter::full_grid(surface), {0, 64, {}, {}},
                                              {moved, projection, -7, -4, frames.x, frames.y, frames.expected});
  for (int y = 10; y < kHeight - 10; ++y)
    for (int x = 10; x < kWidth - 10; ++x) ASSERT_EQ(shifted(x, y), one(x, y)) << x << ' ' << y;
}

}  // namespace
}  // namespace aftershade::tests
