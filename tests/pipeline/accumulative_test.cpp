// Accumulative SSAO and temporal refinement over short sequences: what they converge to, how they follow, and what the
// comments under seed 003 ask about (near geometry, zoom, the difference between old and new pixels).
#include <gtest/gtest.h>

#include <cstdio>

#include "core/ao/ball_samples.h"
#include "core/filter/normals.h"
#include "tests/filter/analytic_surface.h"
#include "tests/pipeline/ao_quality.h"

namespace aftershade::pipeline {
namespace {

using preset::AccumulativeSsaoParams;
using preset::TemporalRefinementParams;
using tests::Hit;
using tests::MemorySink;

constexpr int kWidth = 80, kHeight = 60;

/// One moment: a lens, the camera's place on the world's z axis, and what the world looks like from there.
struct Moment {
  double focal_px = 80, camera_x = 0, camera_z = 0;
  tests::View world_view;  ///< by absolute pixel position
  std::function<double(int x, int y)> mv_x = nullptr;
};

Frame frame_of(int number, const Moment& moment) {
  Frame frame;
  frame.number = number;
  frame.window = frame.display = {0, 0, kWidth - 1, kHeight - 1};
  Camera camera;
  camera.fx = camera.fy = moment.focal_px;
  camera.cx = kWidth / 2.0;
  camera.cy = kHeight / 2.0;
  camera.world_to_camera = Mat4().setTranslation(Vec3(-moment.camera_x, 0, -moment.camera_z));
  frame.camera = camera;
  const auto focal = static_cast<float>(moment.focal_px);
  const tests::Lens lens{focal, focal, kWidth / 2.0F, kHeight / 2.0F};
  tests::Picture p = tests::picture(kWidth, kHeight, lens, moment.world_view);
  frame.planes(Role::depth).push_back(std::move(p.depth));
  for (Plane& plane : p.normals) frame.planes(Role::normal).push_back(std::move(plane));
  if (!moment.mv_x) return frame;
  Plane mv(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) mv(x, y) = static_cast<float>(moment.mv_x(x, y));
  frame.planes(Role::velocity_prev).push_back(std::move(mv));
  frame.planes(Role::velocity_prev).emplace_back(kWidth, kHeight, 0.0F);
  return frame;
}

/// A floor 1 m below the camera's axis and a wall across it at world z = `wall_z`; the camera looks along z.
tests::View room(double focal_px, double camera_z, double wall_z = 4, double floor_m = 1) {
  const tests::Lens lens{static_cast<float>(focal_px), static_cast<float>(focal_px), kWidth / 2.0F, kHeight / 2.0F};
  return [=](double x, double y) {
    const Hit floor = tests::meet_plane(lens, x, y, {0, 1, 0}, -floor_m);
    const Hit wall = tests::meet_plane(lens, x, y, {0, 0, -1}, -(wall_z - camera_z));
    return floor.z > 0 && floor.z < wall.z ? floor : wall;
  };
}

/// A wall at 4 m and, from pixel `left` on, a board of 20x30 px half a metre in front of it.
tests::View board(int left) {
  return [left](double x, double y) {
    const bool inside = x >= left && x < left + 20 && y >= 15 && y < 45;
    return Hit{inside ? 3.5 : 4.0, Vec3(0, 0, -1)};
  };
}

template <class Params>
preset::Preset only(const Params& params) {
  return {"test", "", {{"ao", params}}};
}

template <class Params>
MemorySink run_frames(const Params& params, int last, const std::function<Moment(int)>& moment) {
  std::set<int> numbers;
  for (int i = 1; i <= last; ++i) numbers.insert(i);
  tests::MemorySource source(numbers, [&](int number) { return frame_of(number, moment(number)); });
  return tests::run_over(only(params), source, tests::frames_from_to(1, last), {"AO", true, {AovSet::all(), false}});
}

/// What all points of the sequence together give for one moment.
Plane converged(const Moment& moment, float radius_m = 1) {
  AccumulativeSsaoParams params;
  params.radius_m = radius_m;
  params.samples = 1024;
  params.miss_samples_factor = 4;
  return copy_of(run_frames(params, 1, [&](int) { return moment; }).planes.at(1).at("AO"));
}

const Plane& ao_of(const MemorySink& sink, int frame) { return sink.planes.at(frame).at("AO"); }
const Plane& count_of(const MemorySink& sink, int frame) { return sink.planes.at(frame).at("aftershade.history_age"); }

AccumulativeSsaoParams accumulative(int miss_samples_factor = 1) {
  AccumulativeSsaoParams params;
  params.miss_samples_factor = miss_samples_factor;
  return params;
}
TemporalRefinementParams unblurred() {
  TemporalRefinementParams params;
  params.blur_radius_px = 0;
  return params;
}

TEST(Accumulative, AStillCameraConvergesToTheManySampleResult) {
  const Moment still{80, 0, 0, room(80, 0), nullptr};
  const Plane truth = converged(still);
  AccumulativeSsaoParams literal = accumulative();
  literal.literal = true;
  const auto mean = run_frames(accumulative(), 30, [&](int) { return still; });
  const auto ema = run_frames(literal, 30, [&](int) { return still; });
  const auto error = [&](const MemorySink& sink, int frame) { return metrics::rmse(ao_of(sink, frame), truth); };
  for (const int frame : {1, 4, 16, 30})
    std::printf("still camera, frame %d: running mean RMSE %.4f, literal 1/30 %.4f\n", frame, error(mean, frame),
                error(ema, frame));
  // Independent samples would fall with the root of their number; the sequence does at least that.
  EXPECT_LT(error(mean, 4), error(mean, 1) / 2);
  EXPECT_LT(error(mean, 16), error(mean, 1) / 4);
  EXPECT_LT(error(mean, 30), error(mean, 1) / 5);
  // 37 % of the weight are still with the first frame (algorithms 7.9).
  EXPECT_GT(error(ema, 30), 1.5 * error(mean, 30));
}

TEST(Accumulative, PackedHistoryStaysClose) {
  const Moment still{80, 0, 0, room(80, 0), nullptr};
  const Plane truth = converged(still);
  AccumulativeSsaoParams packed = accumulative();
  packed.literal_packing = true;
  const auto sink = run_frames(packed, 30, [&](int) { return still; });
  const double with = metrics::rmse(ao_of(sink, 30), truth);
  const double without = metrics::rmse(ao_of(run_frames(accumulative(), 30, [&](int) { return still; }), 30), truth);
  std::printf("still camera, frame 30: float history RMSE %.4f, 8-bit channels %.4f\n", without, with);
  EXPECT_GT(with, without);
  EXPECT_LT(with, 0.05);
  EXPECT_EQ(count_of(sink, 30)(40, 30), 29) << "the packed depth is found again";
}

TEST(Refinement, AStillCameraConvergesToTheManySampleResult) {
  const Moment still{80, 0, 0, room(80, 0), nullptr};
  const Plane truth = converged(still);
  const auto sink = run_frames(unblurred(), 30, [&](int) { return still; });
  const auto error = [&](int frame) { return metrics::rmse(ao_of(sink, frame), truth); };
  for (const int frame : {1, 4, 16, 30})
    std::printf("still camera, frame %d: refinement RMSE %.4f, %.0f samples\n", frame, error(frame),
                static_cast<double>(count_of(sink, frame)(40, 50)));
  EXPECT_LT(error(4), error(1) / 2);
  EXPECT_LT(error(30), error(1) / 4);
  EXPECT_EQ(count_of(sink, 1)(40, 50), 32);
  EXPECT_EQ(count_of(sink, 4)(40, 50), 128) << "below 100 samples a pixel takes 32";
  EXPECT_EQ(count_of(sink, 30)(40, 50), 128 + 26 * 8) << "nothing moves: all trust is kept";
}

TEST(Refinement, IsBlurredOnlyUntilItHasConverged) {
  const Moment still{80, 0, 0, room(80, 0), nullptr};
  TemporalRefinementParams blurred;
  blurred.reference_height_px = kHeight;
  const auto with = run_frames(blurred, 6, [&](int) { return still; });
  const auto without = run_frames(unblurred(), 6, [&](int) { return still; });
  EXPECT_FALSE(tests::same_pixels(ao_of(with, 1), ao_of(without, 1)));
  const auto roughness = [](ConstPlaneView ao) {
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 1; x < kWidth; ++x) sum += std::abs(ao(x, y) - ao(x - 1, y));
    return sum;
  };
  EXPECT_LT(roughness(ao_of(with, 1)), roughness(ao_of(without, 1)) / 2);
  EXPECT_TRUE(tests::same_pixels(ao_of(with, 5), ao_of(without, 5)));
}

/// RMSE on the wall's pixels within 10 px of where the board was, by frame after it has left at frame 20.
template <class Params>
std::vector<double> after_leaving(const Params& params) {
  constexpr int kLeft = 30, kGone = 20;
  const auto sink = run_frames(params, kGone + 70, [](int number) {
    return Moment{80, 0, 0, board(number <= kGone ? kLeft : 1000), nullptr};
  });
  std::vector<double> errors;
  for (int frame = kGone + 1; frame <= kGone + 70; ++frame) {
    double squares = 0;
    int pixels = 0;
    for (int y = 20; y < 40; ++y)
      for (int x = kLeft - 10; x < kLeft; ++x, ++pixels) squares += std::pow(1 - ao_of(sink, frame)(x, y), 2);
    errors.push_back(std::sqrt(squares / pixels));
  }
  return errors;
}
int frames_to_a_tenth(const std::vector<double>& errors, double of) {
  for (size_t i = 0; i < errors.size(); ++i)
    if (errors[i] < of / 10) return static_cast<int>(i);
  return 1000;
}

TEST(Refinement, StartsAnewBesideWhatHasLeftWhereAccumulationLags) {
  const auto mean = after_leaving(accumulative()), refined = after_leaving(unblurred());
  TemporalRefinementParams blind = unblurred();
  blind.validation = ao::Validation::off;
  const auto unchecked = after_leaving(blind);
  const double start = mean.front();
  std::printf(
      "a board leaves: error beside it %.3f (accumulative), %.3f (refinement), %.3f (unchecked) in the first "
      "frame; a tenth after %d, %d, %d frames\n",
      mean.front(), refined.front(), unchecked.front(), frames_to_a_tenth(mean, start),
      frames_to_a_tenth(refined, start), frames_to_a_tenth(unchecked, start));
  EXPECT_GT(start, 0.15) << "the lag of seed 003";
  EXPECT_GT(frames_to_a_tenth(mean, start), 40) << "1/30 falls to a tenth after 68 frames";
  EXPECT_LT(refined.front(), 0.4 * start);
  EXPECT_LT(frames_to_a_tenth(refined, start), frames_to_a_tenth(mean, start) / 3);
  EXPECT_GT(unchecked.front(), start / 2) << "it is the validation that does it";
}

TEST(Refinement, DropsTheCountOnlyWhereItMatters) {
  const auto sink = run_frames(unblurred(), 12, [](int number) {
    return Moment{80, 0, 0, board(number <= 10 ? 30 : 1000), nullptr};
  });
  EXPECT_LT(count_of(sink, 11)(27, 30), 64) << "beside the board that has left";
  EXPECT_EQ(count_of(sink, 11)(79, 30), count_of(sink, 10)(79, 30) + 8) << "more than two radii away";
  EXPECT_EQ(count_of(sink, 11)(40, 30), 32) << "uncovered: nothing is known";
}

/// Zooming in from 80 px to 160 px of focal length: the comments found rooms that became brighter.
Moment zooming(int number) {
  const double focal = 80 + 8 * std::min(number - 1, 10);
  return {focal, 0, 0, room(focal, 0, 4, 0.3), nullptr};
}

template <class Params>
void expect_zoom_keeps_history(Params params, float least_count) {
  params.radius_m = 0.2F;  // 8 px in the end: away from the border nothing is seen that the zoom leaves out
  const auto sink = run_frames(params, 20, zooming);
  const Plane truth = converged(zooming(20), params.radius_m);
  Plane inside(kWidth, kHeight);
  double count = 0;
  for (int y = 12; y < kHeight - 12; ++y)
    for (int x = 12; x < kWidth - 12; ++x) {
      inside(x, y) = 1;
      count += count_of(sink, 11)(x, y) / ((kWidth - 24) * (kHeight - 24));
    }
  const double error = metrics::rmse(ao_of(sink, 20), truth, inside),
               bias = metrics::mean_error(ao_of(sink, 20), truth, inside);
  std::printf("zoom, %s: RMSE %.4f, bias %.4f, mean count %.1f after 11 frames\n", std::string(Params::method).c_str(),
              error, bias, count);
  EXPECT_LT(metrics::mean_error(truth, Plane(kWidth, kHeight, 1), inside), -0.02) << "the foot of the wall is dark";
  EXPECT_LT(error, 0.03);
  EXPECT_LT(std::abs(bias), 0.01);
  EXPECT_GT(count, least_count);
}

TEST(Accumulative, ZoomKeepsTheHistoryAndTheRadius) { expect_zoom_keeps_history(accumulative(), 9); }
TEST(Refinement, ZoomKeepsTheHistoryAndTheRadius) { expect_zoom_keeps_history(unblurred(), 100); }

/// Down to a wall 20 cm in front of the lens, a floor 10 cm below it: the balls reach behind the camera.
Moment approaching(int number) {
  const double z = 3.8 - 0.02 * std::max(10 - number, 0);
  return {80, 0, z, room(80, z, 4, 0.1), nullptr};
}

TEST(Accumulative, GeometryCloseToTheCameraKeepsItsHistory) {
  const auto sink = run_frames(accumulative(), 10, approaching);
  EXPECT_GT(count_of(sink, 10)(40, 30), 8) << "the wall";
  EXPECT_GT(count_of(sink, 10)(40, 55), 5) << "the floor under the lens";
  EXPECT_LT(metrics::rmse(ao_of(sink, 10), converged(approaching(10))), 0.06);
  const auto refined = run_frames(unblurred(), 10, approaching);
  EXPECT_GT(count_of(refined, 10)(40, 30), 60);
  EXPECT_LT(metrics::rmse(ao_of(refined, 10), converged(approaching(10))), 0.06);
}

TEST(Accumulative, ComparesTheExpectedOldDepthAndNotTheCurrentOne) {
  const auto dolly = [](int number) {
    return Moment{80, 0, 0.15 * number, room(80, 0.15 * number), nullptr};  // 4 % of the wall's distance a frame
  };
  AccumulativeSsaoParams literal = accumulative();
  literal.literal = true;
  EXPECT_GT(count_of(run_frames(accumulative(), 6, dolly), 6)(40, 30), 4);
  EXPECT_EQ(count_of(run_frames(literal, 6, dolly), 6)(40, 30), 1) << "every pixel is a miss";
}

/// The board slides 2 px a frame to the right.
Moment sliding(int number) {
  const int left = 10 + 2 * number;
  return {80, 0, 0, board(left),
          [left](int x, int y) { return x >= left && x < left + 20 && y >= 15 && y < 45 ? -2.0 : 0.0; }};
}

TEST(Accumulative, FollowsObjectsByTheirVectors) {
  AccumulativeSsaoParams camera_only = accumulative();
  camera_only.reprojection = temporal::ReprojectionSource::camera;
  const auto by_vectors = run_frames(accumulative(), 10, sliding), by_camera = run_frames(camera_only, 10, sliding);
  // The board's leading edge was wall where it is now.
  EXPECT_EQ(count_of(by_vectors, 10)(49, 30), 10);
  EXPECT_EQ(count_of(by_camera, 10)(49, 30), 1);
  EXPECT_EQ(count_of(by_vectors, 10)(28, 30), 1) << "the wall that it uncovers";
}

TEST(Accumulative, AMissTakesMoreSamplesThatCountAsMoreFrames) {
  const auto error_of_uncovered = [](const MemorySink& sink, float count) {
    const Plane truth = converged(sliding(10));
    double squares = 0;
    int pixels = 0;
    for (int y = 15; y < 45; ++y)
      for (int x = 28; x < 30; ++x, ++pixels) {
        EXPECT_EQ(count_of(sink, 10)(x, y), count);
        squares += std::pow(ao_of(sink, 10)(x, y) - truth(x, y), 2);
      }
    return std::sqrt(squares / pixels);
  };
  const double one = error_of_uncovered(run_frames(accumulative(1), 10, sliding), 1);
  const double many = error_of_uncovered(run_frames(accumulative(16), 10, sliding), 16);
  std::printf("uncovered pixels: RMSE %.4f with 16 samples, %.4f with 256\n", one, many);
  EXPECT_LT(many, one / 3);
}

TEST(Accumulative, FewAccumulatedFramesFollowFasterAndAreClampedInCount) {
  AccumulativeSsaoParams quick = accumulative();
  quick.accumulated_frames = 4;
  const auto errors = after_leaving(quick);
  EXPECT_LT(frames_to_a_tenth(errors, errors.front()), 10);
  const auto sink = run_frames(quick, 8, [](int) { return Moment{80, 0, 0, room(80, 0), nullptr}; });
  EXPECT_EQ(count_of(sink, 8)(40, 30), 3);
}

TEST(Accumulative, ACutStartsAnewAndSaysSo) {
  const auto cut = [](int number) { return Moment{80, 0, 0, room(80, 0, number < 5 ? 4 : 9), nullptr}; };
  for (const preset::Preset& preset : {only(accumulative()), only(unblurred())}) {
    tests::MemorySource source({1, 2, 3, 4, 5}, [&](int number) {
      Frame frame = frame_of(number, cut(number));
      if (number == 5) frame.camera->world_to_camera = Mat4().setTranslation(Vec3(0, 0, -50));
      return frame;
    });
    const auto sink = tests::run_over(preset, source, {1, 2, 3, 4, 5}, {"AO", true, {AovSet::all(), false}});
    EXPECT_EQ(count_of(sink, 5)(40, 20), count_of(sink, 1)(40, 20));
  }
}

}  // namespace
}  // namespace aftershade::pipeline
