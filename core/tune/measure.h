#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "core/tune/cost_table.h"
#include "core/tune/trial.h"

/// Measures what presets cost, fairly: everything in turn, several times over.
namespace aftershade::tune {

/// A stage of a preset, the parameters of it that are searched, and the frame to measure with.
struct Subject {
  const preset::Preset& preset;
  std::string stage;
  const Axes& axes;
  int frame;
};

/// At least so many rounds, and more, up to so many, as long as all together take less than that: what is short is
/// measured more often.
inline constexpr int kFewestRounds = 5, kMostRounds = 100;
inline constexpr double kRoundsSeconds = 5;

/// The preset with other values of the stage's parameters, an axis each.
preset::Preset with_values(const preset::Preset& preset, const std::string& stage, const Axes& axes,
                           const std::vector<double>& values);
/// The preset's own values of them.
std::vector<double> values_of(const preset::Preset& preset, const std::string& stage, const Axes& axes);

/// What each preset costs over several rounds, in each of which all take their turn, beginning with
/// another one. `on_round` is told how many rounds are done; nullopt when the trial's should_stop() says so.
std::optional<std::vector<Measured>> measure_in_turn(const Trial& trial, const std::vector<preset::Preset>& presets,
                                                     const std::string& stage, int frame,
                                                     const std::function<void(int)>& on_round);

/// A table without measurements: what it will be of. The program's name is left to the caller.
CostTable blank_table(const Subject& subject, const Frame& frame);

/// Measures the stage with one parameter at a time at both ends of its axis and at a third and two thirds of it, and
/// as often as each of them at the preset's values, all in turn. nullopt as measure_in_turn().
std::optional<CostTable> measure_table(const Trial& trial, const Subject& subject, CostTable blank,
                                       const std::function<void(int)>& on_round);

}  // namespace aftershade::tune
