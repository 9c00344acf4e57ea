#include "core/metrics/sequence_scores.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/metrics/flip.h"
#include "core/metrics/instant.h"

namespace aftershade::metrics {

namespace {

/// A metric at work: what it has added up of the frames so far.
class Pool {
 public:
  virtual ~Pool() = default;
  virtual double add(Instant& instant) = 0;  ///< the frame's own score
  virtual double all() const = 0;
};

/// Sums of frames, made by `of_frame` and pooled by +=, and the score that `value` makes of them.
template <class OfFrame, class Value>
class PoolOf final : public Pool {
 public:
  PoolOf(OfFrame of_frame, Value value) : of_frame_(of_frame), value_(value) {}
  double add(Instant& instant) override {
    const auto sums = of_frame_(instant);
    total_ += sums;
    return value_(sums);
  }
  double all() const override { return value_(total_); }

 private:
  OfFrame of_frame_;
  Value value_;
  std::decay_t<std::invoke_result_t<OfFrame, Instant&>> total_{};
};

struct Metric {
  MetricInfo info;
  std::function<std::unique_ptr<Pool>()> pool;
};

template <class OfFrame, class Value>
Metric metric(MetricInfo info, OfFrame of_frame, Value value) {
  return {info, [of_frame, value] { return std::make_unique<PoolOf<OfFrame, Value>>(of_frame, value); }};
}

constexpr auto mean = [](const MeanSum& sum) { return sum.mean(); };
constexpr auto root_mean_square = [](const ErrorSums& sums) { return sums.root_mean_square(); };
constexpr auto mean_absolute = [](const ErrorSums& sums) { return sums.mean_absolute(); };
constexpr auto peak_to_noise = [](const ErrorSums& sums) { return sums.psnr(); };

std::vector<Metric> color_metrics() {
  const auto info = [](std::string_view name, std::string_view unit, Better better, std::string_view doc) {
    return MetricInfo{name, unit, doc, better, false, true, false, false};
  };
  const auto errors = [](Instant& i) { return i.color_errors(); };
  return {
      metric(info("rmse", "", Better::lower, "root of the mean squared error of scene-linear red, green and blue"),
             errors, root_mean_square),
      metric(info("mae", "", Better::lower, "mean absolute error of scene-linear red, green and blue"), errors,
             mean_absolute),
      metric(
          info("psnr", "dB", Better::higher,
               "peak signal to noise of red, green and blue as displayed: clipped to 0..1, to the power 1/2.2"),
          [](Instant& i) { return i.shown().errors; }, peak_to_noise),
      metric(info("psnr_linear", "dB", Better::higher,
                  "peak signal to noise of scene-linear red, green and blue, for a peak of 1"),
             errors, peak_to_noise),
      metric(
          info("ssim", "", Better::higher,
               "structural similarity (Wang et al. 2004) of the display luma, gaussian window of sigma 1.5"),
          [](Instant& i) { return ssim_sum(i.image(Signal::color), i.truth(Signal::color), i.mask(Signal::color)); },
          mean),
      metric(
          info("ldr_flip", "", Better::lower,
               "mean LDR-FLIP (Andersson et al. 2020) at 67 pixels per degree, of 0..1 as displayed"),
          [](Instant& i) { return mean_sum(ldr_flip(i.frame().color, i.frame().true_color), i.frame().mask); }, mean),
      metric(
          info("hdr_flip", "", Better::lower,
               "mean HDR-FLIP (Andersson et al. 2021) over the reference's exposures, at 67 pixels per degree"),
          [](Instant& i) { return mean_sum(hdr_flip(i.frame().color, i.frame().true_color), i.frame().mask); }, mean),
  };
}

std::vector<Metric> ao_metrics() {
  const auto info = [](std::string_view name, Better better, std::string_view doc) {
    return MetricInfo{name, "", doc, better, true, true, false, false};
  };
  const auto errors = [](Instant& i) { return i.ao_errors(); };
  return {
      metric(info("ao_rmse", Better::lower, "root of the mean squared error of the AO"), errors, root_mean_square),
      metric(info("ao_mae", Better::lower, "mean absolute error of the AO"), errors, mean_absolute),
      metric(info("ao_bias", Better::zero, "mean error of the AO: below 0 it is too dark"), errors,
             [](const ErrorSums& sums) { return sums.mean(); }),
      metric(
          info("ao_correlation", Better::higher, "Pearson's correlation of the AO with the reference's"),
          [](Instant& i) { return covariance(i.frame().ao, i.frame().true_ao, i.mask(Signal::ao)); },
          [](const Covariance& c) { return c.correlation(); }),
      metric(
          info("ao_ssim", Better::higher,
               "structural similarity (Wang et al. 2004) of the AO, gaussian window of sigma 1.5 (at silhouettes it "
               "reaches into the background)"),
          [](Instant& i) { return ssim_sum(i.frame().ao, i.frame().true_ao, i.mask(Signal::ao)); }, mean),
  };
}

/// Names and docs of the metrics of one signal, which live as long as the program.
std::string_view kept(std::string text) {
  static std::deque<std::string> texts;
  return texts.emplace_back(std::move(text));
}

class SignalMetrics {
 public:
  explicit SignalMetrics(Signal signal) : signal_(signal) {
    add_along_motion();
    add_fading();
    add_places();
  }
  std::vector<Metric> take() { return std::move(metrics_); }

