// What every temporal filter of the seeds does to flicker, and what it leaves behind a moving object: the slides' story
// in figures. Scenes grass, columns and trail at 240x135; frames 6 to 12 of -3 to 20 are judged.
//   bench_temporal_story [--json FILE] [SCENE...]
#include "tests/pipeline/temporal_story.h"

#include <cstdio>
#include <fstream>

namespace {

using namespace aftershade;

params::Json json_of(const metrics::Distribution& d) {
  return {{"mean", d.mean}, {"p95", d.p95}, {"p99", d.p99}, {"pixels", d.count}};
}
params::Json json_of(const tests::TrailScore& t) {
  return {{"mean", t.all.mean},
          {"absolute", t.all.absolute},
          {"share_above_0.03", t.all.visible},
          {"half_life_frames", t.half_life_frames},
          {"pixels", t.all.count}};
}

void print_trail(const std::optional<tests::TrailScore>& t) {
  if (t)
    std::printf("  %+8.5f %7.5f %5.1f%% %5.2f", t->all.mean, t->all.absolute, 100 * t->all.visible,
                t->half_life_frames);
}

params::Json print(const std::string& scene, const std::string& system, const tests::StoryScore& s) {
  std::printf("%-8s %-20s %7.4f %7.4f %7.4f  %7.4f %7.4f %7.4f", scene.c_str(), system.c_str(), s.unstable.mean,
              s.unstable.p95, s.unstable.p99, s.stable.mean, s.stable.p95, s.stable.p99);
  for (const auto& trail : {s.trail, s.stable_trail, s.ghost, s.lag}) print_trail(trail);
  std::printf("\n");
  std::fflush(stdout);
  params::Json row{
      {"scene", scene}, {"system", system}, {"unstable", json_of(s.unstable)}, {"stable", json_of(s.stable)}};
  if (s.trail) row["trail"] = json_of(*s.trail);
  if (s.stable_trail) row["trail_on_stable"] = json_of(*s.stable_trail);
  if (s.ghost) row["ghost"] = json_of(*s.ghost);
  if (s.lag) row["lag"] = json_of(*s.lag);
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> scenes(argv + 1, argv + argc);
  std::string json_file;
  if (scenes.size() >= 2 && scenes[0] == "--json") {
    json_file = scenes[1];
    scenes.erase(scenes.begin(), scenes.begin() + 2);
  }
  if (scenes.empty()) scenes = {"trail", "columns", "grass"};
  std::printf(
      "flicker above the truth's own change, on unstable and on stable pixels: mean, p95, p99; then, where something "
      "moves,\nwhat it leaves in its footprint, there on stable pixels, where it was itself, and where it arrives: "
      "mean and absolute error, share above 0.03, half-life in frames\n");
  params::Json rows = params::Json::array();
  for (const std::string& scene : scenes) {
    tests::Story story(scene, {});
    rows.push_back(print(scene, "(constant)", story.score_of_nothing()));
    rows.push_back(print(scene, "(truth)", story.score_of_truth()));
    for (const tests::StorySystem& system : tests::story_systems())
      rows.push_back(print(scene, system.name, story.score(system.preset)));
  }
  if (!json_file.empty()) std::ofstream(json_file) << rows.dump(2) << "\n";
}
