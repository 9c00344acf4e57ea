// What the motion blurs cost beside each other: time per frame, measured in one run on the synthetic crossing scene.
// Every method takes its turn in each repetition; figures are medians. See README.md.
//   bench_blur_cost [--smoke] [--json FILE] [--size WIDTHxHEIGHT] [--repetitions N]
#include <cstdio>

#include "core/base/text.h"
#include "tests/bench/timing.h"
#include "tests/pipeline/blur_quality.h"

namespace {

using namespace aftershade;

constexpr int kFrame = 4;

/// What a blur reads and changes.
Frame copy_of_frame(const Frame& frame) {
  Frame copy;
  copy.number = frame.number;
  copy.window = frame.window, copy.display = frame.display, copy.camera = frame.camera;
  for (size_t role = 0; role < frame.roles.size(); ++role)
    for (const Plane& plane : frame.roles[role]) copy.roles[role].push_back(copy_of(plane));
  for (const Layer& layer : frame.layers) {
    Layer& target = copy.layers.emplace_back();
    target.channels = layer.channels, target.alpha = layer.alpha, target.data_window = layer.data_window;
    target.is_beauty = layer.is_beauty, target.receives_blur = layer.receives_blur;
    for (const Plane& plane : layer.planes) target.planes.push_back(copy_of(plane));
  }
  return copy;
}

using Frames = std::map<int, Frame>;

/// One method, timed again and again on the same frame.
class Timed {
 public:
  Timed(std::string name, const preset::Preset& preset)
      : name_(std::move(name)),
        stage_(pipeline::make_stage(preset.stages.at(0).params)),
        needs_(stage_->needs(tests::kFullOffer)) {}
  const std::string& name() const { return name_; }
  const pipeline::Needs& needs() const { return needs_; }

  /// A frame in the middle of a sequence: one frame seen, one blurred.
  void run(const Frames& frames, bool counts) {
    const pipeline::WorkOptions options;
    stage_->restart();
    double seen = 0;
    for (int f = kFrame - needs_.frames_before; needs_.has_window() && f <= kFrame + needs_.frames_after; ++f) {
      Frame frame = copy_of_frame(frames.at(f));
      const pipeline::Work work(frame, nullptr, options);
      seen = tests::milliseconds([&] { stage_->observe(work); });
    }
    Frame frame = copy_of_frame(frames.at(kFrame));
    pipeline::Work work(frame, nullptr, options);
    const double blurred = tests::milliseconds([&] { stage_->run(work); });
    if (counts) times_.push_back(seen + blurred);
  }
  double take_median() { return tests::median(std::exchange(times_, {})); }

 private:
  std::string name_;
  std::unique_ptr<pipeline::Stage> stage_;
  pipeline::Needs needs_;
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
    for (int f = kFrame - method.needs().frames_before; f <= kFrame + method.needs().frames_after; ++f)
      if (!frames.contains(f)) load(f);
  std::printf("crossing, %d x %d, longest half exposure %.1f px, medians of %d turns\n", options.width, options.height,
              longest_px, options.repetitions);
  tests::with_one_and_all_threads(options, [&] { return measure(methods, frames, options.repetitions); });
}
