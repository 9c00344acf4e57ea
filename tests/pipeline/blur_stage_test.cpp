// What all motion blur stages share, through the pipeline: where motion comes from, and what it costs to know it.
#include "core/pipeline/blur_stage.h"

#include <gtest/gtest.h>

#include <iostream>

#include "core/base/error.h"
#include "core/math/sampling.h"
#include "core/metrics/image_metrics.h"
#include "core/pipeline/pipeline.h"
#include "tests/pipeline/ao_quality.h"
#include "tests/pipeline/memory_sequence.h"

namespace aftershade::pipeline {
namespace {

using tests::blade_frame;
using tests::MemorySink;
using tests::MemorySource;
using tests::same_pixels;

const Offer kVectors{{Role::depth, Role::velocity_prev, Role::velocity_next}, true, true};
const Offer kCamera{{Role::depth}, true, true};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The blades, with a noise that moves with them.
Frame noisy_frame(int number) {
  Frame frame = blade_frame(number);
  const Camera& camera = *frame.camera;
  const double camera_x = -(*camera.world_to_camera)[3][0];
  for (int y = 0; y < 36; ++y)
    for (int x = 0; x < 48; ++x) {
      const double world_x = (x + 0.5 - camera.cx) / camera.fx * frame.depth()(x, y) + camera_x;
      const auto cell = static_cast<uint32_t>(1000 + std::floor(world_x * 20));
      frame.layers[0].planes[0](x, y) = unit_float(hash_counters(cell, static_cast<uint32_t>(y / 4)));
    }
  return frame;
}

preset::Preset blur_preset(const std::vector<std::string>& sets = {}) {
  std::vector<std::string> all{"motion_blur.max_radius_px=500"};
  all.insert(all.end(), sets.begin(), sets.end());
  preset::Preset preset = preset::load_preset("high-dx11", all).preset;
  std::erase_if(preset.stages, [](const auto& stage) { return stage.id != "motion_blur"; });
  return preset;
}

struct Result {
  Plane red;
  std::vector<std::string> notes, warnings;
  std::vector<MemorySource::Load> loads;
};
/// Frame `number` of a sequence 1 to 4, blurred.
Result blurred(const std::vector<std::string>& sets, const Offer& offer, const std::function<Frame(int)>& make,
               int number = 2, std::set<int> on_disk = {1, 2, 3, 4}) {
  MemorySource source(std::move(on_disk), make);
  std::vector<ViewPipeline> views;
  views.emplace_back(blur_preset(sets), "", offer, Outputs{});
  MemorySink sink;
  RunOptions options;
  options.written = {number};
  options.on_disk = source.numbers();
  Result result;
  options.on_progress = [&](const Progress& progress) {
    if (!progress.written) return;
    result.notes = progress.reports.front().notes;
    result.warnings = progress.reports.front().warnings;
  };
  run(views, source, sink, options);
  result.red = std::move(sink.planes.at(number).at("R"));
  result.loads = source.loads;
  return result;
}

std::string message_of(const std::vector<std::string>& sets, const Offer& offer) {
  try {
    ViewPipeline(blur_preset(sets), "", offer, {});
  } catch (const Error& error) {
    return std::string(error.what()) + " " + error.hint();
  }
  return "no error";
}

bool says(const std::vector<std::string>& texts, const std::string& text) {
  return std::ranges::any_of(texts, [&](const std::string& t) { return t.find(text) != std::string::npos; });
}

TEST(BlurStage, LooksAtOneFrameWhereVectorsSuffice) {
  EXPECT_TRUE(ViewPipeline(blur_preset(), "", kVectors, {}).dependencies().empty());
  EXPECT_TRUE(ViewPipeline(blur_preset({"motion_blur.min_speed_px=1", "motion_blur.added_zoom=0.1"}), "", kVectors, {})
                  .dependencies()
                  .empty());
  const Result result = blurred({}, kVectors, noisy_frame);
  EXPECT_EQ(result.loads, (std::vector<MemorySource::Load>{{2, true}}));
  EXPECT_TRUE(result.notes.empty() && result.warnings.empty());
}

TEST(BlurStage, LooksAtTheCamerasBesideWhereTheyAreWanted) {
  for (const std::string set : {"camera_motion=0.5", "object_motion=0", "unknown_vectors=camera"})
    EXPECT_EQ(ViewPipeline(blur_preset({"motion_blur." + set}), "", kVectors, {}).dependencies().size(), 1U) << set;
  EXPECT_EQ(ViewPipeline(blur_preset(), "", kCamera, {}).dependencies().size(), 1U);
  const Offer no_position{kVectors.roles, true, false};
  EXPECT_TRUE(
      ViewPipeline(blur_preset({"motion_blur.unknown_vectors=camera"}), "", no_position, {}).dependencies().empty());
}

TEST(BlurStage, OfTheCameraAloneIsThatOfTheVectors) {
  const Plane expected = blurred({}, kVectors, noisy_frame).red, sharp = copy_of(noisy_frame(2).layers[0].planes[0]);
  EXPECT_GT(metrics::rmse(expected, sharp), 0.05);
  for (const std::set<int>& on_disk : {std::set{1, 2, 3, 4}, {1, 2}, {2, 3}}) {
    const Result result = blurred({}, kCamera, noisy_frame, 2, on_disk);
    EXPECT_LT(metrics::rmse(result.red, expected), 1e-4) << "with " << on_disk.size() << " frames";
    EXPECT_TRUE(says(result.notes, "motion is the camera's alone"));
    EXPECT_TRUE(result.warnings.empty());
  }
}

TEST(BlurStage, OfTheCameraAloneWithoutANeighbourIsNone) {
  const Result result = blurred({}, kCamera, noisy_frame, 2, {2, 4});
  EXPECT_TRUE(same_pixels(result.red, noisy_frame(2).layers[0].planes[0]));
  EXPECT_TRUE(says(result.warnings, "no frame beside this one"));
}

Frame frame_with_holes(int number) {
  Frame frame = noisy_frame(number);
  for (const Role role : {Role::velocity_prev, Role::velocity_next})
    for (int y = 0; y < 36; ++y)
      for (int x = 0; x < 48; x += 2) frame.planes(role)[0](x, y) = y % 2 == 0 ? kNan : 1e20F;
  return frame;
}

TEST(BlurStage, UnknownVectorsAreCompletedFromTheCamera) {
  const Plane expected = blurred({}, kVectors, noisy_frame).red;
  const Result completed = blurred({"motion_blur.unknown_vectors=camera"}, kVectors, frame_with_holes);
  EXPECT_LT(metrics::rmse(completed.red, expected), 1e-4);
  EXPECT_TRUE(says(completed.notes, "pixels without a vector move as the camera does"));
  EXPECT_TRUE(blurred({"motion_blur.unknown_vectors=camera"}, kVectors, noisy_frame).notes.empty());
  const Result alone = blurred({"motion_blur.unknown_vectors=camera"}, kVectors, frame_with_holes, 2, {2});
  EXPECT_TRUE(says(alone.notes, "pixels without a vector stay sharp"));
  const Result still = blurred({}, kVectors, frame_with_holes);
  EXPECT_TRUE(still.notes.empty()) << "as was asked for";
  EXPECT_GT(metrics::rmse(still.red, expected), 0.02);
}

TEST(BlurStage, SharesOfCameraAndObjects) {
  const Plane sharp = copy_of(noisy_frame(2).layers[0].planes[0]), full = blurred({}, kVectors, noisy_frame).red;
  EXPECT_TRUE(same_pixels(blurred({"motion_blur.camera_motion=0"}, kVectors, noisy_frame).red, sharp));
  EXPECT_LT(metrics::rmse(blurred({"motion_blur.object_motion=0"}, kVectors, noisy_frame).red, full), 1e-4);
  const Plane doubled = blurred({"motion_blur.camera_motion=2"}, kVectors, noisy_frame).red;
  const Plane long_shutter = blurred({"motion_blur.shutter_frames=1"}, kVectors, noisy_frame).red;
  EXPECT_LT(metrics::rmse(doubled, long_shutter), 1e-4);
  EXPECT_TRUE(
      says(blurred({"motion_blur.camera_motion=0"}, kVectors, noisy_frame, 2, {2}).warnings, "no frame beside"));
}

TEST(BlurStage, SpeedLimits) {
  const Frame frame = noisy_frame(2);
  const Plane& sharp = frame.layers[0].planes[0];
  const Result slow_stays = blurred({"motion_blur.min_speed_px=3.3"}, kVectors, noisy_frame);  // wall 3, blades 3.6
  const auto wall = [&](int x) { return x < 0 || x > 47 || frame.depth()(x, 18) > 2.9F; };
  int blurred_wall = 0;  // where no blade's blur of 0.9 px reaches
  for (int x = 0; x < 48; ++x)
    if (wall(x - 1) && wall(x) && wall(x + 1)) blurred_wall += slow_stays.red(x, 18) != sharp(x, 18);
  EXPECT_EQ(blurred_wall, 0);
  EXPECT_TRUE(same_pixels(blurred({"motion_blur.min_speed_px=5"}, kVectors, noisy_frame).red, sharp));
  EXPECT_FALSE(same_pixels(slow_stays.red, sharp));
}

Frame still_frame(int number) {
  Frame frame = noisy_frame(number);
  for (const Role role : {Role::velocity_prev, Role::velocity_next})
    for (Plane& plane : frame.planes(role)) plane = Plane(48, 36);
  frame.named["push"] = Plane(48, 36, 6);
  frame.named["mask"] = Plane(48, 36);
  for (int y = 0; y < 36; ++y)
    for (int x = 0; x < 12; ++x) frame.named["mask"](x, y) = 1;
  return frame;
}

Frame moving_frame(int number) {
  Frame frame = still_frame(number);
  frame.planes(Role::velocity_prev)[0] = Plane(48, 36, -6);
  frame.planes(Role::velocity_next)[0] = Plane(48, 36, 6);
  return frame;
}

TEST(BlurStage, ALimitedSpeedBlursAsThatSpeedDoes) {
  const Plane half = blurred({}, kVectors, moving_frame).red;
  const Plane limited =
      blurred({"motion_blur.max_speed_px=3", "motion_blur.shutter_frames=1"}, kVectors, moving_frame).red;
  EXPECT_TRUE(same_pixels(limited, half));
  EXPECT_FALSE(same_pixels(limited, blurred({"motion_blur.shutter_frames=1"}, kVectors, moving_frame).red));
}

TEST(BlurStage, AddedMotionIsLikeMotion) {
  const Plane sharp = copy_of(still_frame(2).layers[0].planes[0]);
  const Plane expected = blurred({}, kVectors, moving_frame).red;
  EXPECT_TRUE(same_pixels(blurred({"motion_blur.added_x_px=6"}, kVectors, still_frame).red, expected));
  EXPECT_TRUE(same_pixels(blurred({"motion_blur.added_velocity_x=push"}, kVectors, still_frame).red, expected));
  EXPECT_FALSE(same_pixels(blurred({"motion_blur.added_velocity_y=push"}, kVectors, still_frame).red, expected));
  EXPECT_FALSE(same_pixels(blurred({"motion_blur.added_y_px=6"}, kVectors, still_frame).red, sharp));
  const Plane masked = blurred({"motion_blur.added_x_px=6", "motion_blur.added_mask=mask"}, kVectors, still_frame).red;
  int left = 0, right = 0;
  for (int x = 0; x < 48; ++x) (x < 12 ? left : right) += masked(x, 18) != sharp(x, 18);
  EXPECT_GT(left, 8);
  EXPECT_LT(right, 5) << "the light of 12 columns reaches 1.5 columns farther";
}

TEST(BlurStage, AddedZoomLeavesTheCentreSharp) {
  const Plane sharp = copy_of(still_frame(2).layers[0].planes[0]);
  const Plane zoomed = blurred({"motion_blur.added_zoom=0.5"}, kVectors, still_frame).red;
  double centre = 0, border = 0;
  for (int y = 0; y < 36; ++y) {
    for (const int x : {23, 24}) centre += y > 15 && y < 20 ? std::abs(zoomed(x, y) - sharp(x, y)) : 0;
    for (const int x : {4, 43}) border += std::abs(zoomed(x, y) - sharp(x, y));
  }
  EXPECT_LT(centre / 8, 0.05);
  EXPECT_GT(border / 72, 0.1);
}

TEST(BlurStage, ReadsAMaskAsEarlierStagesLeftIt) {
  Frame frame = still_frame(2);
  frame.added["mask"] = Plane(48, 36);  // a stage has emptied it
  const Plane sharp = copy_of(frame.layers[0].planes[0]);
  ViewPipeline view(blur_preset({"motion_blur.added_x_px=6", "motion_blur.added_mask=mask"}), "", kVectors, {});
  view.push(std::move(frame), {}, {2, view.stages(), true, true});
  view.flush();
  EXPECT_TRUE(same_pixels(view.take_finished().at(0).frame.layers[0].planes[0], sharp));
}

TEST(BlurStage, NamesWhatIsMissing) {
  const std::string nothing = message_of({}, {{Role::depth}, true, false});
  EXPECT_NE(nothing.find("velocity_prev or velocity_next, or depth and camera matrices"), std::string::npos) << nothing;
  for (const std::string set : {"motion_blur.camera_motion=0.5", "motion_blur.object_motion=0.5"}) {
    const std::string position = message_of({set}, {kVectors.roles, true, false});
    EXPECT_NE(position.find("where the camera stands"), std::string::npos) << position;
    EXPECT_EQ(position.find("reprojection"), std::string::npos) << "no parameter of this stage";
    const std::string depth = message_of({set}, {{Role::velocity_next}, true, true});
    EXPECT_NE(depth.find("needs depth"), std::string::npos) << depth;
  }
}

TEST(BlurStage, WithoutALimitBlursAsFarAsTheLongestMotion) {
  const Plane far =
      blurred({"motion_blur.max_radius_px=0", "motion_blur.shutter_frames=2"}, kVectors, moving_frame).red;
  const Plane as_far = blurred({"motion_blur.max_radius_px=180", "motion_blur.shutter_frames=2"}, kVectors,
                               moving_frame)
                           .red;  // 6 px at 36 lines
  EXPECT_TRUE(same_pixels(far, as_far));
}

/// Overscan is used: what lies outside the display window blurs into it.
TEST(BlurStage, OverscanBlursIntoThePicture) {
  const auto frame = [](int number) {
    Frame f = noisy_frame(number);
    f.display = {12, 0, 35, 35};
    for (Plane* plane : {&f.planes(Role::velocity_prev)[0], &f.planes(Role::velocity_next)[0]})
      for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 48; ++x) (*plane)(x, y) *= 4;
    return f;
  };
  const auto cropped = [&](int number) {
    Frame f = frame(number);
    Work work(f, nullptr, {});
    work.change_window(f.display);
    f.layers[0].data_window = f.display;
    return f;
  };
  const Plane wide = blurred({}, kVectors, frame).red, narrow = blurred({}, kVectors, cropped).red;
  ASSERT_EQ(wide.width(), 48);
  ASSERT_EQ(narrow.width(), 24);
  double border = 0, middle = 0;
  for (int y = 0; y < 36; ++y) {
    border += std::abs(wide(12, y) - narrow(0, y)) + std::abs(wide(35, y) - narrow(23, y));
    middle += std::abs(wide(24, y) - narrow(12, y));
  }
  EXPECT_GT(border / 72, 0.02);
  EXPECT_LT(middle / 36, 1e-6);
}

/// Median, over the pixels with such a depth, of the distance in pixels between two forward motions.
double median_difference(const motionblur::Motion& a, const motionblur::Motion& b, ConstPlaneView depth,
                         bool background) {
  std::vector<double> differences;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      if (std::isinf(depth(x, y)) == background)
        differences.push_back(std::hypot(a.next_x(x, y) - b.next_x(x, y), a.next_y(x, y) - b.next_y(x, y)));
  if (differences.empty()) return 0;
  std::ranges::nth_element(differences, differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2));
  return differences[differences.size() / 2];
}

