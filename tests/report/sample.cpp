#include "tests/report/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aftershade::tests {

using namespace report;

namespace {

/// A number in 0..1 that looks random and is the same everywhere.
double hashed(unsigned a, unsigned b, unsigned c) {
  unsigned h = a * 0x9E3779B1U ^ b * 0x85EBCA77U ^ c * 0xC2B2AE3DU;
  h = (h ^ h >> 15) * 0x2C1B3C6DU;
  h = (h ^ h >> 12) * 0x297A2D39U;
  return static_cast<double>(h ^ h >> 15) / 4294967295.0;
}

Picture picture_of(int frame, size_t index, Window part, int step) {
  Picture out{part.width() / step, part.height() / step, {}};
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const auto rgb = sample_pixel(frame, index, part.min_x + x * step, part.min_y + y * step);
      out.rgb.insert(out.rgb.end(), rgb.begin(), rgb.end());
    }
  return out;
}

metrics::Scores scores_of(size_t index, int frame, bool reference) {
  const double quality = hashed(static_cast<unsigned>(index), 1, 2);
  const double noise = 0.1 * hashed(static_cast<unsigned>(index), static_cast<unsigned>(frame), 3);
  metrics::Scores scores{{"flicker_stable", 0.001 + 0.004 * quality + 0.01 * noise}};
  if (!reference) return scores;
  scores["psnr"] = 24 + 12 * quality + 20 * noise;
  scores["ssim"] = 0.82 + 0.12 * quality + 0.3 * noise;
  scores["ldr_flip"] = 0.12 - 0.07 * quality - 0.2 * noise;
  scores["ao_bias"] = 0.05 * (quality - 0.5) + 0.1 * noise;
  scores["ao_correlation"] = std::numeric_limits<double>::quiet_NaN();
  return scores;
}

std::vector<StageCost> cost_of(const preset::Preset& preset, size_t index, int frame) {
  std::vector<StageCost> cost{{"read", 11 + hashed(1, static_cast<unsigned>(frame), 5)}};
  unsigned salt = 0;
  for (const preset::StageDescription& stage : preset.stages)
    cost.push_back({stage.id, 1 + std::exp(4 * hashed(static_cast<unsigned>(index), salt++, 7)) +
                                  hashed(static_cast<unsigned>(index), salt, static_cast<unsigned>(frame))});
  return cost;
}

Candidate candidate_of(const SampleOptions& options, const std::string& name, size_t index) {
  Candidate out;
  out.preset = preset::load_preset(name).preset;
  out.sequence = scores_of(index, 0, options.reference);
  for (int frame = 1; frame <= options.frames; ++frame) {
    FrameResult result{frame, scores_of(index, frame, options.reference), {}};
    if (options.cost) result.cost = cost_of(out.preset, index, frame);
    if (frame == 1) result.scores.erase("flicker_stable");  // there is no frame before it
    out.frames.push_back(std::move(result));
  }
  if (options.cost) out.cost = cost_of(out.preset, index, 0);
  if (options.cost) out.memory_bytes = 90'000'000 + static_cast<int64_t>(index) * 31'000'000;
  return out;
}

ShownFrame shown_of(const SampleOptions& options, int frame) {
  const int size = std::min({160, options.display.width() / 2, options.display.height() / 2});
  const int x = 60 + 5 * frame, y = 40 + 3 * frame;
  ShownFrame out{frame, 0.02 + 0.1 * hashed(static_cast<unsigned>(frame), 0, 9), options.display, {}, {}};
  if (options.detail)
    out.region = {options.display.min_x + x, options.display.min_y + y, options.display.min_x + x + size - 1,
                  options.display.min_y + y + size - 1};
  const size_t count = options.presets.size() + (options.reference ? 2 : 1);
  const Window all{0, 0, options.display.width() - 1, options.display.height() - 1};
  for (size_t index = 0; index < count; ++index) {
    out.whole.push_back(picture_of(frame, index, all, options.detail ? 2 : 1));
    if (options.detail) out.detail.push_back(picture_of(frame, index, {x, y, x + size - 1, y + size - 1}, 1));
  }
  return out;
}

}  // namespace

std::array<unsigned char, 3> sample_pixel(int frame, size_t index, int x, int y) {
  // A ball before a wall with stripes; the index darkens around the ball and adds some grain.
  const double dx = x - 300 - 12.0 * frame, dy = y - 170, distance = std::sqrt(dx * dx + dy * dy);
  const double wall = 150 + 40 * std::sin(x * 0.05) + 0.1 * y, ball = 210 - 0.8 * distance + 20 * std::sin(y * 0.3);
  double value = distance < 90 ? ball : wall;
  const double near = std::max(0.0, 1 - std::abs(distance - 90) / 60);
  value -= near * (20 + 6 * static_cast<double>(index % 9));
  value += 6 * hashed(static_cast<unsigned>(x), static_cast<unsigned>(y), static_cast<unsigned>(frame + 31)) +
           1.2 * hashed(static_cast<unsigned>(x), static_cast<unsigned>(y), static_cast<unsigned>(index));
  const auto code = [](double v) { return static_cast<unsigned char>(std::clamp(v, 0.0, 255.0)); };
  return {code(value), code(value * (distance < 90 ? 0.72 : 0.96)), code(value * (distance < 90 ? 0.5 : 1.02))};
}

Comparison sample_comparison(const SampleOptions& options) {
  Comparison out;
  out.program = "aftershade 0.0.0-sample";
  out.input = "/shots/yard/yard.####.exr";
  if (options.reference) out.reference = "/shots/yard/truth.####.exr";
  out.view_transform = "sRGB";
  out.threads = 2;
  out.display = options.display;
  for (int frame = 1; frame <= options.frames; ++frame) out.frames.push_back(frame);
  if (options.reference)
    out.metrics = {"psnr", "ssim", "ldr_flip", "flicker_stable", "ao_bias", "ao_correlation"};
  else
    out.metrics = {"flicker_stable"};
  for (size_t i = 0; i < options.presets.size(); ++i)
    out.candidates.push_back(candidate_of(options, options.presets[i], i));
  for (int frame = 1; frame <= std::min(options.shown, options.frames); ++frame)
    out.shown.push_back(shown_of(options, 2 * frame));
  return out;
}

}  // namespace aftershade::tests
