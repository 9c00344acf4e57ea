#include "core/tune/search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/tune/nelder_mead.h"

namespace aftershade::tune {
namespace {

Axis real(const std::string& key, double min, double max) { return {key, min, max, false}; }
Axis whole(const std::string& key, double min, double max) { return {key, min, max, true}; }
Cost free_of_charge(const std::vector<double>&) { return {1, 1}; }

double log_sphere(const std::vector<double>& v) {
  return std::pow(std::log2(v[0] / 0.3), 2) + std::pow(std::log2(v[1] / 2.5), 2);
}

TEST(NelderMead, FindsTheMinimumOfASphere) {
  Point best;
  double least = 1e9;
  nelder_mead({0.1, 0.9, 0.5}, {0.2, -0.2, 0.2}, 1e-5, [&](const Point& p) -> std::optional<Rank> {
    const double f = std::pow(p[0] - 0.6, 2) + 4 * std::pow(p[1] - 0.3, 2) + std::pow(p[2] - 0.45, 2);
    if (f < least) least = f, best = p;
    return Rank{0, f};
  });
  EXPECT_NEAR(best[0], 0.6, 1e-3);
  EXPECT_NEAR(best[1], 0.3, 1e-3);
  EXPECT_NEAR(best[2], 0.45, 1e-3);
}

TEST(NelderMead, WalksRosenbrocksValley) {
  double least = 1e9;
  int count = 0;
  nelder_mead({0.1, 0.8}, {0.2, -0.2}, 1e-6, [&](const Point& p) -> std::optional<Rank> {
    const double x = 4 * p[0] - 2, y = 4 * p[1] - 2;
    const double f = 100 * std::pow(y - x * x, 2) + std::pow(1 - x, 2);
    least = std::min(least, f), ++count;
    return Rank{0, f};
  });
  EXPECT_LT(least, 1e-6);
  EXPECT_LT(count, 400);
}

TEST(NelderMead, StaysInTheCubeAndFindsACornerOfIt) {
  Point best;
  double least = 1e9;
  nelder_mead({0.5, 0.5}, {0.2, 0.2}, 1e-4, [&](const Point& p) -> std::optional<Rank> {
    for (const double coordinate : p) EXPECT_TRUE(coordinate >= 0 && coordinate <= 1) << coordinate;
    const double f = p[0] - p[1];
    if (f < least) least = f, best = p;
    return Rank{0, f};
  });
  EXPECT_NEAR(best[0], 0, 1e-3);
  EXPECT_NEAR(best[1], 1, 1e-3);
}

TEST(NelderMead, EndsWhenRankSaysSoAndOnAPlateau) {
  int asked = 0;
  nelder_mead({0.5, 0.5}, {0.2, 0.2}, 0, [&](const Point&) -> std::optional<Rank> {
    return ++asked > 7 ? std::nullopt : std::optional(Rank{0, 1.0 / asked});
  });
  EXPECT_EQ(asked, 8);
  asked = 0;
  nelder_mead({0.5, 0.5}, {0.2, 0.2}, 0.01, [&](const Point&) -> std::optional<Rank> { return ++asked, Rank{0, 1}; });
  EXPECT_LT(asked, 100);
}

TEST(NelderMead, BreakingTheConstraintIsWorseThanAnyLoss) {
  EXPECT_LT((Rank{0, 1e9}), (Rank{0.01, 0}));
  EXPECT_LT((Rank{0.01, 5}), (Rank{0.02, 0}));
  EXPECT_LT((Rank{0, 1}), (Rank{0, 2}));
}

TEST(Space, LogarithmicFromADecadeOn) {
  const Axis wide = real("radius_m", 0.1, 10), narrow = real("ratio", 0.5, 1.5), from_zero = real("bias", 0, 1);
  EXPECT_DOUBLE_EQ(value_at(wide, 0.5), 1);
  EXPECT_DOUBLE_EQ(value_at(narrow, 0.5), 1);
  EXPECT_DOUBLE_EQ(value_at(from_zero, 0.25), 0.25);
  EXPECT_DOUBLE_EQ(position_of(wide, 1), 0.5);
  EXPECT_DOUBLE_EQ(position_of(narrow, 1.25), 0.75);
  EXPECT_DOUBLE_EQ(position_of(wide, 100), 1);
}

TEST(Space, ValuesAreWhatAPersonWouldWrite) {
  EXPECT_EQ(value_at(real("x", 0, 1), 1 / 3.0), 0.333);
  EXPECT_EQ(value_at(real("x", 0.001, 1e6), 0.5), 31.6);
  EXPECT_EQ(value_at(whole("taps", 3, 36), 0), 3);
  EXPECT_EQ(value_at(whole("taps", 3, 36), 0.5), 10);  // sqrt(3 * 36) = 10.4
  EXPECT_EQ(value_at(real("x", 0.12345, 0.2), 0), 0.12345) << "rounding does not leave the bounds";
}

params::Record record(params::Kind kind, double min, double max) {
  params::Record out;
  out.key = "k", out.kind = kind, out.range = {min, max}, out.doc = "What it does.";
  return out;
}

TEST(Space, WithoutBoundsItReachesAFactorAroundTheValue) {
  const auto number = record(params::Kind::number, 0, 10), integer = record(params::Kind::integer, 1, 1024);
  EXPECT_EQ(axis_of(number, 1, {}, "p"), real("k", 0.25, 4));
  EXPECT_EQ(axis_of(number, 5, {}, "p"), real("k", 1.25, 10));
  EXPECT_EQ(axis_of(integer, 9, {}, "p"), whole("k", 2, 36));
  EXPECT_EQ(axis_of(integer, 1, {}, "p"), whole("k", 1, 4));
  EXPECT_EQ(axis_of(record(params::Kind::integer, 0, 64), 3, {}, "p"), whole("k", 1, 12)) << "0 may be a switch";
  EXPECT_EQ(axis_of(number, 1, {{0, 2}}, "p"), real("k", 0, 2));
}

std::string error_of(const params::Record& r, double value, std::optional<params::Range> bounds) {
  try {
    axis_of(r, value, bounds, "stage ao");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::config);
    return error.what();
  }
  return "";
}

TEST(Space, WhatCannotBeSearchedIsSaid) {
  const auto number = record(params::Kind::number, 0, 10);
  EXPECT_NE(error_of(number, 0, {}).find("stage ao: k is 0 in the preset"), std::string::npos);
  EXPECT_NE(error_of(number, 1, {{-1, 2}}).find("leaves its range 0 to 10"), std::string::npos);
  EXPECT_NE(error_of(number, 1, {{2, 2}}).find("nothing to search from 2 to 2"), std::string::npos);
  EXPECT_NE(error_of(record(params::Kind::boolean, 0, 0), 1, {}).find("not a number"), std::string::npos);
}

TEST(Search, FindsTheBestWithoutABudget) {
  const Problem problem{{real("a", 0.1, 10), real("b", 0.1, 10)}, {1, 1}, log_sphere, free_of_charge};
  const Found found = search(problem, {});
  EXPECT_NEAR(found.best.values[0], 0.3, 0.01);
  EXPECT_NEAR(found.best.values[1], 2.5, 0.05);
  EXPECT_DOUBLE_EQ(found.start.score, log_sphere({1, 1}));
  EXPECT_LE(found.evaluations, SearchOptions().evaluations);
  EXPECT_TRUE(found.within_budget);
  EXPECT_EQ(found.front.size(), 1U) << "all cost the same: only the best is not dominated";
}

TEST(Search, RestartsLeaveALocalMinimum) {
  const auto two_wells = [](const std::vector<double>& v) {
    return std::min(std::pow(v[0] - 0.2, 2) + 0.02, 4 * std::pow(v[0] - 0.9, 2)) + std::pow(v[1] - 0.5, 2);
  };
  const Problem problem{{real("a", 0, 1), real("b", 0, 1)}, {0.2, 0.5}, two_wells, free_of_charge};
  SearchOptions options;
  options.evaluations = 400;
  EXPECT_NEAR(search(problem, options).best.values[0], 0.9, 0.01);
}

TEST(Search, MaximisesWhereHigherIsBetterAndSeeksZeroForABias) {
  Problem problem{{real("a", 0, 1)}, {0.5}, [](const auto& v) { return v[0] - 0.25; }, free_of_charge};
  problem.better = metrics::Better::higher;
  EXPECT_EQ(search(problem, {}).best.values[0], 1);
  problem.better = metrics::Better::zero;
  EXPECT_NEAR(search(problem, {}).best.values[0], 0.25, 1e-3);
  EXPECT_EQ(loss_of(std::nan(""), metrics::Better::higher), std::numeric_limits<double>::infinity());
}

/// The more taps the better, and the dearer; a has its own optimum, for free.
Problem taps_problem() {
  Problem problem{{whole("taps", 1, 64), real("a", 0.1, 10)}, {8, 1}, {}, {}};
  problem.score = [](const std::vector<double>& v) { return 1 / v[0] + 0.1 * std::pow(std::log2(v[1] / 0.4), 2); };
  problem.cost = [](const std::vector<double>& v) { return Cost{0.5 * v[0], 1000}; };
  return problem;
}

TEST(Search, KeepsTheBudgetAndUsesIt) {
  SearchOptions options;
  options.budget.milliseconds = 11.2;
  const Found found = search(taps_problem(), options);
  EXPECT_TRUE(found.within_budget);
  EXPECT_EQ(found.best.values[0], 22);
  EXPECT_NEAR(found.best.values[1], 0.4, 0.02);
}

TEST(Search, LeavesABorderAndAWholeNumber) {
  // From a = 1, the least, the way down is where b rises with it: along neither axis alone.
  Problem problem{{whole("a", 1, 4), real("b", 0.1, 10)}, {1, 1}, {}, free_of_charge};
  problem.score = [](const std::vector<double>& v) {
    return std::pow(v[0] - 3, 2) + 10 * std::pow(std::log2(v[1] / v[0]), 2);
  };
  const Found found = search(problem, {});
  EXPECT_EQ(found.best.values[0], 3);
  EXPECT_NEAR(found.best.values[1], 3, 0.05);
}

TEST(Search, StartsOverTheBudget) {
  SearchOptions options;
  options.budget.milliseconds = 2;
  const Found found = search(taps_problem(), options);
  EXPECT_TRUE(found.within_budget);
  EXPECT_EQ(found.best.values[0], 4);
}

TEST(Search, KeepsAMemoryBudget) {
  Problem problem = taps_problem();
  problem.cost = [](const std::vector<double>& v) { return Cost{1, 100 * v[0]}; };
  SearchOptions options;
  options.budget.bytes = 1650;
  EXPECT_EQ(search(problem, options).best.values[0], 16);
}

TEST(Search, TellsWhenNothingIsWithinTheBudget) {
  SearchOptions options;
  options.budget.milliseconds = 0.1;
  const Found found = search(taps_problem(), options);
  EXPECT_FALSE(found.within_budget);
  EXPECT_EQ(found.best.cost.milliseconds, 0.5) << "one tap is the cheapest there is";
}

TEST(Search, TheFrontIsWhatNothingDominates) {
  SearchOptions options;
  options.budget.milliseconds = 16;
  const Found found = search(taps_problem(), options);
  ASSERT_GE(found.front.size(), 4U);
  EXPECT_LE(found.front.front().cost.milliseconds, 4) << "cheaper ones than the best are looked for too";
  for (size_t i = 1; i < found.front.size(); ++i) {
    EXPECT_LT(found.front[i - 1].cost.milliseconds, found.front[i].cost.milliseconds);
    EXPECT_GT(found.front[i - 1].score, found.front[i].score);
  }
  EXPECT_EQ(found.front.back(), found.best);
}

TEST(Search, LeavesAParameterWithoutInfluenceAlone) {
  Problem problem{{real("a", 0.1, 10), real("idle", 0.1, 10), real("b", 0.1, 10)}, {1, 3, 1}, {}, free_of_charge};
  std::set<double> seen;
  problem.score = [&](const std::vector<double>& v) { return seen.insert(v[1]), log_sphere({v[0], v[2]}); };
  const Found found = search(problem, {});
  EXPECT_EQ(found.idle, std::vector<std::string>{"idle"});
  EXPECT_EQ(found.best.values[1], 3);
  EXPECT_EQ(seen.size(), 3U) << "the start's and one to each side";
  EXPECT_NEAR(found.best.values[2], 2.5, 0.05);
}

TEST(Search, AsksForEachPointOnce) {
  Problem problem = taps_problem();
  std::set<std::vector<double>> seen;
  problem.score = [&, score = problem.score](const std::vector<double>& v) {
    EXPECT_TRUE(seen.insert(v).second) << v[0] << " " << v[1];
    EXPECT_EQ(v[0], std::round(v[0]));
    EXPECT_TRUE(v[0] >= 1 && v[0] <= 64 && v[1] >= 0.1 && v[1] <= 10) << v[0] << " " << v[1];
    return score(v);
  };
  const Found found = search(problem, {});
  EXPECT_EQ(static_cast<size_t>(found.evaluations), seen.size());
}

TEST(Search, ASmallSpaceEndsEarly) {
  Problem problem{{whole("n", 1, 4)}, {2}, [](const auto& v) { return v[0]; }, free_of_charge};
  const Found found = search(problem, {});
  EXPECT_EQ(found.best.values[0], 1);
  EXPECT_LE(found.evaluations, 4);
}

TEST(Search, TheSameSeedGivesTheSameResult) {
  SearchOptions options;
  options.budget.milliseconds = 9;
  const Found a = search(taps_problem(), options), b = search(taps_problem(), options);
  EXPECT_EQ(a.best, b.best);
  EXPECT_EQ(a.front, b.front);
  options.seed = 2;
  EXPECT_NE(search(taps_problem(), options).front, a.front) << "another seed goes other ways";
}

TEST(Search, KeepsToItsEvaluationsAndStopsWhenAsked) {
  SearchOptions options;
  options.evaluations = 3;
  EXPECT_EQ(search(taps_problem(), options).evaluations, 3);
  int told = 0;
  options.evaluations = 100;
  options.on_evaluated = [&](const Candidate&, int count, bool) { EXPECT_EQ(count, ++told); };
  options.should_stop = [&] { return told >= 10; };
  const Found found = search(taps_problem(), options);
  EXPECT_EQ(found.evaluations, 10);
  EXPECT_LE(found.best.score, found.start.score);
}

TEST(Search, AScoreThatIsNoNumberIsTheWorst) {
  Problem problem{{real("a", 0, 1)}, {0.5}, {}, free_of_charge};
  problem.score = [](const auto& v) { return v[0] > 0.6 ? std::nan("") : 1 - v[0]; };
  const Found found = search(problem, {});
  EXPECT_NEAR(found.best.values[0], 0.6, 0.01);
  for (const Candidate& candidate : found.front) EXPECT_FALSE(std::isnan(candidate.score));
}

}  // namespace
}  // namespace aftershade::tune