 private:
  struct Kind {
    bool reference = true, temporal = true, moving = false;
  };
  /// `doc` may have one "IT", which becomes the signal's name.
  MetricInfo info(std::string_view name, std::string_view unit, Better better, Kind kind, std::string doc) const {
    const bool of_ao = signal_ == Signal::ao;
    const size_t at = doc.find("IT");
    if (at != std::string::npos) doc.replace(at, 2, of_ao ? "the AO" : "the display luma");
    return {kept(cat(of_ao ? "ao_" : "", name)),
            unit,
            kept(doc),
            better,
            of_ao,
            kind.reference,
            kind.temporal,
            kind.moving};
  }

  void add_along_motion() {
    constexpr Kind kAlone{.reference = false};
    const Signal s = signal_;
    metrics_.push_back(metric(
        info("warping_error", "", Better::lower, kAlone, "root of the mean squared change of IT along the motion"),
        [s](Instant& i) { return warping_error_sums(i.image(s), i.before(s), i.past().motion(), i.mask(s)); },
        root_mean_square));
    metrics_.push_back(metric(
        info("flicker_stable", "", Better::lower, kAlone,
             "mean change of IT along the motion less the reference's, both warped alike (without one: all "
             "change), where surfaces are even"),
        [s](Instant& i) { return mean_sum(i.flicker(s), i.stable()); }, mean));
    metrics_.push_back(metric(
        info("flicker_unstable", "", Better::lower, kAlone,
             "the same within 4 px of surfaces a pixel or two wide, such as grass"),
        [s](Instant& i) { return mean_sum(i.flicker(s), i.unstable()); }, mean));
  }

  void add_fading() {
    const Signal s = signal_;
    const auto shown = [s](Instant& i) { return Fading{i.since_disoccluded(s)}; };
    metrics_.push_back(metric(info("disocclusion_error", "", Better::lower, {},
                                   "mean absolute error of IT in the 8 frames after surfaces came into sight"),
                              shown, [](const Fading& f) { return f.fresh().absolute; }));
    metrics_.push_back(metric(info("disocclusion_lag", "frames", Better::lower, {},
                                   "frames until half of that error beyond the settled surfaces' is gone"),
                              shown, [](const Fading& f) { return f.half_life(true); }));
    constexpr Kind kMoving{.moving = true};
    const auto left = [s](Instant& i) { return Fading{i.since_left(s)}; };
    metrics_.push_back(
        metric(info("trail", "", Better::zero, kMoving,
                    "mean error of IT on still surfaces that a moving one was near (1/24 of the picture's "
                    "height) up to 8 frames ago: below 0 is a dark trail"),
               left, [](const Fading& f) { return f.fresh().mean; }));
    metrics_.push_back(
        metric(info("trail_visible", "", Better::lower, kMoving, "share of those that are wrong by 0.03"), left,
               [](const Fading& f) { return f.fresh().visible; }));
    metrics_.push_back(metric(info("trail_half_life", "frames", Better::lower, kMoving,
                                   "frames until half of the trail beyond the settled surfaces' error is gone"),
                              left, [](const Fading& f) { return f.half_life(false); }));
  }

