#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/params/table.h"
#include "core/tune/search.h"

/// What a stage costs at other values of its parameters, measured once: a search over it is the same every time.
namespace aftershade::tune {

/// Of repeated measurements: the lower quartile of the time (whatever else a machine does only ever adds to it), how
/// far the median lies above it, and the median of the memory.
struct Measured {
  Cost cost;
  double spread_ms = 0;
};

/// A parameter at several values, all others as in the table's base.
struct CostCurve {
  std::string key;
  std::vector<double> values;  ///< rising; the base's is one of them
  std::vector<Measured> costs;
  bool time_varies = false, memory_varies = false;
};

/// What was measured, on what.
struct CostTable {
  std::string program;  ///< "aftershade 1.2.3"
  std::string preset, stage, method;
  params::Json base;          ///< all parameters of the stage
  int width = 0, height = 0;  ///< pixels of the frames
  int threads = 0, rounds = 0;
  Measured cost;  ///< of the base
  std::vector<CostCurve> curves;

  /// The base's cost times, for each curve, the ratio at the parameter's value to that at the
  /// base's: interpolated in the logarithm of the ratio over the logarithm of the value (over the value, where some is
  /// not positive), constant beyond the ends. Parameters that `values` does not name are as in the base; a curve that
  /// does not vary counts as 1.
  Cost predict(const std::map<std::string, double>& values) const;
  /// The least that predict() can give for milliseconds, and for bytes, each for itself.
  Cost cheapest() const;
};

/// Sets `time_varies` where some time differs from the base's by more than 3 %, 0.01 ms and both spreads
/// together, and `memory_varies` where the bytes differ by more than 1 %.
void judge_noise(CostTable& table);

params::Json to_json(const CostTable& table);
/// Throws Error(config) that names `where` for anything that to_json() would not have written.
CostTable cost_table_of(const params::Json& json, std::string_view where);

/// Is the table of this stage, at these values apart from its curves' parameters, on such frames with as many threads?
/// Does it cover `axes` (each within its curve)? Error(config) that says what is different, else.
void check_fits(const CostTable& table, const CostTable& wanted, const Axes& axes, std::string_view where);

}  // namespace aftershade::tune
