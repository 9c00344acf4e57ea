#include "core/tune/trial.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/placed.h"

namespace aftershade::tune {

namespace {

constexpr const char* kAoChannel = "AO";

Compared compared(const Frame& frame) {
  Compared out;
  const auto shown = [&](const Plane& plane, float background) {
    return frame.window == frame.display ? plane.shared() : placed(plane, frame.window, frame.display, background);
  };
  const auto ao = frame.added.find(kAoChannel);
  if (ao != frame.added.end()) out.ao = shown(ao->second, 1);
  const auto beauty = std::ranges::find_if(frame.layers, [](const Layer& layer) { return layer.is_beauty; });
  if (beauty != frame.layers.end() && beauty->planes.size() >= 3)
    for (size_t i = 0; i < 3; ++i) out.color.push_back(shown(beauty->planes[i], 0));
  return out;
}

/// Hands finished frames on.
class Sink final : public FrameSink {
 public:
  explicit Sink(std::function<void(const Frame&)> use) : use_(std::move(use)) {}
  void write(int, const std::vector<Frame>& views) override { use_(views.front()); }

 private:
  std::function<void(const Frame&)> use_;
};

metrics::Rgb rgb(const std::vector<Plane>& planes) {
  if (planes.size() < 3) return {};
  return {planes[0], planes[1], planes[2]};
}

pipeline::Outputs outputs_for(const metrics::MetricInfo& metric) {
  pipeline::Outputs outputs;
  if (metric.of_ao) outputs.ao_channel = kAoChannel;
  outputs.layers = !metric.of_ao;
  return outputs;
}

}  // namespace

const metrics::MetricInfo& metric_named(const std::string& name) {
  std::vector<std::string> names;
  for (const metrics::MetricInfo& info : metrics::metric_infos()) {
    if (info.name == name) return info;
    names.emplace_back(info.name);
  }
  const std::string hint = did_you_mean(name, names);
  throw Error(ErrorCode::usage, cat("there is no metric \"", name, "\""),
              hint.empty() ? "metrics: " + join(names, ", ") : hint);
}

Wanted wanted_by(const preset::Preset& preset, const TrialSetup& setup) {
  const pipeline::ViewPipeline view(preset, setup.view, setup.offer, outputs_for(setup.metric));
  Wanted wanted{view.roles(view.stages()), view.layers(view.stages())};
  wanted.roles.insert(view.previous_roles());
  return wanted;
}

Results Trial::results(const preset::Preset& preset, const std::vector<int>& frames) const {
  std::vector<pipeline::ViewPipeline> views;
  views.emplace_back(preset, setup_.view, setup_.offer, outputs_for(setup_.metric));
  Results out;
  Sink sink([&](const Frame& frame) { out.emplace(frame.number, compared(frame)); });
  pipeline::RunOptions run;
  run.written = frames;
  run.on_disk = setup_.on_disk;
  run.preroll = setup_.preroll;
  run.frames_in_flight = 1;
  run.should_stop = setup_.should_stop;
  pipeline::run(views, source_, sink, run);
  return out;
}

double Trial::score(const preset::Preset& preset, const Targets& targets) const {
  std::vector<int> frames;
  for (const auto& [number, target] : targets) frames.push_back(number);
  const Results results = this->results(preset, frames);
  const std::string name(setup_.metric.name);
  metrics::SequenceScorer scorer({name});
  for (const auto& [number, target] : targets) {
    const auto result = results.find(number);
    if (result == results.end()) return std::numeric_limits<double>::quiet_NaN();
    metrics::ScoredFrame scored;
    scored.number = number;
    scored.color = rgb(result->second.color), scored.true_color = rgb(target.truth.color);
    scored.ao = result->second.ao, scored.true_ao = target.truth.ao;
    scored.depth = target.depth, scored.velocity_x = target.velocity_x, scored.velocity_y = target.velocity_y;
    scored.mask = target.mask;
    scored.camera = target.camera;
    scored.origin_x = target.origin_x, scored.origin_y = target.origin_y;
    scorer.add(scored);
  }
  const metrics::Scores scores = scorer.sequence();
  const auto score = scores.find(name);
  return score == scores.end() ? std::numeric_limits<double>::quiet_NaN() : score->second;
}

Cost Trial::cost(const preset::Preset& preset, const std::string& stage, int frame) const {
  preset::Preset so_far = preset;
  const auto is_it = [&](const preset::StageDescription& description) { return description.id == stage; };
  so_far.stages.erase(std::next(std::ranges::find_if(so_far.stages, is_it)), so_far.stages.end());
  std::vector<pipeline::ViewPipeline> views;
  pipeline::Outputs outputs = outputs_for(setup_.metric);
  outputs.ao_channel.reset();  // AO may not be at full resolution yet
  views.emplace_back(so_far, setup_.view, setup_.offer, outputs);
  Sink sink([](const Frame&) {});
  pipeline::RunOptions run;
  run.written = {frame};
  run.on_disk = setup_.on_disk;
  run.preroll = 1;
  run.measure = true;
  Cost cost;
  run.on_progress = [&](const pipeline::Progress& progress) {
    cost.bytes = static_cast<double>(progress.memory_bytes);
    for (const auto& time : progress.reports.front().times)
      if (progress.written && time.id == stage) cost.milliseconds = time.milliseconds;
  };
  source_.share_geometry(false);
  pipeline::run(views, source_, sink, run);
  source_.share_geometry(true);
  return cost;
}

}  // namespace aftershade::tune
