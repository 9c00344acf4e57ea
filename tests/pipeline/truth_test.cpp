// The main job against truth: ray-traced AO and accumulated motion blur, on the synthetic scenes and, when it is there,
// on the public sequence rendered with Blender. Bounds are regressions a little below what was measured; the figures
// are printed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "core/io/file_source.h"
#include "core/metrics/image_metrics.h"
#include "core/pipeline/pipeline.h"
#include "tests/pipeline/memory_sequence.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"
#include "tests/support/truth_cache.h"

namespace aftershade::pipeline {
namespace {

namespace fs = std::filesystem;
const Offer kEverything{{Role::depth, Role::normal, Role::velocity_prev, Role::velocity_next}, true, true};

preset::Preset only(const std::string& name, const std::vector<std::string>& ids,
                    const std::vector<std::string>& sets = {}) {
  preset::Preset preset = preset::load_preset(name, sets).preset;
  std::erase_if(preset.stages,
                [&](const auto& stage) { return std::find(ids.begin(), ids.end(), stage.id) == ids.end(); });
  return preset;
}

tests::MemorySink run_preset(const preset::Preset& preset, FrameSource& source, std::vector<int> frames,
                             const Outputs& outputs) {
  std::vector<ViewPipeline> views;
  views.emplace_back(preset, "", kEverything, outputs);
  tests::MemorySink sink;
  RunOptions options;
  options.written = options.on_disk = std::move(frames);
  run(views, source, sink, options);
  return sink;
}

metrics::Rgb rgb(const std::map<std::string, Plane>& planes, const std::string& prefix = "") {
  return {planes.at(prefix + "R"), planes.at(prefix + "G"), planes.at(prefix + "B")};
}

const std::vector<std::string> kAo = {"ao", "blur", "upsample", "temporal"};

TEST(SceneTruth, AoOfTheColumnsResemblesTheRayTracedOne) {
  constexpr int width = 240, height = 135;
  const tests::Scene& scene = tests::find_scene("columns");
  tests::SceneSource source(scene, {width, height, 1}, 1, 4);
  const Plane truth = tests::cached_ao_truth("columns", 4, width, height, {});
  const tests::MemorySink sink = run_preset(only("high-dx11", kAo), source, {1, 2, 3, 4}, {"AO", true, {}});
  const Plane& ao = sink.planes.at(4).at("AO");
  const double rmse = metrics::rmse(ao, truth), correlation = metrics::correlation(ao, truth);
  std::cout << "columns, high-dx11: RMSE " << rmse << ", correlation " << correlation << "\n";
  EXPECT_LT(rmse, 0.2);
  EXPECT_GT(correlation, 0.7);
}

TEST(SceneTruth, BlurOfCrossingObjectsComesCloserToTheTruth) {
  const tests::RenderSettings settings{240, 135, 4};
  const tests::Scene& scene = tests::find_scene("crossing");
  const std::vector<Plane> truth = tests::cached_blur_truth("crossing", 4, 0.5, 64, settings);
  tests::SceneSource source(scene, settings, 4, 4);
  const Frame sharp = *source.load(4, "", {}, true);
  const preset::Preset blur =
      only("high-dx11", {"motion_blur"}, {"motion_blur.max_radius_px=320"});  // no clamp at 135 lines
  const tests::MemorySink sink = run_preset(blur, source, {4}, {});
  const metrics::Rgb target{truth[0], truth[1], truth[2]};
  const auto& before = sharp.layers.front().planes;
  const double psnr_before = metrics::display_psnr({before[0], before[1], before[2]}, target);
  const double psnr = metrics::display_psnr(rgb(sink.planes.at(4)), target);
  std::cout << "crossing: PSNR " << psnr_before << " dB unblurred, " << psnr << " dB blurred\n";
  EXPECT_GT(psnr, psnr_before + 3);
}

/// Mean of every `factor` x `factor` block.
Plane downsampled(ConstPlaneView plane, int factor) {
  Plane out(plane.width / factor, plane.height / factor);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      double sum = 0;
      for (int i = 0; i < factor * factor; ++i) sum += plane(x * factor + i % factor, y * factor + i / factor);
      out(x, y) = static_cast<float>(sum / (factor * factor));
    }
  return out;
}

/// A preset means the same at 720 lines and at 4K: pixel lengths scale with the height (AO and beauty, downsampled).
TEST(Scale, APresetMeansTheSameAt720LinesAndAt4K) {
  std::map<int, std::map<std::string, Plane>> results;
  for (const int factor : {1, 3}) {
    const tests::Scene& scene = tests::find_scene("columns");
    tests::SceneSource source(scene, {1280 * factor, 720 * factor, 1}, 4, 4);
    tests::MemorySink sink = run_preset(preset::load_preset("high-dx11").preset, source, {4}, {"AO", true, {}});
    for (const auto& [channel, plane] : sink.planes.at(4)) results[factor][channel] = downsampled(plane, factor);
  }
  const double ao = metrics::rmse(results[1].at("AO"), results[3].at("AO"));
  const double red = metrics::rmse(results[1].at("R"), results[3].at("R"));
  std::cout << "720 lines against 4K: RMSE of AO " << ao << ", of red " << red << "\n";
  EXPECT_LT(ao, 0.015);
  EXPECT_LT(red, 0.03);
}

/// The public sequence; skips loudly when it is not there.
class Yard : public testing::Test {
 protected:
  void SetUp() override {
    const char* data = std::getenv("AFTERSHADE_DATA");
    folder_ = fs::path(data ? data : AFTERSHADE_SOURCE_DIR "/../shared/data") / "yard";
    if (!fs::exists(folder_)) GTEST_SKIP() << "NOT TESTED: no public data at " << folder_ << " (set AFTERSHADE_DATA)";
  }
  io::FileSource open(const std::string& name, const std::map<std::string, std::string>& channels = {}) const {
    io::SourceOptions options;
    options.sequence = io::find_sequence((folder_ / (name + ".####.exr")).string(), io::HashDigits::one).sequence;
    options.profile = io::load_profile(name == "yard" ? "blender" : "generic");
    options.channel_overrides = channels;
    return io::FileSource(std::move(options));
  }
  fs::path folder_;
};

TEST_F(Yard, MotionBlurComesCloserToTheTrueOneOnEveryFrame) {
  io::FileSource source = open("yard"), truth = open("yard_blur");
  const preset::Preset blur = only("high-dx11", {"motion_blur"});
  double sum = 0, sum_before = 0;
  for (int frame = 1; frame <= 12; ++frame) {
    const Frame target = *truth.load(frame, "", {}, true), sharp = *source.load(frame, "", {}, true);
    const auto planes = [](const Frame& f) {
      return metrics::Rgb{f.layers[0].planes[0], f.layers[0].planes[1], f.layers[0].planes[2]};
    };
    const tests::MemorySink sink = run_preset(blur, source, {frame}, {});
    const double before = metrics::display_psnr(planes(sharp), planes(target));
    const double after = metrics::display_psnr(rgb(sink.planes.at(frame), "ViewLayer.Combined."), planes(target));
    EXPECT_GT(after, before + 2.5) << "frame " << frame;
    sum += after / 12, sum_before += before / 12;
  }
  std::cout << "yard, high-dx11 blur: PSNR " << sum_before << " dB unblurred, " << sum
            << " dB blurred (mean of 12 frames)\n";
  EXPECT_GT(sum, 32.5);
}

TEST_F(Yard, AoResemblesTheRayTracedOne) {
  for (const auto& [name, least] : {std::pair{"high-dx11", 0.75}, {"high-current-gen", 0.45}, {"ultra-dx11", 0.75}}) {
    io::FileSource source = open("yard"), truth = open("yard_ao");
    const tests::MemorySink sink =
        run_preset(only(name, kAo), source, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, {"AO", true, {}});
    double rmse = 0, bias = 0, correlation = 0;
    for (int frame = 1; frame <= 12; ++frame) {
      const Frame target = *truth.load(frame, "", {Role::ao}, false),
                  input = *source.load(frame, "", {Role::depth}, false);
      Plane mask(input.window.width(), input.window.height());
      for (int y = 0; y < mask.height(); ++y)
        for (int x = 0; x < mask.width(); ++x) mask(x, y) = std::isfinite(input.depth()(x, y)) ? 1.0F : 0.0F;
      const Plane &ao = sink.planes.at(frame).at("AO"), &want = target.planes(Role::ao)[0];
      rmse += metrics::rmse(ao, want, mask) / 12;
      bias += metrics::mean_error(ao, want, mask) / 12;
      correlation += metrics::correlation(ao, want, mask) / 12;
    }
    std::cout << "yard, " << name << ": RMSE " << rmse << ", bias " << bias << ", correlation " << correlation
              << " (mean of 12 frames)\n";
    EXPECT_GT(correlation, least) << name;
    EXPECT_LT(rmse, 0.26) << name;
  }
}

}  // namespace
}  // namespace aftershade::pipeline
