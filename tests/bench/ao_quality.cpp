// Every shipped preset's AO against ray-traced truth: the public sequence (mean of 12 frames) and synthetic scenes (the
// middle one of 9 frames, 240x135). Prints a table; with a file's name also JSON.
//   bench_ao_quality [--json FILE] [PRESET...]
#include "tests/pipeline/ao_quality.h"

#include <cstdio>
#include <fstream>
#include <map>

#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"
#include "tests/support/truth_cache.h"

namespace {

using namespace aftershade;
using tests::AoScore;

constexpr const char* kScenes[] = {"corner", "columns", "grass", "garden", "crossing"};

AoScore scene_score(const std::string& name, const preset::Preset& preset) {
  constexpr int kWidth = 240, kHeight = 135, kFrame = 5;
  tests::SceneSource source(tests::find_scene(name), {kWidth, kHeight, 1}, 1, 9);
  const auto sink = tests::run_over(preset, source, tests::frames_from_to(1, 9), {"AO", false, {}});
  const Plane truth = tests::cached_ao_truth(name, kFrame, kWidth, kHeight, {});
  return tests::ao_score(sink.planes.at(kFrame).at("AO"), truth,
                         source.load(kFrame, "", {Role::depth}, false)->depth());
}

params::Json print(const std::string& preset, const std::string& input, const AoScore& s) {
  std::printf("%-30s %-9s %7.4f %+8.4f %7.4f %9.4f\n", preset.c_str(), input.c_str(), s.rmse, s.bias, s.correlation,
              s.rmse_smooth);
  std::fflush(stdout);
  return {{"preset", preset},
          {"input", input},
          {"rmse", s.rmse},
          {"bias", s.bias},
          {"correlation", s.correlation},
          {"rmse_away_from_edges", s.rmse_smooth}};
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> presets(argv + 1, argv + argc);
  std::string json_file;
  if (presets.size() >= 2 && presets[0] == "--json") {
    json_file = presets[1];
    presets.erase(presets.begin(), presets.begin() + 2);
  }
  if (presets.empty())
    for (const std::string& name : preset::shipped_presets())
      if (tests::makes_ao(name)) presets.push_back(name);
  std::printf("%-30s %-9s %7s %8s %7s %9s\n", "preset", "input", "RMSE", "bias", "corr.", "no edges");
  params::Json rows = params::Json::array();
  const bool yard = !tests::yard_folder().empty();
  if (!yard) std::printf("NOT MEASURED: the public sequence is not there (set AFTERSHADE_DATA)\n");
  for (const std::string& name : presets) {
    const preset::Preset preset = tests::ao_part(name);
    if (yard) rows.push_back(print(name, "yard", tests::yard_score(preset)));
    for (const char* scene : kScenes) rows.push_back(print(name, scene, scene_score(scene, preset)));
  }
  if (!json_file.empty()) std::ofstream(json_file) << rows.dump(2) << "\n";
}
