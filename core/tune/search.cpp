#include "core/tune/search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "core/tune/nelder_mead.h"
#include "core/tune/random.h"

namespace aftershade::tune {

namespace {

constexpr double kStep = 0.2;             ///< of the first simplex: a factor of 1.7 where kReach is searched
constexpr double kRestartStep = 0.1;      ///< of those that begin at the best point
constexpr double kTolerance = 0.01;       ///< a factor of 1.03 there
constexpr int kRestarts = 30;             ///< a budget, at most: small spaces are soon known
constexpr int kPointsPerEvaluation = 30;  ///< points that cost no evaluation are not free of time

bool dominates(const Candidate& a, const Candidate& b, metrics::Better better) {
  const double loss_a = loss_of(a.score, better), loss_b = loss_of(b.score, better);
  return loss_a <= loss_b && a.cost.milliseconds <= b.cost.milliseconds && a.cost.bytes <= b.cost.bytes;
}

class Search {
 public:
  Search(const Problem& problem, const SearchOptions& options)
      : problem_(problem), options_(options), random_(options.seed) {}

  Found run() {
    found_.start = evaluate(problem_.start);
    look_around();
    const int all = options_.evaluations, first = cost_varies_ ? all * 7 / 10 : all;
    search_within(options_.budget, first);
    if (cost_varies_) {
      const Cost best = best_within(options_.budget).cost;
      search_within({best.milliseconds / 2, options_.budget.bytes}, (first + all) / 2);
      search_within({best.milliseconds / 4, options_.budget.bytes}, all);
      search_within(options_.budget, all);  // what these did not need
    }
    found_.best = best_within(options_.budget);
    found_.within_budget = options_.budget.excess(found_.best.cost) == 0;
    found_.evaluations = static_cast<int>(evaluated_.size());
    found_.front = front();
    return std::move(found_);
  }

 private:
  bool is_over(int limit) const {
    return stopped_ || static_cast<int>(evaluated_.size()) >= limit ||
           points_ > options_.evaluations * kPointsPerEvaluation;
  }

  Rank rank_of(const Candidate& candidate, const Budget& budget) const {
    return {budget.excess(candidate.cost), loss_of(candidate.score, problem_.better)};
  }

  const Candidate& best_within(const Budget& budget) const {
    const Candidate* best = &found_.start;
    for (const auto& [values, candidate] : evaluated_)
      if (rank_of(candidate, budget) < rank_of(*best, budget)) best = &candidate;
    return *best;
  }

  const Candidate& evaluate(const std::vector<double>& values) {
    const auto known = evaluated_.find(values);
    if (known != evaluated_.end()) return known->second;
    const Candidate candidate{values, problem_.cost(values), problem_.score(values)};
    const bool best = evaluated_.empty() || rank_of(candidate, options_.budget) < rank_of(*best_, options_.budget);
    const Candidate& kept = evaluated_.emplace(values, candidate).first->second;
    if (best) best_ = &kept;
    if (options_.on_evaluated) options_.on_evaluated(kept, static_cast<int>(evaluated_.size()), best);
    stopped_ = options_.should_stop && options_.should_stop();
    return kept;
  }

  /// The start with one value changed: a step of the cube away, or as far as it takes to be another value.
  std::vector<double> neighbour(size_t axis, double direction) const {
    std::vector<double> values = problem_.start;
    const Axis& a = problem_.axes[axis];
    values[axis] = value_at(a, position_of(a, values[axis]) + direction * kStep);
    if (values[axis] == problem_.start[axis]) values[axis] = value_at(a, direction > 0 ? 1 : 0);
    return values;
  }

  /// Evaluates the start's neighbours: tells the axes that matter from those that do not, and which way is better.
  void look_around() {
    for (size_t i = 0; i < problem_.axes.size(); ++i) {
      std::optional<Rank> best;
      bool matters = false;
      for (const double direction : {1.0, -1.0}) {
        if (is_over(options_.evaluations)) break;
        const std::vector<double> values = neighbour(i, direction);
        if (values == problem_.start) continue;
        const Candidate& there = evaluate(values);
        matters = matters || there.cost != found_.start.cost || there.score != found_.start.score;
        cost_varies_ = cost_varies_ || there.cost.milliseconds != found_.start.cost.milliseconds;
        const Rank rank = rank_of(there, options_.budget);
        if (!best || rank < *best) best = rank, steps_[i] = direction * kStep;
      }
      if (matters)
        active_.push_back(i);
      else if (best)
        found_.idle.push_back(problem_.axes[i].key);
    }
  }

