#include "tests/bench/throughput/stages.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/io/file_source.h"
#include "core/simd/targets.h"
#include "tests/bench/stage_cost.h"

namespace aftershade::tests::throughput {

namespace {

const pipeline::Offer kOffer{{Role::depth, Role::normal, Role::velocity_prev}, true, true};

/// Only these stages of a shipped preset.
preset::Preset stages_of(const std::string& name, const std::vector<std::string>& ids) {
  preset::Preset preset = preset::load_preset(name).preset;
  std::erase_if(preset.stages, [&](const auto& stage) { return std::ranges::count(ids, stage.id) == 0; });
  return preset;
}

struct Timed {
  std::string name;
  TimedStages stages;
  std::vector<double> wall_ms, cpu_ms;

  void run(const Frames& frames, int number, bool counts) {
    const Elapsed time = stages.run(frames, number);
    if (!counts) return;
    wall_ms.push_back(time.wall_ms);
    cpu_ms.push_back(time.cpu_ms);
  }
};

std::vector<Timed> timed_stages() {
  std::vector<Timed> out;
  out.push_back({kBlurDx11, {stages_of("high-dx11", {"motion_blur"}), kOffer}, {}, {}});
  out.push_back({kBlurGatherPlus, {preset::from_json(gather_plus_preset(), "gather-plus.json"), kOffer}, {}, {}});
  out.push_back({kSliceAo, {stages_of("slices", {"ao", "blur"}), kOffer}, {}, {}});
  return out;
}

/// Frame `number` and those that the stages look at beside it.
Frames load_frames(const FrameSet& set, int number, const std::vector<Timed>& all) {
  io::SourceOptions options;
  options.sequence = io::find_sequence((set.folder / "in.####.exr").string(), io::HashDigits::one).sequence;
  options.profile = io::load_profile("generic");
  io::FileSource source(std::move(options));
  Frames frames;
  for (const Timed& timed : all)
    for (int f = number - timed.stages.frames_before(); f <= number + timed.stages.frames_after(); ++f)
      if (!frames.contains(f)) frames.emplace(f, source.load(f, "", kOffer.roles, true).value());
  return frames;
}

std::vector<std::string> measured_targets() {
  std::vector<std::string> out{lanes::targets().front()};
  if (out[0] != "avx2" && std::ranges::count(lanes::targets(), "avx2") > 0) out.emplace_back("avx2");
  return out;
}

}  // namespace

params::Json gather_plus_preset() {
  return {{"description", "gather-plus alone"},
          {"stages", {{{"id", "motion_blur"}, {"method", "gather-plus"}, {"shutter_frames", 0.5}}}}};
}

params::Json measure_stages(const FrameSet& set, int repetitions) {
  const int middle = (set.frames + 1) / 2;
  params::Json rows = params::Json::array();
  for (const std::string& target : measured_targets()) {
    lanes::force_target(target);
    std::vector<Timed> all = timed_stages();
    const Frames frames = load_frames(set, middle, all);
    for (int i = -1; i < repetitions; ++i)  // the first warms up
      for (Timed& timed : all) timed.run(frames, middle, i >= 0);
    for (const Timed& timed : all)
      rows.push_back({{"stage", timed.name},
                      {"target", target},
                      {"wall_ms", median(timed.wall_ms)},
                      {"cpu_ms", median(timed.cpu_ms)}});
  }
  return rows;
}

}  // namespace aftershade::tests::throughput
