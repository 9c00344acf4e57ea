// A contact sheet of every shipped AO system on one scene: raw, after each filter, finished, and the ray-traced truth.
//   bench_ao_sheet SCENE OUT.png [PRESET...]
// The middle one of 9 frames, 480x270; a row a preset.
#include <cstdio>

#include "core/preview/loader.h"
#include "tests/pipeline/ao_quality.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"
#include "tests/support/truth.h"

namespace {

using namespace aftershade;

constexpr int kWidth = 480, kHeight = 270, kFrame = 5;

/// The first `count` stages' AO at every pixel: where it is still at half resolution, each pixel shows its block's.
Plane ao_after(preset::Preset preset, size_t count, FrameSource& source) {
  preset.stages.resize(count);
  filter::BilateralUpsampleParams hard_edged;
  const auto run = [&](const preset::Preset& p) {
    auto sink = tests::run_over(p, source, tests::frames_from_to(1, 9), {"AO", false, {}});
    return std::move(sink.planes.at(kFrame).at("AO"));
  };
  try {
    return run(preset);
  } catch (const Error&) {  // not at every pixel yet
    preset.stages.push_back({"show", hard_edged});
    return run(preset);
  }
}

std::vector<preview::Cell> row_of(const std::string& name, FrameSource& source) {
  const preset::Preset preset = tests::ao_part(name);
  std::vector<preview::Cell> row;
  for (size_t count = 1; count <= preset.stages.size(); ++count) {
    preview::Cell cell;
    cell.planes.push_back(ao_after(preset, count, source));
    cell.label = name + ", " + std::string(preset::method_of(preset.stages[count - 1].params));
    row.push_back(std::move(cell));
  }
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_ao_sheet SCENE OUT.png [PRESET...]\n");
    return 64;
  }
  const std::string scene = argv[1];
  std::vector<std::string> presets(argv + 3, argv + argc);
  if (presets.empty())
    for (const std::string& name : preset::shipped_presets())
      if (tests::makes_ao(name)) presets.push_back(name);
  tests::SceneSource source(tests::find_scene(scene), {kWidth, kHeight, 1}, 1, 9);
  preview::Sheet sheet;
  sheet.title = scene + ": AO after each stage, and ray-traced";
  sheet.style.max_cell_width_px = kWidth;
  for (const std::string& name : presets) sheet.rows.push_back(row_of(name, source));
  preview::Cell truth;
  truth.planes.push_back(tests::ambient_occlusion_truth(tests::find_scene(scene), kFrame, kWidth, kHeight, {}));
  truth.label = "ray-traced";
  sheet.rows.emplace_back().push_back(std::move(truth));
  const std::string note = preview::write_sheet(std::move(sheet), argv[2]);
  if (!note.empty()) std::fprintf(stderr, "%s\n", note.c_str());
}
