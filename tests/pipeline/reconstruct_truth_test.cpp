// reconstruct against accumulated truth; figures are printed.
#include <gtest/gtest.h>

#include <iostream>

#include "tests/pipeline/blur_quality.h"

namespace aftershade::tests {
namespace {

constexpr BlurMethod kGatherPlus{.name = "gather-plus", .method = "gather-plus"};
constexpr BlurMethod kReconstruct{.name = "reconstruct", .method = "reconstruct"};

/// Blender 3.4.1's Vector Blur node reaches 33.7 to 34.3 dB on these frames, 34.0 in the mean.
TEST(ReconstructTruth, IsThreeAndAHalfDecibelsAboveBlendersVectorBlurOnTheYard) {
  if (yard_folder().empty()) GTEST_SKIP() << "NOT TESTED: no public data (set AFTERSHADE_DATA)";
  const BlurCase yard = yard_blur_case(frames_from_to(1, kYardFrames));
  double mean_db = 0, lowest_db = 100, uncovered_db = 0;
  for (const auto& [number, score] : blur_scores(yard, kReconstruct, true)) {
    EXPECT_GT(score.psnr, 37) << "frame " << number;
    EXPECT_NEAR(score.radiance, 1, 1e-3) << "frame " << number;
    mean_db += score.psnr / kYardFrames;
    uncovered_db += score.psnr_uncovered / kYardFrames;
    lowest_db = std::min(lowest_db, score.psnr);
  }
  std::cout << "yard: PSNR " << mean_db << " dB, least " << lowest_db << " dB, where the frame shows nothing "
            << uncovered_db << " dB\n";
  EXPECT_GT(mean_db, 37.5);
  EXPECT_GT(uncovered_db, 32);
}

class ReconstructScene : public testing::TestWithParam<const char*> {};

/// The structure of the truth, and its values, are closer than those of the best blur of one frame.
TEST_P(ReconstructScene, ComesCloserToTheTruthThanOneFrameCan) {
  const BlurCase scene = scene_blur_case(GetParam());
  const BlurScore ours = blur_scores(scene, kReconstruct, true).begin()->second;
  const BlurScore gather = blur_scores(scene, kGatherPlus, true).begin()->second;
  std::cout << scene.name << ": PSNR " << ours.psnr << " dB (gather-plus " << gather.psnr << "), SSIM " << ours.ssim
            << " (" << gather.ssim << "), where the frame shows nothing " << ours.psnr_uncovered << " dB ("
            << gather.psnr_uncovered << ")\n";
  EXPECT_GT(ours.psnr, gather.psnr);
  EXPECT_GT(ours.ssim, gather.ssim);
}
INSTANTIATE_TEST_SUITE_P(Scenes, ReconstructScene, testing::Values("crossing", "columns", "trail", "grass", "garden"));

}  // namespace
}  // namespace aftershade::tests