  void add_places() {
    constexpr Kind kStill{.temporal = false};
    const Signal s = signal_;
    metrics_.push_back(metric(
        info("tile_seam", "", Better::lower, kStill,
             "step of the error of IT across tile borders over that inside, for the worst of tiles "
             "of 8, 16, 20, 32, 40 and 64 px: 1 is no seam"),
        [s](Instant& i) { return tile_seams(i, s); }, [](const TileSeams& seams) { return seams.greatest(); }));
    metrics_.push_back(metric(
        info("border_error", "", Better::lower, kStill,
             "mean absolute error of IT within 1/24 of the picture's height from its border, less "
             "that inside"),
        [s](Instant& i) { return border_errors(i, s); }, [](const BorderErrors& errors) { return errors.excess(); }));
  }

  Signal signal_;
  std::vector<Metric> metrics_;
};

const std::vector<Metric>& all_metrics() {
  static const std::vector<Metric> metrics = [] {
    std::vector<Metric> out;
    for (auto&& part :
         {color_metrics(), SignalMetrics(Signal::color).take(), ao_metrics(), SignalMetrics(Signal::ao).take()})
      out.insert(out.end(), part.begin(), part.end());
    return out;
  }();
  return metrics;
}

const Metric& find_metric(const std::string& name) {
  std::vector<std::string> names;
  for (const Metric& metric : all_metrics()) {
    if (metric.info.name == name) return metric;
    names.emplace_back(metric.info.name);
  }
  const std::string hint = did_you_mean(name, names);
  throw Error(ErrorCode::usage, cat("there is no metric \"", name, "\""),
              hint.empty() ? "metrics: " + join(names, ", ") : hint);
}

}  // namespace

std::span<const MetricInfo> metric_infos() {
  static const std::vector<MetricInfo> infos = [] {
    std::vector<MetricInfo> out;
    for (const Metric& metric : all_metrics()) out.push_back(metric.info);
    return out;
  }();
  return infos;
}

struct SequenceScorer::State {
  struct Asked {
    const Metric* metric;
    std::unique_ptr<Pool> pool;
    bool answered = false;
  };
  std::vector<Asked> asked;
  std::unique_ptr<History> before;
  bool follows(bool of_ao) const {
    return std::any_of(asked.begin(), asked.end(),
                       [&](const Asked& a) { return a.metric->info.temporal && a.metric->info.of_ao == of_ao; });
  }
};

SequenceScorer::SequenceScorer(std::vector<std::string> names) : state_(std::make_unique<State>()) {
  for (const std::string& name : names) {
    const Metric& metric = find_metric(name);
    state_->asked.push_back({&metric, metric.pool()});
  }
}
SequenceScorer::~SequenceScorer() = default;
SequenceScorer::SequenceScorer(SequenceScorer&&) noexcept = default;
SequenceScorer& SequenceScorer::operator=(SequenceScorer&&) noexcept = default;

Scores SequenceScorer::add(const ScoredFrame& frame) {
  if (state_->before && state_->before->number != frame.number - 1) state_->before.reset();
  Instant instant(frame, state_->before.get());
  Scores scores;
  for (State::Asked& asked : state_->asked) {
    if (!instant.has(asked.metric->info)) continue;
    scores[std::string(asked.metric->info.name)] = asked.pool->add(instant);
    asked.answered = true;
  }
  state_->before = instant.history(state_->follows(false), state_->follows(true));
  return scores;
}

Scores SequenceScorer::sequence() const {
  Scores scores;
  for (const State::Asked& asked : state_->asked)
    if (asked.answered) scores[std::string(asked.metric->info.name)] = asked.pool->all();
  return scores;
}

}  // namespace aftershade::metrics
