// Scores beside those of other people's programs, on the same pixels: OpenImageIO's idiff, and scikit-image.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/text.h"
#include "core/io/exr_writer.h"
#include "core/math/sampling.h"
#include "core/metrics/image_metrics.h"
#include "core/metrics/sequence_scores.h"

namespace aftershade::metrics {
namespace {

namespace fs = std::filesystem;
constexpr int kWidth = 97, kHeight = 61;

/// A folder of this process, since tests run side by side, that goes with the object.
struct Scratch {
  const fs::path folder = fs::path(testing::TempDir()) / ("independent-scores-" + std::to_string(getpid()));
  Scratch() { fs::create_directories(folder); }
  ~Scratch() { fs::remove_all(folder); }
};

/// What a command prints; "" when it fails to start or ends with a status above `most`.
std::string output_of(const std::string& command, int most) {
  std::string text;
  FILE* pipe = popen((command + " 2>/dev/null").c_str(), "r");
  if (!pipe) return "";
  char buffer[512];
  for (size_t n; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  const int status = pclose(pipe);
  return WIFEXITED(status) && WEXITSTATUS(status) <= most ? text : "";
}

bool runs(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

/// Disks, a ramp and noise, in 0..1; 1 at one pixel, which idiff takes for the peak.
Plane picture(uint32_t seed, float noise) {
  Plane out(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool disk = (x / 12 + y / 12) % 2 == 0;
      const float random = unit_float(hash_counters(static_cast<uint32_t>(x), static_cast<uint32_t>(y), seed));
      const float base = 0.1F + 0.5F * static_cast<float>(x) / kWidth + (disk ? 0.2F : 0.0F);
      out(x, y) = std::min(base + noise * (random - 0.5F), 0.999F);
    }
  out(3, 3) = 1;
  return out;
}

struct Pair {
  std::array<Plane, 3> a, b;
  explicit Pair(float noise) {
    for (uint32_t c = 0; c < 3; ++c) {
      a[c] = picture(c, 0.05F);
      b[c] = picture(c + 10, noise);
    }
  }
  static Rgb rgb(const std::array<Plane, 3>& planes) { return {planes[0], planes[1], planes[2]}; }
};

void write_rgb(const std::array<Plane, 3>& planes, const fs::path& path) {
  io::NewFile file;
  file.display_window = file.data_window = {0, 0, kWidth - 1, kHeight - 1};
  const char* names[] = {"R", "G", "B"};
  for (size_t c = 0; c < 3; ++c) file.channels.push_back({names[c], io::PixelType::single, planes[c]});
  io::write_new_exr(file, path.string());
}

/// The number after "Mean error = " and the like.
double number_after(const std::string& text, const std::string& label) {
  const size_t at = text.find(label);
  return at == std::string::npos ? NAN : std::stod(text.substr(at + label.size()));
}

TEST(IndependentScores, AreThoseOfIdiffToFiveDigits) {
  if (!runs("idiff --help")) GTEST_SKIP() << "idiff is not installed (Debian: openimageio-tools)";
  const Scratch scratch;
  const fs::path a = scratch.folder / "a.exr", b = scratch.folder / "b.exr";
  for (const float noise : {0.1F, 0.6F}) {
    const Pair pair(noise);
    write_rgb(pair.a, a);
    write_rgb(pair.b, b);
    const std::string text = output_of("idiff '" + a.string() + "' '" + b.string() + "'", 4);
    ASSERT_NE(text.find("RMS error = "), std::string::npos) << text;
    SequenceScorer scorer({"rmse", "mae", "psnr_linear"});
    ScoredFrame frame;
    frame.color = Pair::rgb(pair.a);
    frame.true_color = Pair::rgb(pair.b);
    const Scores scores = scorer.add(frame);
    EXPECT_NEAR(scores.at("mae"), number_after(text, "Mean error = "), 1e-5 * scores.at("mae")) << text;
    EXPECT_NEAR(scores.at("rmse"), number_after(text, "RMS error = "), 1e-5 * scores.at("rmse")) << text;
    EXPECT_NEAR(scores.at("psnr_linear"), number_after(text, "Peak SNR = "), 1e-4) << text;
  }
}

void write_raw(const Plane& plane, const fs::path& path) {
  std::ofstream file(path, std::ios::binary);
  for (int y = 0; y < plane.height(); ++y)
    file.write(reinterpret_cast<const char*>(plane.row(y)), plane.width() * static_cast<int>(sizeof(float)));
}

TEST(IndependentScores, AreThatOfScikitImage) {
  const std::string python = "/usr/bin/python3";
  if (!runs(python + " -c 'import skimage.metrics'"))
    GTEST_SKIP() << "scikit-image is not installed (Debian: python3-skimage)";
  std::string command =
      cat(python, " '" AFTERSHADE_SOURCE_DIR "/tests/metrics/skimage_ssim.py' ", kWidth, " ", kHeight);
  const Scratch scratch;
  std::vector<double> ours;
  const auto add = [&](const Plane& left, const Plane& right) {
    for (const auto& [plane, side] : {std::pair(&left, "a"), std::pair(&right, "b")}) {
      const fs::path path = scratch.folder / cat(side, ours.size(), ".raw");
      write_raw(*plane, path);
      command += cat(" '", path.string(), "'");
    }
    ours.push_back(ssim(left, right));
  };
  for (const float noise : {0.05F, 0.2F, 0.9F}) {
    const Pair pair(noise);
    add(pair.a[0], pair.b[0]);
    const Displayed shown = displayed(Pair::rgb(pair.a), Pair::rgb(pair.b));
    add(shown.luma_a, shown.luma_b);
  }
  const std::vector<std::string> lines = split(output_of(command, 0), '\n');
  ASSERT_EQ(lines.size(), ours.size() + 1);
  for (size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(ours[i], std::stod(lines[i]), 1e-9) << "pair " << i;
  EXPECT_GT(ours[0], ours[4] + 0.2) << "the pairs differ";
}

}  // namespace
}  // namespace aftershade::metrics
