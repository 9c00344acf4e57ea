// What the AO systems cost beside each other: the seeds' ratios, measured in one run on the synthetic grass scene.
// Every chain takes its turn in each repetition; figures are medians. See README.md.
//   bench_ao_cost [--smoke] [--json FILE] [--size WIDTHxHEIGHT] [--repetitions N]
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

#include "core/pipeline/stage.h"
#include "core/preset/preset.h"
#include "tests/bench/timing.h"
#include "tests/support/scene_source.h"
#include "tests/support/scenes.h"

namespace {

using namespace aftershade;

/// Times of everything measured, by name.
class Times {
 public:
  void add(const std::string& name, double ms) { times_[name].push_back(ms); }
  double median(const std::string& name) const { return tests::median(times_.at(name)); }
  std::map<std::string, double> medians() const {
    std::map<std::string, double> out;
    for (const auto& entry : times_) out[entry.first] = median(entry.first);
    return out;
  }

 private:
  std::map<std::string, std::vector<double>> times_;
};

/// Stages of a preset up to its AO at every pixel, run in turn on two neighbouring frames; stage "x" of chain "c" is
/// timed as "c/x".
class Chain {
 public:
  Chain(std::string name, const preset::Preset& preset) : name_(std::move(name)) {
    for (const auto& stage : preset.stages)
      if (preset::method_of(stage.params) != ao::ApplyAoParams::method)
        stages_.emplace_back(stage.id, pipeline::make_stage(stage.params));
  }
  void run(Frame& frame, Times* times) {
    const pipeline::WorkOptions options;
    pipeline::Work work(frame, nullptr, options);
    double total = 0;
    for (const auto& stage : stages_) {
      const double ms = tests::milliseconds([&] { stage.second->run(work); });
      if (times) times->add(name_ + "/" + stage.first, ms);
      total += ms;
    }
    if (times) times->add(name_, total);
  }

 private:
  std::string name_;
  std::vector<std::pair<std::string, std::unique_ptr<pipeline::Stage>>> stages_;
};

preset::Preset preset_with(const std::string& name, const std::vector<std::string>& sets) {
  return preset::load_preset(name, sets).preset;
}

/// The same AO under a single bilateral blur of 17 x 17 pixels (two passes) at full resolution.
preset::Preset with_wide_blur(const std::string& name, const std::string& resolution) {
  preset::Preset preset = preset_with(name, {"ao.resolution=" + resolution});
  std::erase_if(preset.stages, [](const auto& stage) { return stage.id == "blur"; });
  filter::BilateralBlurParams wide;
  wide.radius_px = 8;
  preset.stages.insert(preset.stages.begin() + 2, {"blur", wide});  // after ao and upsample
  return preset;
}

std::vector<Chain> chains(int height) {
  // the slides' 8 pixels at the size measured
  const std::string radius = "blur.reference_height_px=" + std::to_string(height);
  std::vector<Chain> out;
  out.emplace_back("battlefield3-high", preset_with("battlefield3-high", {}));
  out.emplace_back("adaptive", preset_with("battlefield3-high", {radius}));
  out.emplace_back("brute-force", preset_with("battlefield3-high", {radius, "blur.sampling=brute-force"}));
  out.emplace_back("soma", preset_with("soma", {}));
  out.emplace_back("soma-ao-17x17", with_wide_blur("soma", "half"));
  out.emplace_back("soma-full-ao-17x17", with_wide_blur("soma", "full"));
  return out;
}

/// BlurX alone, at radius 8.
void measure_blur_pass(const Frame& frame, Times* times) {
  const Plane ao(frame.window.width(), frame.window.height(), 0.5F);
  const auto pass = [&](const char* name, filter::KernelSampling sampling) {
    filter::CrossBilateralBlurParams params;
    params.reference_height_px = static_cast<float>(frame.display.height());
    params.sampling = sampling;
    const double ms = tests::milliseconds(
        [&] { filter::cross_bilateral_blur_x(params, ao, {}, frame.depth(), frame.display.height()); });
    if (times) times->add(name, ms);
  };
  pass("blur-x/adaptive", filter::KernelSampling::adaptive);
  pass("blur-x/brute-force", filter::KernelSampling::brute_force);
}

Times measure(std::vector<Frame>& frames, int repetitions) {
  Times times;
  std::vector<Chain> all = chains(frames[0].display.height());
  for (int i = -1; i < repetitions; ++i)  // the first fills the histories
    for (Frame& frame : frames) {
      for (Chain& chain : all) chain.run(frame, i < 0 ? nullptr : &times);
      measure_blur_pass(frame, i < 0 ? nullptr : &times);
    }
  return times;
}

struct Row {
  const char *name, *goal;
  double value;
};

std::vector<Row> rows_of(const Times& t) {
  const auto ms = [&](const char* name) { return t.median(name); };
  const double filter = ms("battlefield3-high/temporal");
  const double chain = ms("adaptive/blur") + ms("adaptive/temporal"),
               brute = ms("brute-force/blur") + ms("brute-force/temporal");
  return {{"STF / (raw AO + BlurX + BlurY), battlefield3-high", "<= 0.16",
           filter / (ms("battlefield3-high/ao") + ms("battlefield3-high/blur"))},
          {"BlurX brute force / adaptive, R 8 (17 : 13 fetches, 16 : 12 weights)", ">= 1.2",
           ms("blur-x/brute-force") / ms("blur-x/adaptive")},
          {"both passes, brute force / adaptive, R 8", "", ms("brute-force/blur") / ms("adaptive/blur")},
          {"whole blur chain with STF, brute force / adaptive", "1.13 in the slides", brute / chain},
          {"SOMA's AO under a 17x17 blur at full resolution / SOMA", ">= 2", ms("soma-ao-17x17") / ms("soma")},
          {"the same with the AO at full resolution too / SOMA", "", ms("soma-full-ao-17x17") / ms("soma")}};
}

params::Json report(const Times& times) {
  for (const auto& [name, value] : times.medians()) std::printf("  %-32s %9.2f ms\n", name.c_str(), value);
  params::Json ratios = params::Json::array();
  for (const Row& row : rows_of(times)) {
    std::printf("  %-72s %6.3f  %s\n", row.name, row.value, row.goal);
    ratios.push_back({{"name", row.name}, {"value", row.value}, {"goal", row.goal}});
  }
  return {{"median_ms", times.medians()}, {"ratios", ratios}};
}

}  // namespace

int main(int argc, char** argv) {
  tests::CostOptions options;
  if (!tests::parse(argc, argv, options)) return 64;
  std::vector<Frame> frames;
  tests::SceneSource source(tests::find_scene("grass"), {options.width, options.height, 1}, 4, 5);
  for (const int number : {4, 5}) frames.push_back(*source.load(number, "", {Role::depth, Role::normal}, false));
  std::printf("grass, %d x %d, medians of %d turns\n", options.width, options.height, 2 * options.repetitions);
  tests::with_one_and_all_threads(options, [&] { return report(measure(frames, options.repetitions)); });
}
