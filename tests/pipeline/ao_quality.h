#pragma once
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "core/io/file_source.h"
#include "core/metrics/image_metrics.h"
#include "core/pipeline/pipeline.h"
#include "tests/pipeline/memory_sequence.h"

/// A preset's AO against ray-traced truth: what the tests bound and the benchmark prints.
namespace aftershade::tests {

inline const pipeline::Offer kFullOffer{
    {Role::depth, Role::normal, Role::velocity_prev, Role::velocity_next}, true, true};

inline bool makes_ao(const std::string& preset) {
  const auto stages = preset::load_preset(preset).preset.stages;
  return std::any_of(stages.begin(), stages.end(),
                     [](const auto& stage) { return preset::method_of(stage.params) == ao::ApplyAoParams::method; });
}

/// The stages of a preset that make AO: up to the one that applies it.
inline preset::Preset ao_part(const std::string& name, const std::vector<std::string>& sets = {}) {
  preset::Preset preset = preset::load_preset(name, sets).preset;
  const auto apply = std::find_if(preset.stages.begin(), preset.stages.end(), [](const auto& stage) {
    return preset::method_of(stage.params) == ao::ApplyAoParams::method;
  });
  preset.stages.erase(apply, preset.stages.end());
  return preset;
}

/// Runs a preset over frames of a source that offers everything, with the AO as channel "AO".
inline MemorySink run_over(const preset::Preset& preset, FrameSource& source, std::vector<int> frames,
                           const pipeline::Outputs& outputs = {"AO", true, {}}) {
  std::vector<pipeline::ViewPipeline> views;
  views.emplace_back(preset, "", kFullOffer, outputs);
  MemorySink sink;
  pipeline::RunOptions options;
  options.written = options.on_disk = std::move(frames);
  pipeline::run(views, source, sink, options);
  return sink;
}

inline std::vector<int> frames_from_to(int first, int last) {
  std::vector<int> frames(static_cast<size_t>(last - first + 1));
  std::iota(frames.begin(), frames.end(), first);
  return frames;
}

/// 1 on surfaces; `away_from_edges` also demands that depth stays within 10 % in the 5x5 pixels around.
inline Plane surface_mask(ConstPlaneView depth, bool away_from_edges) {
  Plane mask(depth.width, depth.height);
  const int reach = away_from_edges ? 2 : 0;
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      float low = depth(x, y), high = low;
      for (int j = std::max(y - reach, 0); j <= std::min(y + reach, depth.height - 1); ++j)
        for (int i = std::max(x - reach, 0); i <= std::min(x + reach, depth.width - 1); ++i)
          low = std::min(low, depth(i, j)), high = std::max(high, depth(i, j));
      mask(x, y) = std::isfinite(depth(x, y)) && (high - low < 0.1F * low || !away_from_edges) ? 1.0F : 0.0F;
    }
  return mask;
}

struct AoScore {
  double rmse = 0, bias = 0, correlation = 0, rmse_smooth = 0;  ///< the last away from depth edges
};
inline AoScore ao_score(ConstPlaneView ao, ConstPlaneView truth, ConstPlaneView depth) {
  const Plane all = surface_mask(depth, false), smooth = surface_mask(depth, true);
  return {metrics::rmse(ao, truth, all), metrics::mean_error(ao, truth, all), metrics::correlation(ao, truth, all),
          metrics::rmse(ao, truth, smooth)};
}
inline AoScore mean_of(const std::vector<AoScore>& scores) {
  AoScore mean;
  const auto n = static_cast<double>(scores.size());
  for (const AoScore& s : scores) {
    mean.rmse += s.rmse / n;
    mean.bias += s.bias / n;
    mean.correlation += s.correlation / n;
    mean.rmse_smooth += s.rmse_smooth / n;
  }
  return mean;
}

/// The public sequence rendered with Blender, beside it its truth; empty when it is not there.
inline std::filesystem::path yard_folder() {
  const char* data = std::getenv("AFTERSHADE_DATA");
  const auto folder = std::filesystem::path(data ? data : AFTERSHADE_SOURCE_DIR "/../shared/data") / "yard";
  return std::filesystem::exists(folder) ? folder : std::filesystem::path();
}
inline constexpr int kYardFrames = 12;

inline io::FileSource open_yard(const std::string& name) {
  io::SourceOptions options;
  options.sequence = io::find_sequence((yard_folder() / (name + ".####.exr")).string(), io::HashDigits::one).sequence;
  options.profile = io::load_profile(name == "yard" ? "blender" : "generic");
  return io::FileSource(std::move(options));
}

/// Mean over the yard's frames.
inline AoScore yard_score(const preset::Preset& preset) {
  io::FileSource source = open_yard("yard"), truth = open_yard("yard_ao");
  const MemorySink sink = run_over(preset, source, frames_from_to(1, kYardFrames), {"AO", false, {}});
  std::vector<AoScore> scores;
  for (int frame = 1; frame <= kYardFrames; ++frame) {
    const Frame target = *truth.load(frame, "", {Role::ao}, false);
    const Frame input = *source.load(frame, "", {Role::depth}, false);
    scores.push_back(ao_score(sink.planes.at(frame).at("AO"), target.planes(Role::ao)[0], input.depth()));
  }
  return mean_of(scores);
}

}  // namespace aftershade::tests
