#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/params/table.h"

/// The table of measures.
namespace aftershade::tests::throughput {

struct Goal {
  enum Kind { none, at_most, at_least } kind = none;
  double bound = 0;

  bool reached(double value) const { return kind == at_least ? value >= bound : value <= bound; }
  std::string text() const;  ///< "<= 0.48"
};
inline Goal at_most(double bound) { return {Goal::at_most, bound}; }
inline Goal at_least(double bound) { return {Goal::at_least, bound}; }

/// One measure. Without a value it could not be taken, and `note` says why.
struct Row {
  std::string measure, unit;
  std::optional<double> value, by_cpu;  ///< by_cpu: the same ratio of processor times
  Goal goal{};
  std::string note{};
};

void print(const std::vector<Row>& rows);
params::Json to_json(const std::vector<Row>& rows);

}  // namespace aftershade::tests::throughput
