#pragma once
#include <vector>

#include "core/parallel/rows.h"

namespace aftershade::metrics {

/// Adds up row(y, sum) of all rows, each in a Sum of its own, in the order of the rows: the same with any number of
/// threads.
template <class Sum, class Row>
Sum row_sums(int rows, Row&& row) {
  std::vector<Sum> sums(static_cast<size_t>(rows > 0 ? rows : 0));
  for_rows(rows, [&](int y) { row(y, sums[static_cast<size_t>(y)]); });
  Sum total{};
  for (const Sum& sum : sums) total += sum;
  return total;
}

}  // namespace aftershade::metrics