TEST(BlurStageYard, TheCamerasMotionIsThatOfTheFilesVectors) {
  if (tests::yard_folder().empty()) GTEST_SKIP() << "NOT TESTED: no public data (set AFTERSHADE_DATA)";
  io::FileSource source = tests::open_yard("yard");
  for (const int number : {2, 6, 11}) {
    const Frame frame = *source.load(number, "", {Role::depth, Role::velocity_prev, Role::velocity_next}, false);
    motionblur::MotionSources vectors;
    vectors.prev_x = frame.planes(Role::velocity_prev)[0], vectors.prev_y = frame.planes(Role::velocity_prev)[1];
    vectors.next_x = frame.planes(Role::velocity_next)[0], vectors.next_y = frame.planes(Role::velocity_next)[1];
    vectors.window = frame.window, vectors.display = frame.display;
    motionblur::MotionSources camera;
    camera.depth = frame.depth();
    camera.window = frame.window, camera.display = frame.display;
    camera.before = CameraReprojection::create(*frame.camera, *source.load(number - 1, "", {}, false)->camera);
    camera.after = CameraReprojection::create(*frame.camera, *source.load(number + 1, "", {}, false)->camera);
    const motionblur::Motion by_camera = motion_of({}, camera), by_vectors = motion_of({}, vectors);
    const double surfaces = median_difference(by_vectors, by_camera, frame.depth(), false);
    const double background = median_difference(by_vectors, by_camera, frame.depth(), true);
    std::cout << "yard, frame " << number << ": the camera's motion differs from the vectors by " << surfaces
              << " px, in the background, where they are 0, by " << background << " px (medians)\n";
    EXPECT_LT(surfaces, 0.005);
    vectors.depth = camera.depth, vectors.before = camera.before, vectors.after = camera.after;
    EXPECT_EQ(median_difference(motion_of({}, vectors), by_camera, frame.depth(), true), 0);
  }
}