  std::vector<double> values_at(const Point& point) const {
    std::vector<double> values = problem_.start;
    for (size_t i = 0; i < active_.size(); ++i) values[active_[i]] = value_at(problem_.axes[active_[i]], point[i]);
    return values;
  }
  Point point_of(const std::vector<double>& values) const {
    Point point;
    for (const size_t i : active_) point.push_back(position_of(problem_.axes[i], values[i]));
    return point;
  }

  void search_within(const Budget& budget, int limit) {
    const RankOf rank = [&](const Point& point) -> std::optional<Rank> {
      if (is_over(limit)) return std::nullopt;
      ++points_;
      const std::vector<double> values = values_at(point);
      const double excess = budget.excess(problem_.cost(values));
      return excess > 0 ? Rank{excess, 0} : rank_of(evaluate(values), budget);
    };
    points_ = 0;
    for (int i = 0; i < kRestarts && !is_over(limit) && !active_.empty(); ++i) {
      const Point start = start_of(i, budget);
      nelder_mead(start, steps_of(i, start), kTolerance, rank);
    }
  }

  /// The best so far, which is the start at first; every second restart begins at a point drawn at random.
  Point start_of(int restart, const Budget& budget) {
    if (restart % 2 == 0) return point_of(best_within(budget).values);
    Point point(active_.size());
    for (double& coordinate : point) coordinate = random_.uniform();
    return point;
  }

  /// At first the way that looked better, later any.
  Point steps_of(int restart, const Point& start) {
    Point steps;
    for (size_t i = 0; i < active_.size(); ++i) {
      const double side = random_.uniform() < 0.5 ? -1 : 1;
      const double step = restart == 0 ? steps_.at(active_[i]) : side * (restart % 2 == 0 ? kRestartStep : kStep);
      steps.push_back(step_inside(problem_.axes[active_[i]], start[i], step));
    }
    return steps;
  }

  /// A simplex needs a volume: the step leads to another whole number, and not out of the cube.
  static double step_inside(const Axis& axis, double from, double step) {
    const auto to_next = [&](double side) {
      const double next = position_of(axis, value_at(axis, from) + side);
      return side * std::max(std::abs(step), axis.integer ? std::abs(next - from) : 0);
    };
    const double side = step < 0 ? -1 : 1, there = to_next(side), back = to_next(-side);
    const auto is_inside = [&](double s) { return from + s >= 0 && from + s <= 1; };
    return !is_inside(there) && is_inside(back) ? back : there;
  }

  std::vector<Candidate> front() const {
    std::vector<Candidate> sorted;
    for (const auto& [values, candidate] : evaluated_)
      if (!std::isnan(candidate.score)) sorted.push_back(candidate);
    std::ranges::stable_sort(sorted, {}, [&](const Candidate& c) {
      return std::tuple(c.cost.milliseconds, c.cost.bytes, loss_of(c.score, problem_.better));
    });
    std::vector<Candidate> front;  // whoever dominates another stands before it
    for (Candidate& candidate : sorted)
      if (std::ranges::none_of(front, [&](const Candidate& c) { return dominates(c, candidate, problem_.better); }))
        front.push_back(std::move(candidate));
    return front;
  }

  const Problem& problem_;
  const SearchOptions& options_;
  Random random_;
  Found found_{};
  std::map<std::vector<double>, Candidate> evaluated_;
  const Candidate* best_ = nullptr;
  std::vector<size_t> active_;
  std::map<size_t, double> steps_;
  bool cost_varies_ = false, stopped_ = false;
  int points_ = 0;
};

}  // namespace

double Budget::excess(const Cost& cost) const {
  return std::max(0.0, cost.milliseconds / milliseconds - 1) + std::max(0.0, cost.bytes / bytes - 1);
}

double loss_of(double score, metrics::Better better) {
  if (std::isnan(score)) return std::numeric_limits<double>::infinity();
  if (better == metrics::Better::zero) return std::abs(score);
  return better == metrics::Better::lower ? score : -score;
}

Found search(const Problem& problem, const SearchOptions& options) { return Search(problem, options).run(); }

}  // namespace aftershade::tune
