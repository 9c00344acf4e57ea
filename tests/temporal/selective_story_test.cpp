#include <vector>

#include "core/temporal/selective_temporal.h"
#include "tests/temporal/temporal_helpers.h"

/// The slides' story of seed 000 on sequences small enough to know the answer: flicker goes, nothing trails.
namespace aftershade::tests {
namespace {

using temporal::continuity_mask;
using temporal::dilate_discontinuities;
using filter::values_at_pixels;
using temporal::selective_temporal_filter;
using temporal::SelectiveTemporalParams;
using temporal::TemporalHistory;

constexpr int kWidth = 96, kHeight = 64;
const Projection kLens{100, 100, 48, 32, false};

Plane stability(const SelectiveTemporalParams& params, ConstPlaneView depth) {
  const filter::SampleGrid grid = hand_grid(depth);
  const filter::Surface surface = surface_of(depth, kLens);
  return values_at_pixels(dilate_discontinuities(continuity_mask(params, grid, surface), params.dilation_texels), grid,
                        surface);
}

/// Variance over time of each pixel's AO, averaged over the columns [first, last), frames from 40 on.
class Flicker {
 public:
  Flicker(int first, int last) : first_(first), last_(last), sum_(kSize), squares_(kSize) {}
  void add(ConstPlaneView ao) {
    ++frames_;
    for (int y = 0; y < kHeight; ++y)
      for (int x = first_; x < last_; ++x) {
        sum_[index(x, y)] += ao(x, y);
        squares_[index(x, y)] += static_cast<double>(ao(x, y)) * ao(x, y);
      }
  }
  double variance() const {
    double total = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = first_; x < last_; ++x) {
        const double mean = sum_[index(x, y)] / frames_;
        total += squares_[index(x, y)] / frames_ - mean * mean;
      }
    return total / (kHeight * (last_ - first_));
  }

 private:
  static constexpr size_t kSize = static_cast<size_t>(kWidth) * kHeight;
  static size_t index(int x, int y) { return static_cast<size_t>(y) * kWidth + static_cast<size_t>(x); }
  int first_, last_, frames_ = 0;
  std::vector<double> sum_, squares_;
};

TEST(SelectiveStory, FlickerOnGrassFallsToOneSeventeenthAndTheFloorIsLeftAlone) {
  // Columns 32 to 63: blades one pixel wide over the floor. Noise everywhere; the camera stands still.
  const Plane depth = plane_of(kWidth, kHeight, [](int x, int) { return x >= 32 && x < 64 && x % 2 ? 3.0F : 5.0F; });
  const Window window = window_of(kWidth, kHeight);
  const SelectiveTemporalParams params;
  const Plane mask = stability(params, depth);
  const auto still = standing_still(depth, window);
  TemporalHistory history;
  Flicker grass_raw(32, 64), grass(32, 64), floor_raw(0, 28), floor(0, 28);
  for (int frame = 0; frame < 340; ++frame) {
    const Plane ao = plane_of(kWidth, kHeight, [&](int x, int y) { return noise(x, y, frame); });
    const Plane out = selective_temporal_filter(params, ao, depth, mask, still, window, history);
    if (frame < 40) continue;
    grass_raw.add(ao);
    grass.add(out);
    floor_raw.add(ao);
    floor.add(out);
  }
  // An EMA of weight a = 1/9 leaves a / (2 - a) = 1/17 of white noise's variance (algorithms 7.9: n_eff 17); 300 frames
  // hold only 300/17 independent values, so the variance around their own mean is smaller by 17/300.
  const double left = grass.variance() / grass_raw.variance();
  RecordProperty("variance_left", std::to_string(left));
  EXPECT_NEAR(left * 17 / (1 - 17.0 / 300), 1, 0.02);
  EXPECT_EQ(floor.variance(), floor_raw.variance());
}

/// A box of 16x24 px that slides 3 px a frame in front of the floor and darkens the floor within 10 px of it.
struct Slide {
  int left;
  bool box(int x, int y) const { return x >= left && x < left + 16 && y >= 20 && y < 44; }
  float ao(int x, int y) const {
    if (box(x, y)) return 0.9F;
    const int dx = std::max({left - x, x - (left + 15), 0}), dy = std::max({20 - y, y - 43, 0});
    const float distance = std::hypot(static_cast<float>(dx), static_cast<float>(dy));
    return distance < 10 ? 0.3F + 0.07F * distance : 1.0F;
  }
};

struct Trail {
  float on_stable = 0;          ///< largest error of the floor's AO against this frame's own, which is exact
  int disocclusion_counts = 0;  ///< pixels just uncovered by the box whose N is not 1
};

Trail slide_box(const SelectiveTemporalParams& params) {
  const Window window = window_of(kWidth, kHeight);
  TemporalHistory history;
  Trail trail;
  for (int frame = 0; frame < 20; ++frame) {
    const Slide now{5 + 3 * frame}, before{2 + 3 * frame};
    const Plane depth = plane_of(kWidth, kHeight, [&](int x, int y) { return now.box(x, y) ? 4.0F : 5.0F; });
    const Plane ao = plane_of(kWidth, kHeight, [&](int x, int y) { return now.ao(x, y); });
    const Plane mv_x = plane_of(kWidth, kHeight, [&](int x, int y) { return now.box(x, y) ? -3.0F : 0.0F; });
    Camera camera;
    camera.fx = camera.fy = 100;
    camera.world_to_camera = Mat4();
    const auto where =
        reproject({depth, window, CameraReprojection::create(camera, camera), mv_x, Plane(kWidth, kHeight)},
                  params.reprojection, params.agreement_px);
    const Plane mask = stability(params, depth);
    const Plane out = selective_temporal_filter(params, ao, depth, mask, where, window, history);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (now.box(x, y)) continue;
        const float error = std::abs(out(x, y) - ao(x, y));
        if (mask(x, y) == 1) trail.on_stable = std::max(trail.on_stable, error);
        trail.disocclusion_counts += frame > 0 && before.box(x, y) && history.count(x, y) != 1 ? 1 : 0;
      }
  }
  return trail;
}

