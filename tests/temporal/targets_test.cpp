// The temporal filters with parameters and pixels that presets do not reach, on every SIMD target: the bits of the
// one-lane twin.
#include <gtest/gtest.h>

#include <cmath>

#include "core/temporal/accumulation.h"
#include "core/temporal/selective_temporal.h"
#include "core/temporal/temporal_blur.h"
#include "tests/support/on_all_targets.h"
#include "tests/temporal/temporal_helpers.h"
#include "tests/temporal/window_helpers.h"

namespace aftershade::tests {
namespace {

using namespace temporal;

/// Puts what files may hold in place of some values.
void spoil(Plane& plane, int seed) {
  constexpr float kSpecial[]{kNaN, kInf, -kInf, 0.0F, -0.0F, -1.0F, 3e38F, 1e-40F};
  for (int y = 0; y < plane.height(); ++y)
    for (int x = 0; x < plane.width(); ++x)
      if (noise(x, y, 70, seed) < 0.06F) plane(x, y) = kSpecial[static_cast<int>(8 * noise(x, y, 71, seed))];
}

/// One frame of a camera that moves over rough ground; windows move too.
struct RoughFrame {
  RoughFrame(int number, int width, int height) : window(window_of(width, height, 2 * number - 7, 5 - number)) {
    const auto filled = [&](int index, float low, float high) {
      Plane out = plane_of(width, height, [&](int x, int y) {
        return low + (high - low) * noise((x + window.min_x) / 6, (y + window.min_y) / 5, number, index);
      });
      spoil(out, index);
      return out;
    };
    ao = filled(1, 0, 1), depth = filled(2, 2, 6), mv_x = filled(3, -3, 3), mv_y = filled(4, -2, 2);
    nx = plane_of(width, height, [](int, int) { return 0.0F; });
    nz = plane_of(width, height, [&](int x, int y) { return noise(x, y, 5, 5) < 0.1F ? 0.0F : -1.0F; });
    camera = camera_at(Vec3(0.03 * number, 0.01, 0.1 * number));
  }
  filter::Surface surface() const {
    filter::Surface out = surface_of(depth, local_projection(camera, window.min_x, window.min_y));
    out.nx = nx, out.ny = nx, out.nz = nz;
    out.origin_x = window.min_x, out.origin_y = window.min_y;
    return out;
  }
  ReprojectionInput input(const RoughFrame& before, bool with_camera, bool with_vectors) const {
    ReprojectionInput out{depth, window, {}, {}, {}};
    if (with_camera) out.camera = CameraReprojection::create(camera, before.camera);
    if (with_vectors) out.mv_prev_x = mv_x, out.mv_prev_y = mv_y;
    return out;
  }
  Window window;
  Plane ao, depth, mv_x, mv_y, nx, nz;
  Camera camera;
};

const std::pair<int, int> kSizes[]{{131, 23}, {37, 9}, {3, 2}, {1, 1}};

/// Runs `make` for two frames of all sizes, with reprojection by camera, by vectors and by both.
void expect_frames_same(
    const std::string& name,
    const std::function<std::vector<Plane>(const RoughFrame&, const RoughFrame&, const ReprojectionInput&)>& make) {
  for (const auto& [width, height] : kSizes)
    for (int known = 1; known <= 3; ++known) {
      const RoughFrame before(0, width, height), now(1, width, height);
      const ReprojectionInput input = now.input(before, (known & 1) != 0, (known & 2) != 0);
      expect_same(cat(name, ", ", width, " x ", height, ", ", known), [&] { return make(before, now, input); });
    }
}

TEST(TemporalTargets, SelectiveFilterAndItsMask) {
  for (const bool literal : {false, true})
    for (const int step : {1, 2}) {
      SelectiveTemporalParams params;
      params.literal = literal, params.dilation_texels = step == 1 ? 3 : 4, params.epsilon = 0.3F;
      expect_frames_same("selective", [&](const RoughFrame& before, const RoughFrame& now,
                                          const ReprojectionInput& input) {
        const filter::Surface surface = now.surface();
        const filter::SampleGrid grid = step == 1 ? filter::full_grid(surface) : filter::half_grid(surface);
        Plane mask = continuity_mask(params, grid, surface);
        const Plane wide = dilate_discontinuities(mask, params.dilation_texels);
        TemporalHistory history;
        const Plane none(before.window.width(), before.window.height());
        const Reprojected still = standing_still(before.depth, before.window);
        selective_temporal_filter(params, before.ao, before.depth, none, still, before.window, history);
        const Reprojection past(input, ReprojectionSource::automatic, 0.5F);
        const double lost = share_without_history(now.depth, now.window, past, history.depth, history.window);
        std::vector<Plane> out;
        out.push_back(selective_temporal_filter(params, now.ao, now.depth, {wide, grid}, past, now.window, history));
        for (Plane* plane : {&history.ao, &history.depth, &history.count, &mask}) out.push_back(std::move(*plane));
        out.push_back(Plane(1, 1, static_cast<float>(lost)));
        return out;
      });
    }
}

TEST(TemporalTargets, AlongPlanesOrRowsIsTheSame) {
  const RoughFrame before(0, 131, 23), now(1, 131, 23);
  const ReprojectionInput input = now.input(before, true, true);
  const auto filtered = [&](const auto& past) {
    SelectiveTemporalParams params;
    params.selective = false;
    TemporalHistory history;
    const Plane none(131, 23);
    selective_temporal_filter(params, before.ao, before.depth, none, standing_still(before.depth, before.window),
                              before.window, history);
    return selective_temporal_filter(params, now.ao, now.depth, none, past, now.window, history);
  };
  EXPECT_EQ(different_pixels(filtered(Reprojection(input, ReprojectionSource::automatic, 0.5F)),
                             filtered(reproject(input, ReprojectionSource::automatic, 0.5F))),
            0);
}

TEST(TemporalTargets, Accumulation) {
  expect_frames_same("accumulation", [](const RoughFrame& before, const RoughFrame& now,
                                        const ReprojectionInput& input) {
    const Plane weight(now.ao.width(), now.ao.height(), 2.5F);
    AccumulationHistory history =
        accumulate(look_up({}, standing_still(before.depth, before.window), before.depth, 0.1F),
                   {before.ao, weight, before.depth, before.window}, 30);
    history.next = plane_of(now.ao.width(), now.ao.height(), [](int x, int y) { return static_cast<float>(x + y); });
    const Reprojected past = reproject(input, ReprojectionSource::automatic, 0.5F);
    Past found = look_up(history, past, now.depth, 0.3F);
    AccumulationHistory after = accumulate(found, {now.ao, weight, now.depth, now.window}, 4);
    pack_literally(after, 100);
    std::vector<Plane> out;
    for (Plane* plane : {&found.ao, &found.weight, &found.next, &after.ao, &after.depth, &after.weight})
      out.push_back(std::move(*plane));
    return out;
  });
}

TEST(TemporalTargets, TemporalBlur) {
  for (const bool literal : {false, true})
    for (const int step : {1, 2}) {
      TemporalBlurParams params;
      params.literal = literal, params.warm_start = step == 1, params.cut_m = 0.5F, params.near_m = 1, params.far_m = 2;
      params.weights = literal ? BlurTaps::binomial : BlurTaps::box;
      expect_frames_same(
          "temporal blur", [&](const RoughFrame& before, const RoughFrame& now, const ReprojectionInput& input) {
            TemporalBlurHistory history;
            const auto one = [&](const RoughFrame& frame, const Reprojected& past) {
              const filter::Surface surface = frame.surface();
              const filter::SampleGrid grid = step == 1 ? filter::full_grid(surface) : filter::half_grid(surface);
              Plane value = plane_of(grid.width(), grid.height(), [&](int x, int y) { return noise(x, y, 3, 3); });
              spoil(value, 9);
              return temporal_blur(params, value, grid, surface, past, history);
            };
            std::vector<Plane> out;
            out.push_back(one(before, standing_still(before.depth, before.window)));
            out.push_back(one(now, reproject(input, ReprojectionSource::automatic, 0.5F)));
            for (Plane* plane : {&history.value, &history.variance, &history.weight}) out.push_back(std::move(*plane));
            return out;
          });
    }
}

TEST(TemporalTargets, TemporalWindow) {
  const std::vector<WindowFrame> frames = busy_frames(7);
  for (const ChangeTest test : {ChangeTest::near_moving, ChangeTest::everywhere, ChangeTest::never})
    for (const size_t centre : {0U, 3U, 5U}) {
      TemporalWindowParams params;
      params.frames = 4, params.change_test = test, params.occluder_radius_m = 0.5F;
      expect_same("temporal window", [&] {
        WindowedAo result = windowed(params, frames, centre);
        std::vector<Plane> out;
        out.push_back(std::move(result.ao));
        out.push_back(std::move(result.weight));
        return out;
      });
    }
}

}  // namespace
}  // namespace aftershade::tests
