// What the motion blurs cost beside each other: time per frame, measured in one run on the synthetic crossing scene.
// Every method takes its turn in each repetition; figures are medians. See README.md.
//   bench_blur_cost [--smoke] [--json FILE] [--size WIDTHxHEIGHT] [--repetitions N]
#include <cstdio>

#include "core/base/text.h"
#include "tests/bench/stage_cost.h"
#include "tests/pipeline/blur_quality.h"

namespace {

using namespace aftershade;

using tests::Frames;

constexpr int kFrame = 4;

/// One method, timed again and again on the same frame.
class Timed {
 public:
  Timed(std::string name, const preset::Preset& preset) : name_(std::move(name)), stages_(preset, tests::kFullOffer) {}
  const std::string& name() const { return name_; }
  const tests::TimedStages& stages() const { return stages_; }

  void run(const Frames& frames, bool counts) {
    const double ms = tests::milliseconds(stages_.run(frames, kFrame));
    if (counts) times_.push_back(ms);
  }
  double take_median() { return tests::median(std::exchange(times_, {})); }

 private:
  std::string name_;
  tests::TimedStages stages_;
  std::vector<double> times_;
};

std::vector<Timed> timed_methods() {
  std::vector<Timed> out;
  for (const tests::BlurMethod& method : tests::kBlurMethods) {
    if (!method.preset && !method.method) continue;
    out.emplace_back(method.name, tests::preset_of(method));
    if (method.has_clamp) out.emplace_back(cat(method.name, ", lifted"), tests::preset_of(method, tests::kLifted));
  }
  return out;
}

params::Json measure(std::vector<Timed>& methods, const Frames& frames, int repetitions) {
  for (int i = -1; i < repetitions; ++i)  // the first warms up
    for (Timed& method : methods) method.run(frames, i >= 0);
  params::Json rows = params::Json::array();
  double first = 0;
  for (Timed& method : methods) {
    const double ms = method.take_median();
    if (first == 0) first = ms;
    std::printf("  %-24s %9.1f ms  %7.3f\n", method.name().c_str(), ms, ms / first);
    rows.push_back({{"method", method.name()}, {"median_ms", ms}, {"ratio", ms / first}});
  }
  return {{"methods", rows}};
}

}  // namespace

int main(int argc, char** argv) {
  tests::CostOptions options;
  if (!tests::parse(argc, argv, options)) return 64;
  tests::SceneSource source(tests::find_scene("crossing"), {options.width, options.height, 1}, 1, 8);
  Frames frames;
  const auto load = [&](int f) {
    frames.emplace(f, *source.load(f, "", {Role::depth, Role::velocity_prev, Role::velocity_next}, true));
  };
  load(kFrame);
  const double longest_px = tests::longest_half_exposure_px(frames.at(kFrame));
  std::vector<Timed> methods = timed_methods();
  for (const Timed& method : methods)
    for (int f = kFrame - method.stages().frames_before(); f <= kFrame + method.stages().frames_after(); ++f)
      if (!frames.contains(f)) load(f);
  std::printf("crossing, %d x %d, longest half exposure %.1f px, medians of %d turns\n", options.width, options.height,
              longest_px, options.repetitions);
  tests::with_one_and_all_threads(options, [&] { return measure(methods, frames, options.repetitions); });
}