TEST(SelectiveStory, AMovingBoxTrailsOnTheFloorOnlyWithoutSelection) {
  SelectiveTemporalParams selective, plain;
  plain.selective = false;
  const Trail with = slide_box(selective), without = slide_box(plain);
  RecordProperty("selective", std::to_string(with.on_stable));
  RecordProperty("plain", std::to_string(without.on_stable));
  EXPECT_EQ(with.on_stable, 0.0F);
  EXPECT_GT(without.on_stable, 0.3F) << "the trail that the selection is for";
  EXPECT_EQ(with.disocclusion_counts, 0) << "no ghost of the box: what it uncovers starts anew";
  EXPECT_EQ(without.disocclusion_counts, 0);
}

TEST(SelectiveStory, InfiniteEpsilonGhostsWhereTheBoxWas) {
  SelectiveTemporalParams infinite;
  infinite.selective = false;
  infinite.epsilon = 1e9F;
  EXPECT_GT(slide_box(infinite).disocclusion_counts, 0);
}

TEST(SelectiveStory, ASlowPanKeepsALinearAoExactlyAndCountsUp) {
  // Orthographic camera, 0.3 px a frame to the right: bilinear taps of a linear ramp are exact.
  const Window window = window_of(kWidth, kHeight);
  const Plane depth(kWidth, kHeight, 5.0F), unstable(kWidth, kHeight);
  const auto camera_at = [](int frame) {
    Camera camera;
    camera.orthographic = true;
    camera.fx = camera.fy = 10;
    camera.world_to_camera = Mat4().setTranslation(Vec3(-0.03 * frame, 0, 0));
    return camera;
  };
  TemporalHistory history;
  for (int frame = 0; frame < 12; ++frame) {
    const Plane ao = plane_of(kWidth, kHeight, [&](int x, int) {
      return 0.2F + 0.005F * (static_cast<float>(x) + 0.3F * static_cast<float>(frame));
    });
    const auto where =
        reproject({depth, window, CameraReprojection::create(camera_at(frame), camera_at(frame - 1)), {}, {}},
                  temporal::ReprojectionSource::automatic, 0.5F);
    const Plane out = selective_temporal_filter({}, ao, depth, unstable, where, window, history);
    for (int x = 0; x < kWidth - 8; ++x) {  // the right border is new every frame, and its clamped fetch is one-sided
      ASSERT_NEAR(out(x, 30), ao(x, 30), 2e-6) << frame << " " << x;
      ASSERT_NEAR(history.count(x, 30), std::min(frame + 1, 8), 1e-4) << frame << " " << x;
    }
  }
}

}  // namespace
}  // namespace aftershade::tests