/// Blender's Vector Blur node reaches 34.0 dB on these frames, 33.7 to 34.3.
TEST(BlurStageYard, TheSeedsBlurWithoutItsLimitIsCloserToTheTruthThanBlenders) {
  if (tests::yard_folder().empty()) GTEST_SKIP() << "NOT TESTED: no public data (set AFTERSHADE_DATA)";
  io::FileSource source = tests::open_yard("yard"), truth = tests::open_yard("yard_blur");
  const MemorySink sink = tests::run_over(blur_preset({"motion_blur.max_radius_px=0"}), source,
                                          tests::frames_from_to(1, tests::kYardFrames), {});
  double mean = 0;
  for (int number = 1; number <= tests::kYardFrames; ++number) {
    const Frame target = *truth.load(number, "", {}, true);
    const std::vector<Plane>& t = target.layers[0].planes;
    const std::map<std::string, Plane>& made = sink.planes.at(number);
    const double psnr = metrics::display_psnr(
        {made.at("ViewLayer.Combined.R"), made.at("ViewLayer.Combined.G"), made.at("ViewLayer.Combined.B")},
        {t[0], t[1], t[2]});
    EXPECT_GT(psnr, 34.8) << "frame " << number;
    mean += psnr / tests::kYardFrames;
  }
  std::cout << "yard, the seed's blur without its limit: PSNR " << mean << " dB (mean of 12 frames)\n";
  EXPECT_GT(mean, 35.2);
}

}  // namespace
}  // namespace aftershade::pipeline
