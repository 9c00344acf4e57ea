// Motion blurs against accumulated truth: bounds a little below what bench_blur_quality measures, and Blender's
// figures.
#include "tests/pipeline/blur_quality.h"

#include <gtest/gtest.h>

#include <iostream>
#include <numeric>

namespace aftershade::tests {
namespace {

/// Blender 3.4.1's Vector Blur node on the yard's frames 1 to 12, dB: 64 samples, factor 1.0, its best
/// (tests/bench/blender_vector_blur.py).
constexpr double kBlender_db[kYardFrames] = {33.94, 33.83, 33.76, 33.74, 34.11, 34.18,
                                             34.06, 33.86, 33.97, 34.13, 34.06, 34.29};

struct Bound {
  const char* method;
  double mean_db;           ///< at least, over the 12 frames
  double above_blender_db;  ///< at least, on every frame
  double uncovered_db;      ///< at least, the mean inside the disocclusion mask
  double light;             ///< greatest relative error of a frame's mean radiance
};
void PrintTo(const Bound& bound, std::ostream* out) { *out << bound.method; }
/// The methods with their radius lifted; a line adds one.
constexpr Bound kBounds[] = {
    {.method = "vv-dx11", .mean_db = 35.2, .above_blender_db = 0.5, .uncovered_db = 26.9, .light = 2e-3},
    {.method = "mcguire2012", .mean_db = 35.4, .above_blender_db = 0.5, .uncovered_db = 27.0, .light = 2e-3},
    {.method = "guertin2014", .mean_db = 35.3, .above_blender_db = 0.5, .uncovered_db = 27.2, .light = 2e-3},
};

const BlurMethod& find_method(const std::string& name) {
  for (const BlurMethod& method : kBlurMethods)
    if (name == method.name) return method;
  throw std::logic_error("no method " + name);
}

class YardBlur : public testing::TestWithParam<Bound> {
 protected:
  static void SetUpTestSuite() {
    if (!yard_folder().empty()) yard_ = std::make_unique<BlurCase>(yard_blur_case(frames_from_to(1, kYardFrames)));
  }
  static void TearDownTestSuite() { yard_.reset(); }
  void SetUp() override {
    if (!yard_) GTEST_SKIP() << "NOT TESTED: no public data (set AFTERSHADE_DATA)";
  }
  static std::unique_ptr<BlurCase> yard_;
};
std::unique_ptr<BlurCase> YardBlur::yard_;

TEST_P(YardBlur, ComesCloserToTheTruthThanBlenderOnEveryFrame) {
  const Bound& bound = GetParam();
  double mean_db = 0, uncovered_db = 0, uncovered_before_db = 0;
  const preset::Preset preset = preset_of(find_method(bound.method), kLifted);
  for (const auto& [number, image] : blurred(*yard_, preset)) {
    const BlurTruth& frame = yard_->frames.at(number);
    const metrics::Rgb truth = rgb_of(frame.truth);
    const double db = metrics::display_psnr(rgb_of(image), truth);
    EXPECT_GT(db, kBlender_db[number - 1] + bound.above_blender_db) << "frame " << number;
    mean_db += db / kYardFrames;
    uncovered_db += metrics::display_psnr(rgb_of(image), truth, frame.uncovered) / kYardFrames;
    uncovered_before_db += metrics::display_psnr(rgb_of(frame.sharp), truth, frame.uncovered) / kYardFrames;
    EXPECT_NEAR(sum_of(rgb_of(image)) / sum_of(truth), 1, bound.light) << "mean radiance, frame " << number;
  }
  std::cout << bound.method << ": PSNR " << mean_db << " dB, where the frame shows nothing " << uncovered_db
            << " dB (unblurred " << uncovered_before_db << " dB)\n";
  EXPECT_GT(mean_db, bound.mean_db);
  EXPECT_GT(uncovered_db, bound.uncovered_db);
}
std::string test_name(const testing::TestParamInfo<Bound>& bound) {
  std::string name = bound.param.method;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Methods, YardBlur, testing::ValuesIn(kBounds), test_name);

}  // namespace
}  // namespace aftershade::tests
