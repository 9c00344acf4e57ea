#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/metrics/sequence_scores.h"
#include "core/tune/space.h"

/// The search itself: knows neither files nor presets, only numbers, what they score and what they cost.
namespace aftershade::tune {

/// What a stage takes for a frame.
struct Cost {
  double milliseconds = 0;
  double bytes = 0;  ///< of planes, at most at once
  bool operator==(const Cost&) const = default;
};

/// The most that a result may cost.
struct Budget {
  double milliseconds = std::numeric_limits<double>::infinity();
  double bytes = std::numeric_limits<double>::infinity();
  /// 0 within the budget, else the sum of the relative excesses.
  double excess(const Cost& cost) const;
};

/// Values of the parameters, an axis each, and what came of them.
struct Candidate {
  std::vector<double> values;
  Cost cost;
  double score = 0;
  bool operator==(const Candidate&) const = default;
};

/// A score as something to make small: NaN is the worst there is.
double loss_of(double score, metrics::Better better);

struct Problem {
  Axes axes;
  std::vector<double> start;                                ///< the preset's values
  std::function<double(const std::vector<double>&)> score;  ///< slow; asked once a point
  std::function<Cost(const std::vector<double>&)> cost;     ///< fast
  metrics::Better better = metrics::Better::lower;
};

struct SearchOptions {
  Budget budget;
  int evaluations = 150;  ///< of `score`, at most; the start is always one
  uint64_t seed = 1;
  /// Called for each evaluation: how many there were, and whether none before was better.
  std::function<void(const Candidate&, int, bool)> on_evaluated;
  std::function<bool()> should_stop;  ///< asked before each evaluation
};

struct Found {
  Candidate start, best;
  bool within_budget;  ///< is `best`? Else it is the one that exceeds it least
  int evaluations = 0;
  std::vector<std::string> idle;  ///< keys without any influence around the start: left as they are
  /// All evaluated candidates that no other beats or equals in score, milliseconds and bytes together; the cheapest
  /// first.
  std::vector<Candidate> front;
};

/// Looks around the start along each axis, then goes by nelder_mead() from there, and again and again, in turn from the
/// best so far and from points drawn at random (seed), with the budget as constraint. Where the cost depends on the
/// values, three tenths of the evaluations go to a half and to a quarter of the best candidate's cost, so that the
/// front does not end at it (the epsilon-constraint method: Haimes, Lasdon and Wismer 1971). Points over the budget are
/// ranked by their cost alone, without evaluation. The same problem, options and seed give the same result.
Found search(const Problem& problem, const SearchOptions& options);

}  // namespace aftershade::tune
