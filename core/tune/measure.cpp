#include "core/tune/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/parallel/rows.h"

namespace aftershade::tune {

namespace {

/// The value that this share of the others is below.
double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<size_t>(share * static_cast<double>(values.size()))];
}

using Samples = std::vector<Cost>;

Measured summary(const Samples& costs) {
  std::vector<double> ms, bytes;
  for (const Cost& cost : costs) ms.push_back(cost.milliseconds), bytes.push_back(cost.bytes);
  const double quartile = quantile(ms, 0.25);
  return {{quartile, quantile(bytes, 0.5)}, quantile(ms, 0.5) - quartile};
}

template <class Preset>
auto& params_of(Preset& preset, const std::string& stage) {
  return std::ranges::find_if(preset.stages, [&](const auto& s) { return s.id == stage; })->params;
}

/// One element a preset.
std::optional<std::vector<Samples>> samples_in_turn(const Trial& trial, const std::vector<preset::Preset>& presets,
                                                    const std::string& stage, int frame,
                                                    const std::function<void(int)>& on_round) {
  std::vector<Samples> samples(presets.size());
  const auto start = std::chrono::steady_clock::now();
  const auto is_long = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > kRoundsSeconds;
  };
  for (int round = 0; round < kFewestRounds || (round < kMostRounds && !is_long()); ++round) {
    for (size_t i = 0; i < presets.size(); ++i) {
      const size_t turn = (i + static_cast<size_t>(round)) % presets.size();
      samples[turn].push_back(trial.cost(presets[turn], stage, frame));
      if (trial.setup().should_stop && trial.setup().should_stop()) return std::nullopt;
    }
    on_round(round + 1);
  }
  return samples;
}

/// Where the axis is measured; with the base's own value, in rising order.
std::vector<double> values_to_measure(const Axis& axis, double base) {
  std::vector<double> values{base};
  for (const double position : {0.0, 1 / 3.0, 2 / 3.0, 1.0}) values.push_back(value_at(axis, position));
  std::ranges::sort(values);
  const auto repeated = std::ranges::unique(values);
  values.erase(repeated.begin(), repeated.end());
  return values;
}

}  // namespace

preset::Preset with_values(const preset::Preset& preset, const std::string& stage, const Axes& axes,
                           const std::vector<double>& values) {
  preset::Preset out = preset;
  preset::StageParams& params = params_of(out, stage);
  for (size_t i = 0; i < axes.size(); ++i) {
    const params::Record& record = params::find(preset::table_of(params), axes[i].key, stage);
    const params::Json value = axes[i].integer ? params::Json(std::lround(values[i])) : params::Json(values[i]);
    std::visit([&](auto& p) { record.put(&p, value); }, params);
  }
  return out;
}

std::vector<double> values_of(const preset::Preset& preset, const std::string& stage, const Axes& axes) {
  const preset::StageParams& params = params_of(preset, stage);
  std::vector<double> values;
  for (const Axis& axis : axes) {
    const params::Record& record = params::find(preset::table_of(params), axis.key, stage);
    values.push_back(record.get(preset::values_of(params)).get<double>());
  }
  return values;
}

std::optional<std::vector<Measured>> measure_in_turn(const Trial& trial, const std::vector<preset::Preset>& presets,
                                                     const std::string& stage, int frame,
                                                     const std::function<void(int)>& on_round) {
  const auto samples = samples_in_turn(trial, presets, stage, frame, on_round);
  if (!samples) return std::nullopt;
  std::vector<Measured> out;
  for (const Samples& costs : *samples) out.push_back(summary(costs));
  return out;
}

CostTable blank_table(const Subject& subject, const Frame& frame) {
  const preset::StageParams& params = params_of(subject.preset, subject.stage);
  CostTable table;
  table.preset = subject.preset.name;
  table.stage = subject.stage;
  table.method = preset::method_of(params);
  table.base = params::write(preset::table_of(params), preset::values_of(params));
  table.width = frame.window.width(), table.height = frame.window.height();
  table.threads = thread_count();
  return table;
}

std::optional<CostTable> measure_table(const Trial& trial, const Subject& subject, CostTable table,
                                       const std::function<void(int)>& on_round) {
  const std::vector<double> base = values_of(subject.preset, subject.stage, subject.axes);
  std::vector<preset::Preset> presets;
  for (size_t i = 0; i < subject.axes.size(); ++i) {
    CostCurve& curve = table.curves.emplace_back();
    curve.key = subject.axes[i].key;
    curve.values = values_to_measure(subject.axes[i], base[i]);
    std::vector<double> values = base;
    for (const double value : curve.values) {
      values[i] = value;
      presets.push_back(with_values(subject.preset, subject.stage, subject.axes, values));
    }
  }
  auto samples = samples_in_turn(trial, presets, subject.stage, subject.frame, on_round);
  if (!samples) return std::nullopt;
  table.rounds = static_cast<int>(samples->front().size());
  Samples of_base;
  for (size_t i = 0; i < presets.size(); ++i)
    if (presets[i] == subject.preset) of_base.insert(of_base.end(), (*samples)[i].begin(), (*samples)[i].end());
  table.cost = summary(of_base);
  auto next = samples->begin();
  for (size_t i = 0; i < table.curves.size(); ++i)
    for (const double value : table.curves[i].values) {
      table.curves[i].costs.push_back(value == base[i] ? table.cost : summary(*next));
      ++next;
    }
  judge_noise(table);
  return table;
}

}  // namespace aftershade::tune
